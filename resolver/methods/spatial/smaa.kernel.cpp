#include "kernels/display.h"
#include "kernels/ring.h"
#include "kernels/sparse.h"
#include "methods/spatial/edge_bits.kernel.h"
#include "methods/spatial/smaa_kernels.h"

// SMAA's dense passes: edge bits, and the same bits by columns.
namespace AA_ARCH {
using namespace aa;

// ---- what the edge test compares: differences of two pixels, (x, y) beside N<R> ones each

struct Beside {
    int x, y;
};
// |difference| of luma.
template <class R>
struct LumaDifference {
    static constexpr bool adapts = true;
    const float* row[4];  // rows -2 .. 1
    AA_INLINE R operator()(Beside p, Beside q) const {
        return abs(load<R>(row[p.y + 2] + p.x) - load<R>(row[q.y + 2] + q.x));
    }
};
// Largest |difference| of a channel.
template <class R>
struct ColourDifference {
    static constexpr bool adapts = true;
    const SmaaEdgeArgs& a;
    long o;
    AA_INLINE R operator()(Beside p, Beside q) const {
        return maxComponent(abs(colourAt<R>(a.color.c, o + long(p.y) * a.stride + p.x) -
                                colourAt<R>(a.color.c, o + long(q.y) * a.stride + q.x)));
    }
};
// Relative difference of depth.
template <class R>
AA_INLINE R depthsApart(const SmaaEdgeArgs& a, long o, long p) {
    const R u = load<R>(a.depthView + o), v = load<R>(a.depthView + p);
    return abs(u - v) / max(R(Elem<R>(1e-12)), min(u, v));
}
template <class R>
struct DepthDifference {
    static constexpr bool adapts = false;
    const SmaaEdgeArgs& a;
    long o;
    AA_INLINE R operator()(Beside p, Beside q) const {
        return depthsApart<R>(a, o + long(p.y) * a.stride + p.x, o + long(q.y) * a.stride + q.x);
    }
};

// ---- edges

// Threshold of one direction: doubled, and lowered again where the auxiliary plane has an edge.
template <class T>
struct Thresholds {
    T high, low;
    AA_INLINE explicit Thresholds(const SmaaEdgeArgs& a)
        : high(T(a.predicationScale) * T(a.threshold)), low(high * (T(1) - T(a.predicationStrength))) {}
};
template <class R>
AA_INLINE R predicated(const SmaaEdgeArgs& a, long o, long p) {
    using T = Elem<R>;
    if (a.predication == SmaaPredication::off) return R(T(a.threshold));
    const Thresholds<T> of(a);
    if (a.predication == SmaaPredication::object)
        return select(idsDiffer<R>(a.objectId + o, a.objectId + p), R(of.low), R(of.high));
    return select(depthsApart<R>(a, o, p) >= R(T(a.predicationThreshold)), R(of.low), R(of.high));
}
struct EdgeBits {
    unsigned left, top;
};
// The bits of N<R> pixels from index o.
template <class R, class Difference>
AA_INLINE EdgeBits edgeBits(const SmaaEdgeArgs& a, long o, const Difference& difference) {
    const R left = difference({0, 0}, {-1, 0}), top = difference({0, 0}, {0, -1});
    auto isLeft = left >= predicated<R>(a, o, o - 1), isTop = top >= predicated<R>(a, o, o - a.stride);
    if (!maskBits<R>(either(isLeft, isTop))) return {0, 0};
    if constexpr (Difference::adapts) {  // local contrast adaptation
        const bool fromCentre = a.kind == SmaaEdges::colour && !a.consistent;
        const R right = difference({0, 0}, {1, 0}), bottom = difference({0, 0}, {0, 1}),
                leftLeft = difference({fromCentre ? 0 : -1, 0}, {-2, 0}),
                topTop = difference({0, fromCentre ? 0 : -1}, {0, -2});
        const R strongest = max(max(max(left, top), max(right, bottom)), max(leftLeft, topTop));
        const R factor(Elem<R>(a.localContrast));
        isLeft = both(isLeft, factor * left >= strongest);
        isTop = both(isTop, factor * top >= strongest);
    }
    return {maskBits<R>(isLeft), maskBits<R>(isTop)};
}
// The bits of those of the eight pixels from column x that `may` have edges; at(x, o): their differences.
template <class R, class At>
AA_INLINE void edgeByte(const SmaaEdgeArgs& a, int x, int y, unsigned may, const At& at) {
    EdgeBits bits{0, 0};
    for (int i = 0; may && i < 8; i += N<R>) {
        const long o = long(y) * a.stride + x + i;
        const EdgeBits few = edgeBits<R>(a, o, at(x + i, o));
        bits.left |= few.left << i;
        bits.top |= few.top << i;
    }
    a.left[long(y) * a.bitStride + (x >> 3)] = uint8_t(bits.left & may);
    a.top[long(y) * a.bitStride + (x >> 3)] = uint8_t(bits.top & may);
}
template <class Difference, class R>
AA_INLINE void edgeRowsOf(const SmaaEdgeArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += 8)
            edgeByte<R>(
                a, x, y, 0xff, [&](int, long o) __attribute__((always_inline)) {
                    return Difference{a, o};
                });
}

// ---- edges of luma

