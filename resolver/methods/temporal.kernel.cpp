#include "methods/temporal_blocks.kernel.h"

namespace AA_ARCH {

// centre + gain * (4 centre - neighbours), clamped to display range; a constant stays exactly itself.
template <class R>
__attribute__((flatten)) void sharpenRows(const SharpenArgs& a, int y0, int y1) {
    using T = Elem<R>;
    for (int c = 0; c < 3; c++)
        for (int y = y0; y < y1; y++)
            for (int x = 0; x < a.width; x += N<R>) {
                const float* p = a.in.c[c] + long(y) * a.stride + x;
                const R centre = load<R>(p);
                const R around = (load<R>(p - 1) + load<R>(p + 1)) + (load<R>(p - a.stride) + load<R>(p + a.stride));
                const R sharpened = centre + (centre * R(T(4)) - around) * R(T(a.gain));
                store(saturate(sharpened), a.out.c[c] + long(y) * a.stride + x);
            }
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::TemporalKernels, temporalKernels) = {AA_ROWS(sharpenRows)};
