#include "methods/spatial/edge_bits.kernel.h"
#include "methods/spatial/smaa_kernels.h"

// SMAA's dense passes: edge bits, and the same bits by columns.
namespace AA_ARCH {
using namespace aa;

template <class R>
AA_INLINE vec3<R> colourAt(const float* const c[3], long o) {
    return {load<R>(c[0] + o), load<R>(c[1] + o), load<R>(c[2] + o)};
}
// What the edge test compares: |difference| of luma, largest |difference| of a channel, relative difference of depth.
template <class R, SmaaEdges kind>
AA_INLINE R difference(const SmaaEdgeArgs& a, long o, long p) {
    if constexpr (kind == SmaaEdges::colour)
        return maxComponent(abs(colourAt<R>(a.color.c, o) - colourAt<R>(a.color.c, p)));
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
        return select(idsDiffer<R>(a.objectId + o, a.objectId + p), low, high);
    const R u = load<R>(a.depthView + o), v = load<R>(a.depthView + p);
    const R relative = abs(u - v) / max(R(T(1e-12)), min(u, v));
    return select(relative >= R(T(a.predicationThreshold)), low, high);
}
struct EdgeBits {
    unsigned left, top;
};
// The bits of N<R> pixels from index o.
template <class R, SmaaEdges kind>
AA_INLINE EdgeBits edgeBits(const SmaaEdgeArgs& a, long o) {
    const long s = a.stride;
    const R left = difference<R, kind>(a, o, o - 1), top = difference<R, kind>(a, o, o - s);
    auto isLeft = left >= predicated<R>(a, o, o - 1), isTop = top >= predicated<R>(a, o, o - s);
    if (!maskBits<R>(either(isLeft, isTop))) return {0, 0};
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
    return {maskBits<R>(isLeft), maskBits<R>(isTop)};
}
template <class R, SmaaEdges kind>
AA_INLINE void edgeRowsOf(const SmaaEdgeArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += 8) {
            EdgeBits bits{0, 0};
            for (int i = 0; i < 8; i += N<R>) {
                const EdgeBits few = edgeBits<R, kind>(a, long(y) * a.stride + x + i);
                bits.left |= few.left << i;
                bits.top |= few.top << i;
            }
            a.left[long(y) * a.bitStride + (x >> 3)] = uint8_t(bits.left);
            a.top[long(y) * a.bitStride + (x >> 3)] = uint8_t(bits.top);
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

template <class R>
void transposeBlocks(const SmaaTransposeArgs& a, int b0, int b1) {
    for (int b = b0; b < b1; b++)
        for (int y = 0; y < a.height; y += 8) {
            const uint8_t* const p = a.from + long(y) * a.fromStride + b;
            uint64_t bits = 0;
            for (int i = 0; i < 8; i++) bits |= uint64_t(p[long(i) * a.fromStride]) << (8 * i);
            if (bits) bits = transposed8x8(bits);
            uint8_t* const q = a.to + 8l * b * a.toStride + (y >> 3);
            for (int i = 0; i < 8; i++) q[long(i) * a.toStride] = uint8_t(bits >> (8 * i));
        }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::SmaaKernels, smaaKernels) = {AA_ROWS(edgeRows), AA_ROWS(transposeBlocks)};