// sRGB's curve is 1.1412 sqrt(c) - 0.1162 c - 0.0125 to 0.0126 up and down, so that lumas of the first two terms differ
// by what those of the curve do to 0.0251. What stays below the threshold by more is no edge, whatever the curve says:
// it is computed around the others alone, which in most pictures are few, and costs four times as much.
inline constexpr float kRoughlyApart = 0.0255f;
template <class R>
AA_INLINE R roughLuma(const DisplayArgs& d, vec3<R> linear) {
    using T = Elem<R>;
    const auto curve = [&](R c) __attribute__((always_inline)) {
        const R x = shown(d, c);
        return sqrt(x) * R(T(1.1412)) - x * R(T(0.1162));
    };
    return luma709(vec3<R>(curve(linear.x), curve(linear.y), curve(linear.z)));
}
// Row by row: rough lumas, the pixels that may have edges, lumas around these, edges.
template <class R>
struct LumaEdges {
    using T = Elem<R>;
    const SmaaEdgeArgs& a;
    int y0, y1;
    bool rough;
    float roughThreshold;
    Ring<float, 2> roughRows;
    Ring<float, 4> lumaRows;
    Ring<uint8_t, 4> marks;  // bits of pixels that may have edges, in `groups` bytes

    AA_INLINE LumaEdges(const SmaaEdgeArgs& a_, int y0_, int y1_)
        : a(a_), y0(y0_), y1(y1_), rough(a.encodes && a.display.srgb) {
        const Thresholds<float> predicating(a);
        const float least =
            a.predication == SmaaPredication::off ? a.threshold : min(predicating.low, predicating.high);
        roughThreshold = least - kRoughlyApart;
        RingMaker<float> maker(a.scratch, a.stride, a.width, a.height);
        maker.make(roughRows), maker.make(lumaRows);
        RingMaker<uint8_t>(maker.free, a.stride, a.width, a.height).make(marks);
    }
    AA_INLINE int groups() const { return (a.width + 7) / 8; }
    AA_INLINE void roughRow(int y) const {
        float* const row = roughRows(y);
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            if (x % 16 == 0)
                for (int c = 0; c < 3; c++) __builtin_prefetch(a.color.c[c] + o + a.stride, 0, 2);
            store(roughLuma(a.display, colourAt<R>(a.color.c, o)), row + x);
        }
        roughRows.continueBeyond(y);
    }
    AA_INLINE void markRow(int y) const {
        uint8_t* const mark = marks(y);
        __builtin_memset(mark - 8, 0, size_t(groups() + 16));
        if (!rough) {
            __builtin_memset(mark, 0xff, size_t(groups()));
            return;
        }
        const float *const row = roughRows(y), *const above = roughRows(y - 1);
        for (int g = 0; g < groups(); g++) {
            unsigned may = 0;
            for (int i = 0; i < 8; i += N<R>) {
                const float* const p = row + 8 * g + i;
                const R own = load<R>(p), left = load<R>(p - 1), top = load<R>(above + 8 * g + i);
                may |= maskBits<R>(max(abs(own - left), abs(own - top)) >= R(T(roughThreshold))) << i;
            }
            mark[g] = uint8_t(may);
        }
    }
    // In the groups of eight pixels where edges read it: those of this row one pixel to the right and two to the left
    // of theirs, those of the rows above and below in their own column.
    AA_INLINE void lumaRow(int y) const {
        const auto marked = [&](int r, int g) __attribute__((always_inline)) {
            return r >= y0 && r < y1 ? loadBytes(marks(r) + g) : 0;
        };
        float* const row = lumaRows(y);
        for (int g0 = 0; g0 < groups(); g0 += 8) {
            const uint64_t wanted = marked(y - 1, g0) | marked(y, g0) | marked(y + 1, g0) | marked(y + 2, g0) |
                                    (marked(y, g0 + 1) & 0x0303030303030303ull) |
                                    (marked(y, g0 - 1) & 0x8080808080808080ull);
            forEachByte(
                wanted, [&](int i) __attribute__((always_inline)) {
                    for (int x = 8 * (g0 + i); x < 8 * (g0 + i + 1); x += N<R>) {
                        const vec3<R> c = colourAt<R>(a.color.c, long(y) * a.stride + x);
                        store(luma709(a.encodes ? display(a.display, c) : c), row + x);
                    }
                });
        }
        lumaRows.continueBeyond(y);
    }
    AA_INLINE void edgeRow(int y) const {
        const float* const row[4] = {lumaRows(y - 2), lumaRows(y - 1), lumaRows(y), lumaRows(y + 1)};
        const uint8_t* const mark = marks(y);
        for (int g = 0; g < groups(); g++)
            edgeByte<R>(
                a, 8 * g, y, mark[g], [&](int x, long) __attribute__((always_inline)) {
                    return LumaDifference<R>{{row[0] + x, row[1] + x, row[2] + x, row[3] + x}};
                });
    }
    AA_INLINE void run() const {
        for (int y = y0 - 1; y < y1 + 3; y++) {
            if (rough && y >= 0 && y < y1) roughRow(y);
            if (y >= y0 && y < y1) markRow(y);
            if (y - 2 >= 0 && y - 2 >= y0 - 2 && y - 2 <= y1 && y - 2 < a.height) lumaRow(y - 2);
            if (y - 3 >= y0) edgeRow(y - 3);
        }
    }
};
template <class R>
__attribute__((flatten)) void edgeRows(const SmaaEdgeArgs& a, int y0, int y1) {
    switch (a.kind) {
        case SmaaEdges::luma:
            return LumaEdges<R>(a, y0, y1).run();
        case SmaaEdges::colour:
            return edgeRowsOf<ColourDifference<R>, R>(a, y0, y1);
        case SmaaEdges::depth:
            return edgeRowsOf<DepthDifference<R>, R>(a, y0, y1);
    }
}

// ---- the bits by columns

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
