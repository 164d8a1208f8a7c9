#include "image/colour_kernels.h"
#include "kernels/srgb.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
AA_INLINE R tone_map(R x, int kind) {
    using T = Elem<R>;
    const R one(T(1));
    if (kind == 1) return x / (one + x);  // Reinhard
    if (kind == 2)                        // ACES fit, Narkowicz 2015
        return (x * (x * R(T(2.51)) + R(T(0.03)))) / (x * (x * R(T(2.43)) + R(T(0.59))) + R(T(0.14)));
    return x;
}
template <class R>
AA_INLINE R display(R c, R scale, int kind) {
    using T = Elem<R>;
    // max(0, NaN) == 0; the finite ceiling keeps Inf / Inf out of the tone maps (their value is 1 long before it).
    const R x = min(max(R(T(0)), c * scale), R(T(1e15)));
    return srgb_encode(min(max(R(T(0)), tone_map(x, kind)), R(T(1))));
}
template <class R>
__attribute__((flatten)) void encodeRows(const ColourArgs& a, int y0, int y1) {
    for (int c = 0; c < 3; c++)
        for (int y = y0; y < y1; y++)
            for (int x = 0; x < a.width; x += N<R>) {
                const long o = long(y) * a.stride + x;
                store(display(load<R>(a.in.c[c] + o), R(Elem<R>(a.scale)), a.toneMap), a.out.c[c] + o);
            }
}
template <class R>
__attribute__((flatten)) void decodeRows(const ColourArgs& a, int y0, int y1) {
    for (int c = 0; c < 3; c++)
        for (int y = y0; y < y1; y++)
            for (int x = 0; x < a.width; x += N<R>) {
                const long o = long(y) * a.stride + x;
                store(srgb_decode(saturate(load<R>(a.in.c[c] + o))), a.out.c[c] + o);
            }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::ColourKernels, colourKernels) = {AA_WIDE_ROWS(encodeRows), AA_WIDE_ROWS(decodeRows)};
