// The sharpening of [Oliveros 2018, eq 3.1] and its normalised form, eq 4.17, on a history's own layout. Include from
// *.kernel.cpp only.
#pragma once
#include "methods/temporal/temporal_texels.kernel.h"

namespace AA_ARCH {

// centre + gain * (4 centre - neighbours), clamped to display range; a constant stays exactly itself.
template <class V>
AA_INLINE V sharpened(const float* above, const float* p, const float* below, float gain) {
    using T = Elem<V>;
    const V centre = load<V>(p);
    const V around = (load<V>(p - 4) + load<V>(p + 4)) + (load<V>(above) + load<V>(below));
    return saturate(centre + (centre * V(T(4)) - around) * V(T(gain)));
}
// One row of an interleaved history, and those above and below it, into planes at `o`: no planar copy of the blend is
// kept. Texels -1 and `width` of the row are its border.
template <class R>
AA_INLINE void sharpenRow(const float* above, const float* row, const float* below, float gain, const RgbOut& out,
                          long o, int width) {
    for (int x = 0; x < width; x += N<R>) {
        if constexpr (N<R> == 1) {
            for (int c = 0; c < 3; c++) {
                const int i = 4 * x + c;
                store(sharpened<R>(above + i, row + i, below + i, gain), out.c[c] + o + x);
            }
        } else {  // N pixels are four vectors of N samples
            alignas(64) float texels[4 * N<R>];
            alignas(64) int lane[N<R>];
            for (int v = 0; v < 4; v++) {
                const int i = 4 * x + v * N<R>;
                store(sharpened<R>(above + i, row + i, below + i, gain), texels + v * N<R>);
            }
            for (int i = 0; i < N<R>; i++) lane[i] = i;
            store3(fetchRgba<R>(texels, lane).rgb, out.c, o + x);
        }
    }
}

}  // namespace AA_ARCH
