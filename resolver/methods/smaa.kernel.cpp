#include "kernels/sparse.h"
#include "methods/smaa_kernels.h"

// SMAA's dense passes: edge bits, and the blend of the pixels that carry weights.
namespace AA_ARCH {
using namespace aa;

template <class R>
AA_INLINE vec3<R> colour_at(const float* const c[3], long o) {
    return {load<R>(c[0] + o), load<R>(c[1] + o), load<R>(c[2] + o)};
}
// What the edge test compares: |difference| of luma, largest |difference| of a channel, relative difference of depth.
template <class R, SmaaEdges kind>
AA_INLINE R difference(const SmaaEdgeArgs& a, long o, long p) {
    if constexpr (kind == SmaaEdges::colour)
        return max_component(abs(colour_at<R>(a.color.c, o) - colour_at<R>(a.color.c, p)));
    const R u = load<R>(a.scalar + o), v = load<R>(a.scalar + p);
    if constexpr (kind == SmaaEdges::depth) return abs(u - v) / max(R(Elem<R>(1e-12)), min(u, v));
    return abs(u - v);
}
// Threshold of one direction: doubled, and lowered again where the auxiliary plane has an edge.
template <class R>
AA_INLINE R predicated(const SmaaEdgeArgs& a, long o, long p) {
    using T = Elem<R>;
    if (a.predication == SmaaPredication::off) return R(T(a.threshold));
    const R high = R(T(a.predicationScale) * T(a.threshold)), low = high * R(T(1) - T(a.predicationStrength));
    if (a.predication == SmaaPredication::object)
        return select(ids_differ<R>(a.objectId + o, a.objectId + p), low, high);
    const R u = load<R>(a.depthView + o), v = load<R>(a.depthView + p);
    const R relative = abs(u - v) / max(R(T(1e-12)), min(u, v));
    return select(relative >= R(T(a.predicationThreshold)), low, high);
}
template <class R, SmaaEdges kind>
AA_INLINE void edgeRowsOf(const SmaaEdgeArgs& a, int y0, int y1) {
    const long s = a.stride;
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * s + x;
            uint8_t* const edges = a.edges + long(y) * a.edgeStride + x;
            const R left = difference<R, kind>(a, o, o - 1), top = difference<R, kind>(a, o, o - s);
            auto isLeft = left >= predicated<R>(a, o, o - 1), isTop = top >= predicated<R>(a, o, o - s);
            if (!mask_bits<R>(either(isLeft, isTop))) {
                __builtin_memset(edges, 0, N<R>);
                continue;
            }
            if constexpr (kind != SmaaEdges::depth) {  // local contrast adaptation
                const bool fromCentre = kind == SmaaEdges::colour && !a.consistent;
                const R right = difference<R, kind>(a, o, o + 1), bottom = difference<R, kind>(a, o, o + s),
                        leftLeft = difference<R, kind>(a, fromCentre ? o : o - 1, o - 2),
                        topTop = difference<R, kind>(a, fromCentre ? o : o - s, o - 2 * s);
                const R strongest = max(max(max(left, top), max(right, bottom)), max(leftLeft, topTop));
                const R factor(Elem<R>(a.localContrast));
                isLeft = both(isLeft, factor * left >= strongest);
                isTop = both(isTop, factor * top >= strongest);
            }
            store_mask_bytes<R>(isLeft, isTop, edges);
        }
}
template <class R>
__attribute__((flatten)) void edgeRows(const SmaaEdgeArgs& a, int y0, int y1) {
    switch (a.kind) {
        case SmaaEdges::luma:
            return edgeRowsOf<R, SmaaEdges::luma>(a, y0, y1);
        case SmaaEdges::colour:
            return edgeRowsOf<R, SmaaEdges::colour>(a, y0, y1);
        case SmaaEdges::depth:
            return edgeRowsOf<R, SmaaEdges::depth>(a, y0, y1);
    }
}

// Weight k (0: own, 1: opposite) of the top or left edge of a pixel; 0 where there is no such edge.
template <class T>
AA_INLINE T top_weight(const SmaaBlendArgs& a, int x, int y, int k) {
    if (!(a.edges[long(y) * a.edgeStride + x] & kEdgeTop)) return T(0);
    return T(a.topWeights[2 * (y * a.weightStride + x) + k]);
}
template <class T>
AA_INLINE T left_weight(const SmaaBlendArgs& a, int x, int y, int k) {
    if (!(a.edges[long(y) * a.edgeStride + x] & kEdgeLeft)) return T(0);
    return T(a.leftWeights[2 * (y * a.weightStride + x) + k]);
}
template <class T>
AA_INLINE void blend_pixel(const SmaaBlendArgs& a, int x, int y) {
    const int xRight = x + 1 < a.width ? x + 1 : x,
              yBelow = y + 1 < a.height ? y + 1 : y;  // clamp, as the sampler does
    const T right = left_weight<T>(a, xRight, y, 1), left = left_weight<T>(a, x, y, 0);
    const T bottom = top_weight<T>(a, x, yBelow, 1), top = top_weight<T>(a, x, y, 0);
    if (right + left + bottom + top < T(1e-5)) return;
    // Symmetric corners weigh both axes alike; they count as vertical in every precision, as equal 8-bit weights do.
    const bool horizontal = max(right, left) > max(bottom, top) * T(1 + 1e-5);
    const long o = long(y) * a.stride + x, step = horizontal ? 1 : a.stride;
    const T forward = horizontal ? right : bottom, backward = horizontal ? left : top;
    const T total = forward + backward, f = forward * forward / total, b = backward * backward / total;
    for (int c = 0; c < a.channels; c++) {
        const T own = a.in[c][o];
        a.out[c][o] = float(own + f * (T(a.in[c][o + step]) - own) + b * (T(a.in[c][o - step]) - own));
    }
}
template <class R>
__attribute__((flatten)) void blendRows(const SmaaBlendArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++) {
        for (int c = 0; c < a.channels; c++)
            for (int x = 0; x < a.width; x += N<R>)
                store(load<R>(a.in[c] + long(y) * a.stride + x), a.out[c] + long(y) * a.stride + x);
        const uint8_t *row = a.edges + long(y) * a.edgeStride, *below = row + a.edgeStride;
        for (int x = 0; x < a.width; x += 8) {
            const uint64_t own = load_bytes(row + x),
                           right = load_bytes(row + x + 1) & 0x0101010101010101ull * kEdgeLeft,
                           bottom = load_bytes(below + x) & 0x0101010101010101ull * kEdgeTop;
            for_each_byte(
                own | right | bottom, [&](int i) __attribute__((always_inline)) {
                    if (x + i < a.width) blend_pixel<Elem<R>>(a, x + i, y);
                });
        }
    }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::SmaaKernels, smaaKernels) = {AA_ROWS(edgeRows), AA_ROWS(blendRows)};
