#include "kernels/lanes.h"
#include "methods/reference/resolve_filters_kernels.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
AA_INLINE vec3<R> radiance(const ResolveArgs& a, const ResolveTap& tap, long o) {
    const RgbIn& s = a.samples[tap.sample];
    const long p = o + long(tap.dy) * a.stride + tap.dx;
    const vec3<R> zero(R(Elem<R>(0)));
    return max(zero, colourAt<R>(s.c, p));
}
// Mean of the pixel's own sub-samples.
template <class R>
AA_INLINE vec3<R> boxMean(const ResolveArgs& a, long o) {
    vec3<R> sum(R(Elem<R>(0)));
    for (int k = 0; k < a.sampleCount; k++) sum = sum + radiance<R>(a, {0, 0, k, 1.0f}, o);
    return sum / R(Elem<R>(a.sampleCount));
}
template <class R>
__attribute__((flatten)) void resolveRows(const ResolveArgs& a, int y0, int y1) {
    using T = Elem<R>;
    const R zero(T(0)), one(T(1)), scale(T(a.luminanceScale));
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            // About the first tap, so that a constant stays constant whatever the weights round to.
            const vec3<R> base = radiance<R>(a, a.taps[0], o);
            vec3<R> sum(zero);
            R total = zero;
            for (int k = 0; k < a.tapCount; k++) {
                const vec3<R> c = radiance<R>(a, a.taps[k], o);
                R w(T(a.taps[k].weight));
                if (a.inverseLuminance) w = w / (one + luma601(c) * scale);
                sum = sum + (c - base) * w;
                total = total + w;
            }
            // Negative lobes may cancel the sum: then the box is left.
            const auto usable = abs(total) >= R(T(1e-5));
            vec3<R> c = base + sum / select(usable, total, one);
            if (maskBits<R>(negate(usable))) c = select(usable, c, boxMean<R>(a, o));
            c = max(vec3<R>(zero), c);
            store(c.x, a.out.c[0] + o);
            store(c.y, a.out.c[1] + o);
            store(c.z, a.out.c[2] + o);
        }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::ResolveKernels, resolveKernels) = {AA_WIDE_ROWS(resolveRows)};
