#include "methods/temporal_blocks.kernel.h"

namespace AA_ARCH {

// centre + gain * (4 centre - neighbours), clamped to display range; a constant stays exactly itself. Works on the
// interleaved history, so that no planar copy of the blend is kept.
template <class V>
AA_INLINE V sharpened(const float* p, long rowStep, float gain) {
    using T = Elem<V>;
    const V centre = load<V>(p);
    const V around = (load<V>(p - 4) + load<V>(p + 4)) + (load<V>(p - rowStep) + load<V>(p + rowStep));
    return saturate(centre + (centre * V(T(4)) - around) * V(T(gain)));
}
template <class R>
__attribute__((flatten)) void sharpenHistoryRows(const SharpenHistoryArgs& a, int y0, int y1) {
    const long rowStep = 4l * a.stride;
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            const float* p = a.rgba + 4 * o;
            if constexpr (N<R> == 1) {
                for (int c = 0; c < 3; c++) store(sharpened<R>(p + c, rowStep, a.gain), a.out.c[c] + o);
            } else {  // N pixels are four vectors of N samples
                alignas(64) float texels[4 * N<R>];
                alignas(64) int lane[N<R>];
                for (int i = 0; i < 4; i++) store(sharpened<R>(p + i * N<R>, rowStep, a.gain), texels + i * N<R>);
                for (int i = 0; i < N<R>; i++) lane[i] = i;
                store3(fetch_rgba<R>(texels, lane).rgb, a.out.c, o);
            }
        }
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::TemporalKernels, temporalKernels) = {AA_WIDE_ROWS(sharpenHistoryRows)};
