#include "kernels/lanes.h"
#include "methods/sharpen_kernels.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
AA_INLINE vec3<R> crossSharpened(const SharpenArgs& a, long o, vec3<R> c, R gain) {
    const vec3<R> excess = (c - colourAt<R>(a.in.c, o - a.stride)) + (c - colourAt<R>(a.in.c, o + a.stride)) +
                           (c - colourAt<R>(a.in.c, o - 1)) + (c - colourAt<R>(a.in.c, o + 1));
    return c + excess * gain;
}
template <class R>
AA_INLINE vec3<R> lumaSharpened(const SharpenArgs& a, long o, vec3<R> c) {
    using T = Elem<R>;
    const R luma = luma709(c);
    R excess(T(0));  // 9 (L - mean)
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            excess = excess + (luma - luma709(colourAt<R>(a.in.c, o + long(j) * a.stride + i)));
    const R target = max(R(T(0)), luma + excess * R(T(a.amount) / T(9)));
    return select(luma >= R(T(1e-6)), c * (target / max(R(T(1e-6)), luma)), c);
}
template <class R>
AA_INLINE vec3<R> withinNeighbourhood(const SharpenArgs& a, long o, vec3<R> sharp) {
    vec3<R> lowest = colourAt<R>(a.in.c, o), highest = lowest;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            const vec3<R> c = colourAt<R>(a.in.c, o + long(j) * a.stride + i);
            lowest = min(lowest, c);
            highest = max(highest, c);
        }
    return min(highest, max(lowest, sharp));
}
template <class R>
__attribute__((flatten)) void sharpenRows(const SharpenArgs& a, int y0, int y1) {
    const R gain(Elem<R>(a.filter == Sharpen::norm ? 0.25 : 1.0));
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            const vec3<R> c = colourAt<R>(a.in.c, o);
            vec3<R> sharp = a.filter == Sharpen::lumaPost ? lumaSharpened(a, o, c) : crossSharpened(a, o, c, gain);
            if (a.range == SharpenRange::neighbourhood) sharp = withinNeighbourhood(a, o, sharp);
            sharp = max(vec3<R>(R(Elem<R>(0))), sharp);
            if (a.range == SharpenRange::display) sharp = min(vec3<R>(R(Elem<R>(1))), sharp);
            store(sharp.x, a.out.c[0] + o);
            store(sharp.y, a.out.c[1] + o);
            store(sharp.z, a.out.c[2] + o);
        }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::SharpenKernels, sharpenKernels) = {AA_WIDE_ROWS(sharpenRows)};
