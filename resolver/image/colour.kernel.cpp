#include "image/colour_kernels.h"
#include "kernels/display.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
__attribute__((flatten)) void encodeRows(const ColourArgs& a, int y0, int y1) {
    for (int c = 0; c < 3; c++)
        for (int y = y0; y < y1; y++)
            for (int x = 0; x < a.width; x += N<R>) {
                const long o = long(y) * a.stride + x;
                store(display(a.display, load<R>(a.in.c[c] + o)), a.out.c[c] + o);
            }
}
template <class R>
__attribute__((flatten)) void decodeRows(const ColourArgs& a, int y0, int y1) {
    for (int c = 0; c < 3; c++)
        for (int y = y0; y < y1; y++)
            for (int x = 0; x < a.width; x += N<R>) {
                const long o = long(y) * a.stride + x;
                const R shown = saturate(load<R>(a.in.c[c] + o));
                store(a.display.srgb ? srgbDecode(shown) : shown, a.out.c[c] + o);
            }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::ColourKernels, colourKernels) = {AA_WIDE_ROWS(encodeRows), AA_WIDE_ROWS(decodeRows)};
