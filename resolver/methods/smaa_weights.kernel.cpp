#include "kernels/sparse.h"
#include "methods/area.kernel.h"
#include "methods/smaa_kernels.h"

// SMAA's blending weights. Works on rows of top edges; for left edges it runs on the transposed plane, in which the two
// edge bits have changed places.
namespace AA_ARCH {
using namespace aa;

// Short U shapes are rounded: their tips would alternate otherwise.
template <class T>
AA_INLINE Pair<T> smoothed(Pair<T> a, T d) {
    const T t = min(d * T(1.0 / 32), T(1));
    auto bend = [&](T v) __attribute__((always_inline)) {
        const T s = sqrt(v + v) * T(0.5);
        return s + (v - s) * t;
    };
    return {bend(a.own), bend(a.opposite)};
}
// Crossing codes of the two ends (0 none, 1 above, 3 below, 4 both), distances to them in px -> weights.
template <class T>
AA_INLINE Pair<T> ortho_area(int left, int right, int leftPx, int rightPx, T offset) {
    const Pair<T> nothing{T(0), T(0)};
    const bool single1 = left == 1 || left == 3, single2 = right == 1 || right == 3;
    if (!single1 && !single2) return nothing;
    const T l = T(leftPx), d = T(leftPx + rightPx + 1), above = T(0.5) + offset, below = T(-0.5) + offset;
    const T h1 = left == 1 ? above : below, h2 = right == 1 ? above : below;
    if (single1 && single2) {
        if (left == right) return smoothed(first_half(h1, d, l), d) + smoothed(second_half(h2, d, l), d);
        const Pair<T> z = segment_area(T(0), h1, d, h2, l);
        if (offset == T(0)) return z;
        const Pair<T> both_halves = first_half(h1, d, l) + second_half(h2, d, l);
        return {(z.own + both_halves.own) * T(0.5), (z.opposite + both_halves.opposite) * T(0.5)};
    }
    if (single1) {
        if (right == 4) return segment_area(T(0), h1, d, left == 1 ? below : above, l);
        return leftPx <= rightPx ? first_half(h1, d, l) : nothing;
    }
    if (left == 4) return segment_area(T(0), right == 1 ? below : above, d, h2, l);
    return leftPx >= rightPx ? second_half(h2, d, l) : nothing;
}
// The published form: 16 x 16 entries at square distances, bilinear in the roots.
template <class T>
AA_INLINE Pair<T> table_area(const float* table, int left, int right, int leftPx, int rightPx) {
    const float* const block = table + (left * 5 + right) * 16 * 16 * 2;
    const T u = min(sqrt(T(leftPx)), T(15)), v = min(sqrt(T(rightPx)), T(15));
    const int i = int(u) < 14 ? int(u) : 14, j = int(v) < 14 ? int(v) : 14;
    const T fu = u - T(i), fv = v - T(j);
    auto at = [&](int k) __attribute__((always_inline)) {
        const float* const p = block + 2 * (i * 16 + j) + k;
        const T a = T(p[0]) + (T(p[32]) - T(p[0])) * fu, b = T(p[2]) + (T(p[34]) - T(p[2])) * fu;
        return a + (b - a) * fv;
    };
    return {at(0), at(1)};
}

AA_INLINE bool has(const uint8_t* edges, long o, uint8_t bit) { return edges[o] & bit; }
struct DiagonalEnd {
    int distance;
    bool found;
};
// One arm: pixels at o + n * step as long as both bits of the staircase are set; the left bit is read `leftShift` away.
AA_INLINE DiagonalEnd diagonal_arm(const SmaaWeightArgs& a, long o, long step, long leftShift, bool countLast) {
    int n = 1, passed = 0;
    bool success = true;
    for (; n <= a.diagonalSteps && success; n++) {
        success = has(a.edges, o + n * step, kEdgeTop) && has(a.edges, o + n * step + leftShift, kEdgeLeft);
        passed += success;
    }
    const int distance = passed < a.diagonalSteps - 1 ? passed : a.diagonalSteps - 1;
    const bool last = countLast && has(a.edges, o + (n - 1) * step, kEdgeTop);
    return {distance + (last ? 1 : 0), !success};
}
template <class T>
AA_INLINE Pair<T> diagonal_lookup(const float* table, bool h1, bool v1, bool found1, bool h2, bool v2, bool found2,
                                  int d1, int d2) {
    const int c1 = found1 ? 2 * h1 + v1 : 0, c2 = found2 ? 2 * h2 + v2 : 0;
    const float* const p = table + 2 * (((c1 * 4 + c2) * kDiagonals + d1) * kDiagonals + d2);
    return {T(p[0]), T(p[1])};
}
template <class T>
AA_INLINE Pair<T> diagonal_weights(const SmaaWeightArgs& a, long o) {
    const uint8_t* const e = a.edges;
    const long s = a.edgeStride;
    Pair<T> sum{T(0), T(0)};
    {  // from bottom left to top right
        const DiagonalEnd d1 = has(e, o, kEdgeLeft) ? diagonal_arm(a, o, s - 1, 0, true) : DiagonalEnd{0, true};
        const DiagonalEnd d2 = diagonal_arm(a, o, 1 - s, 0, false);
        if (d1.distance + d2.distance > 2) {
            const long p = o + d1.distance * (s - 1), q = o + d2.distance * (1 - s);
            sum = diagonal_lookup<T>(a.diagonalTable[0], has(e, p - 1, kEdgeTop), has(e, p, kEdgeLeft), d1.found,
                                     has(e, q + 1, kEdgeTop), has(e, q + 1 - s, kEdgeLeft), d2.found, d1.distance,
                                     d2.distance);
        }
    }
    // from top left to bottom right: the same shape mirrored, so that own and opposite change places
    const DiagonalEnd d1 = diagonal_arm(a, o, -s - 1, 1, false);
    const DiagonalEnd d2 = has(e, o + 1, kEdgeLeft) ? diagonal_arm(a, o, s + 1, 1, true) : DiagonalEnd{0, true};
    if (d1.distance + d2.distance > 2) {
        const long p = o + d1.distance * (-s - 1), q = o + d2.distance * (s + 1);
        const Pair<T> w =
            diagonal_lookup<T>(a.diagonalTable[1], has(e, p - 1, kEdgeTop), has(e, p - s, kEdgeLeft), d1.found,
                               has(e, q + 1, kEdgeTop), has(e, q + 1, kEdgeLeft), d2.found, d1.distance, d2.distance);
        sum = sum + Pair<T>{w.opposite, w.own};
    }
    return sum;
}

// Crossing edges make the line turn: a sharp corner keeps part of its shape.
template <class T>
AA_INLINE Pair<T> rounded_corners(const SmaaWeightArgs& a, Pair<T> w, long leftEnd, long rightEnd, int leftPx,
                                  int rightPx) {
    const T reduction = T(1) - T(a.cornerRounding), share = leftPx == rightPx ? reduction * T(0.5) : reduction;
    const T left = leftPx <= rightPx ? share : T(0), right = rightPx <= leftPx ? share : T(0);
    const long s = a.edgeStride;
    auto factor = [&](long row) __attribute__((always_inline)) {
        const T l = has(a.edges, leftEnd + row, kEdgeLeft) ? left : T(0);
        const T r = has(a.edges, rightEnd + 1 + row, kEdgeLeft) ? right : T(0);
        return max(T(0), T(1) - l - r);
    };
    return {w.own * factor(s), w.opposite * factor(-2 * s)};
}
AA_INLINE int crossing_code(const SmaaWeightArgs& a, long end) {
    return (has(a.edges, end - a.edgeStride, kEdgeLeft) ? 1 : 0) + (has(a.edges, end, kEdgeLeft) ? 3 : 0);
}
template <class T>
AA_INLINE void write_weights(const SmaaWeightArgs& a, int x, int y, Pair<T> w) {
    float* const p = a.weights + 2 * (x * a.weightAlong + y * a.weightAcross);
    if (a.unorm8) w = {floor(w.own * T(255) + T(0.5)) / T(255), floor(w.opposite * T(255) + T(0.5)) / T(255)};
    p[0] = float(w.own);
    p[1] = float(w.opposite);
}
// A line is a run of top edges that no left edge crosses. The pixel's own search is capped.
struct Line {
    int first, last;
};
AA_INLINE bool starts_line(const SmaaWeightArgs& a, const uint8_t* e) {
    return !(e[-1] & kEdgeTop) || ((e[0] | e[-long(a.edgeStride)]) & kEdgeLeft);
}
AA_INLINE Line line_at(const SmaaWeightArgs& a, const uint8_t* row, int x) {
    Line line{x, x};
    const int reach = 2 * a.searchSteps;
    while (line.first > -reach && !starts_line(a, row + line.first)) line.first--;
    while (line.last < a.width + reach && (row[line.last + 1] & kEdgeTop) && !starts_line(a, row + line.last + 1))
        line.last++;
    return line;
}
template <class T>
AA_INLINE void ortho_pixel(const SmaaWeightArgs& a, const Line& line, int x, int y) {
    const int reach = 2 * a.searchSteps;
    const int leftPx = x - line.first < reach - 1 ? x - line.first : reach - 1;
    const int rightPx = line.last - x < reach ? line.last - x : reach;
    const long o = long(y) * a.edgeStride + x;
    const int left = crossing_code(a, o - leftPx), right = crossing_code(a, o + rightPx + 1);
    Pair<T> w = a.orthoTable ? table_area<T>(a.orthoTable, left, right, leftPx, rightPx)
                             : ortho_area<T>(left, right, leftPx, rightPx, T(a.offset));
    w = {min(w.own, T(1)), min(w.opposite, T(1))};  // samples beyond their pixel (jitter + position) lift lines over it
    if (a.cornerRounding >= 0) w = rounded_corners(a, w, o - leftPx, o + rightPx, leftPx, rightPx);
    write_weights(a, x, y, w);
    if (a.lengths) {
        float* const p = a.lengths + 2 * (x * a.weightAlong + y * a.weightAcross);
        p[0] = float(leftPx);
        p[1] = float(rightPx);
    }
}
template <class R>
__attribute__((flatten)) void weightRows(const SmaaWeightArgs& a, int y0, int y1) {
    using T = Elem<R>;
    for (int y = y0; y < y1; y++) {
        const uint8_t* const row = a.edges + long(y) * a.edgeStride;
        Line line{0, -1};
        for (int x0 = 0; x0 < a.width; x0 += 8)
            for_each_byte(
                load_bytes(row + x0), [&](int i) __attribute__((always_inline)) {
                    const int x = x0 + i;
                    if (x >= a.width) return;
                    const uint8_t e = row[x];
                    bool diagonal = (e & kDiagonalDone) != 0;
                    if ((e & kEdgeTop) && diagonal) write_weights(a, x, y, Pair<T>{T(0), T(0)});
                    if ((e & kEdgeTop) && !diagonal) {
                        if (a.transposed && a.diagonalSteps > 0) {
                            const Pair<T> w = diagonal_weights<T>(a, long(y) * a.edgeStride + x);
                            diagonal = w.own + w.opposite > T(0);
                            if (diagonal) write_weights(a, x, y, w);
                        }
                        if (!diagonal) {
                            if (x > line.last) line = line_at(a, row, x);
                            ortho_pixel<T>(a, line, x, y);
                        }
                    }
                    if (a.transposed)
                        a.transposed[long(x) * a.transposedStride + y] =
                            uint8_t((e & kEdgeTop ? kEdgeLeft : 0) | (e & kEdgeLeft ? kEdgeTop : 0) |
                                    (diagonal ? kDiagonalDone : 0));
                });
    }
}
template <class R>
void areaRows(const SmaaAreaArgs& a, int from, int to) {
    for (int k = from; k < to; k++) {
        SmaaAreaQuery& q = a.queries[k];
        const auto w = ortho_area<Elem<R>>(q.left, q.right, q.leftPx, q.rightPx, Elem<R>(q.offset));
        q.own = double(w.own);
        q.opposite = double(w.opposite);
    }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::SmaaWeightKernels, smaaWeightKernels) = {AA_ROWS(weightRows), AA_ROWS(areaRows)};
