// SMAA's blending weights of one edge pixel: areas, diagonals, lines along rows or columns. Left edges are top edges of
// the transposed planes. Include from *.kernel.cpp only.
#pragma once
#include "methods/spatial/area.kernel.h"
#include "methods/spatial/edge_bits.kernel.h"
#include "methods/spatial/smaa_kernels.h"

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
AA_INLINE Pair<T> orthoArea(int left, int right, int leftPx, int rightPx, T offset) {
    const Pair<T> nothing{T(0), T(0)};
    const bool single1 = left == 1 || left == 3, single2 = right == 1 || right == 3;
    if (!single1 && !single2) return nothing;
    const T l = T(leftPx), d = T(leftPx + rightPx + 1), above = T(0.5) + offset, below = T(-0.5) + offset;
    const T h1 = left == 1 ? above : below, h2 = right == 1 ? above : below;
    if (single1 && single2) {
        if (left == right) return smoothed(firstHalf(h1, d, l), d) + smoothed(secondHalf(h2, d, l), d);
        const Pair<T> z = segmentArea(T(0), h1, d, h2, l);
        if (offset == T(0)) return z;
        const Pair<T> bothHalves = firstHalf(h1, d, l) + secondHalf(h2, d, l);
        return {(z.own + bothHalves.own) * T(0.5), (z.opposite + bothHalves.opposite) * T(0.5)};
    }
    if (single1) {
        if (right == 4) return segmentArea(T(0), h1, d, left == 1 ? below : above, l);
        return leftPx <= rightPx ? firstHalf(h1, d, l) : nothing;
    }
    if (left == 4) return segmentArea(T(0), right == 1 ? below : above, d, h2, l);
    return leftPx >= rightPx ? secondHalf(h2, d, l) : nothing;
}
// The published form: 16 x 16 entries at square distances, bilinear in the roots.
template <class T>
AA_INLINE Pair<T> tableArea(const float* table, int left, int right, int leftPx, int rightPx) {
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

// ---- diagonals: `top` and `left` are the edge bits of a pixel's upper and left border

struct EdgesAt {
    const SmaaImage& image;
    AA_INLINE bool top(int x, int y) const { return bitAt(image.top.along + long(y) * image.top.stride, x); }
    AA_INLINE bool left(int x, int y) const { return bitAt(image.top.cross + long(y) * image.top.stride, x); }
};
struct DiagonalEnd {
    int distance;
    bool found;
};
// One arm: pixels at n * (dx, dy) as long as both bits of the staircase are set; the left bit is read `leftShift` away.
AA_INLINE DiagonalEnd diagonalArm(const EdgesAt& e, int steps, int x, int y, int dx, int dy, int leftShift,
                                  bool countLast) {
    int n = 1, passed = 0;
    bool success = true;
    for (; n <= steps && success; n++) {
        success = e.top(x + n * dx, y + n * dy) && e.left(x + n * dx + leftShift, y + n * dy);
        passed += success;
    }
    const int distance = passed < steps - 1 ? passed : steps - 1;
    const bool last = countLast && e.top(x + (n - 1) * dx, y + (n - 1) * dy);
    return {distance + (last ? 1 : 0), !success};
}
template <class T>
AA_INLINE Pair<T> diagonalLookup(const float* table, bool h1, bool v1, bool found1, bool h2, bool v2, bool found2,
                                 int d1, int d2) {
    const int c1 = found1 ? 2 * h1 + v1 : 0, c2 = found2 ? 2 * h2 + v2 : 0;
    const float* const p = table + 2 * (((c1 * 4 + c2) * kDiagonals + d1) * kDiagonals + d2);
    return {T(p[0]), T(p[1])};
}
// A diagonal is longer than 2 px, so one of its arms passes its first pixel: where the bits of a row's neighbours allow
// that, for the pixels from x on. Bottom left to top right, and top left to bottom right.
struct DiagonalCandidates {
    uint64_t rising, falling;
    AA_INLINE DiagonalCandidates(const SmaaImage& image, int x, int y) {
        const long stride = image.top.stride;
        const uint8_t *top = image.top.along + y * stride, *left = image.top.cross + y * stride;
        const uint8_t *topAbove = top - stride, *leftAbove = left - stride, *topBelow = top + stride,
                      *leftBelow = left + stride;
        rising = (bitsFrom(topAbove, x + 1) & bitsFrom(leftAbove, x + 1)) |
                 (bitsFrom(left, x) & bitsFrom(topBelow, x - 1) & bitsFrom(leftBelow, x - 1));
        falling = (bitsFrom(topAbove, x - 1) & bitsFrom(leftAbove, x)) |
                  (bitsFrom(left, x + 1) & bitsFrom(topBelow, x + 1) & bitsFrom(leftBelow, x + 2));
    }
};
template <class T>
AA_INLINE Pair<T> diagonalWeights(const SmaaBlendArgs& a, const SmaaImage& image, int x, int y) {
    const EdgesAt e{image};
    const int steps = a.diagonalSteps;
    Pair<T> sum{T(0), T(0)};
    const DiagonalCandidates candidates(image, x, y);
    if (candidates.rising & 1) {
        const DiagonalEnd d1 = e.left(x, y) ? diagonalArm(e, steps, x, y, -1, 1, 0, true) : DiagonalEnd{0, true};
        const DiagonalEnd d2 = diagonalArm(e, steps, x, y, 1, -1, 0, false);
        const int n = d1.distance, m = d2.distance;
        if (n + m > 2)
            sum = diagonalLookup<T>(image.diagonalTable[0], e.top(x - n - 1, y + n), e.left(x - n, y + n), d1.found,
                                    e.top(x + m + 1, y - m), e.left(x + m + 1, y - m - 1), d2.found, n, m);
    }
    if (candidates.falling & 1) {  // the same shape mirrored, so that own and opposite change places
        const DiagonalEnd d1 = diagonalArm(e, steps, x, y, -1, -1, 1, false);
        const DiagonalEnd d2 = e.left(x + 1, y) ? diagonalArm(e, steps, x, y, 1, 1, 1, true) : DiagonalEnd{0, true};
        const int n = d1.distance, m = d2.distance;
        if (n + m > 2) {
            const Pair<T> w =
                diagonalLookup<T>(image.diagonalTable[1], e.top(x - n - 1, y - n), e.left(x - n, y - n - 1), d1.found,
                                  e.top(x + m + 1, y + m), e.left(x + m + 1, y + m), d2.found, n, m);
            sum = sum + Pair<T>{w.opposite, w.own};
        }
    }
    // Where a rising and a falling one cross they sum to up to 1.185; the published target of 8 bits holds 1.
    return {min(sum.own, T(1)), min(sum.opposite, T(1))};
}

// ---- lines along rows or columns

// Edges that cross the end of a line, from its row -2 to +1: bits 1 and 2 touch it, 0 and 3 lie beyond.
AA_INLINE unsigned crossingBits(const SmaaAxis& axis, int p, int q) {
    const int row = p < 0 ? 0 : p < axis.crossTransposedRows ? p : axis.crossTransposedRows - 1;  // the sampler clamps
    return unsigned(bitsFrom(axis.crossTransposed + long(row) * axis.crossTransposedStride, q - 2)) & 15u;
}
AA_INLINE int crossingCode(unsigned bits) { return (bits & 2 ? 1 : 0) + (bits & 4 ? 3 : 0); }
// Crossing edges make the line turn: a sharp corner keeps part of its shape. The factors of both weights for every
// combination of nearer end (left, right, both alike) and crossing edges beyond the line (rows -2 and +1, either end).
template <class T>
struct Corners {
    Pair<T> factor[3 * 16];
    AA_INLINE explicit Corners(float cornerRounding) {
        const T reduction = cornerRounding < 0 ? T(0) : T(1) - T(cornerRounding);  // negative: off
        for (int nearer = 0; nearer < 3; nearer++)
            for (int bits = 0; bits < 16; bits++) {
                const T share = nearer == 2 ? reduction * T(0.5) : reduction;
                const T left = nearer != 1 ? share : T(0), right = nearer != 0 ? share : T(0);
                auto at = [&](int leftBit, int rightBit) __attribute__((always_inline)) {
                    return max(T(0), T(1) - (bits & leftBit ? left : T(0)) - (bits & rightBit ? right : T(0)));
                };
                factor[nearer * 16 + bits] = {at(2, 8), at(1, 4)};
            }
    }
    AA_INLINE Pair<T> of(unsigned leftBits, unsigned rightBits, int leftPx, int rightPx) const {
        const int nearer = int(leftPx > rightPx) + 2 * int(leftPx == rightPx);
        const unsigned bits = (leftBits & 1) | (leftBits >> 2 & 2) | (rightBits & 1) << 2 | (rightBits & 8);
        return factor[nearer * 16 + int(bits)];
    }
};
template <class T>
AA_INLINE Pair<T> stored(const SmaaBlendArgs& a, Pair<T> w) {
    if (a.unorm8) w = {floor(w.own * T(255) + T(0.5)) / T(255), floor(w.opposite * T(255) + T(0.5)) / T(255)};
    return {T(float(w.own)), T(float(w.opposite))};
}
// The edge at position p of line q; `pixel` is its index in the debug planes, negative where another block keeps it.
template <class T>
AA_INLINE Pair<T> lineWeights(const SmaaBlendArgs& a, const SmaaAxis& axis, const Corners<T>& corners, int p, int q,
                              long pixel) {
    const int reach = 2 * a.searchSteps;
    const uint8_t *along = axis.along + long(q) * axis.stride, *cross = axis.cross + long(q) * axis.stride;
    const int leftPx = runDown(along, cross, cross - axis.stride, p, reach - 1);
    const int rightPx = runUp(along, cross, cross - axis.stride, p, reach);
    const unsigned leftBits = crossingBits(axis, p - leftPx, q), rightBits = crossingBits(axis, p + rightPx + 1, q);
    Pair<T> w;
    if (std::is_same_v<T, float> && axis.exactTable) {
        const unsigned pair = (leftBits >> 1 & 3) * 4 + (rightBits >> 1 & 3);
        const float* const entry = axis.exactTable + 2 * ((long(pair) * reach + leftPx) * (reach + 1) + rightPx);
        w = {T(entry[0]), T(entry[1])};
    } else if (axis.publishedTable) {
        w = tableArea<T>(axis.publishedTable, crossingCode(leftBits), crossingCode(rightBits), leftPx, rightPx);
    } else {
        w = orthoArea<T>(crossingCode(leftBits), crossingCode(rightBits), leftPx, rightPx, T(axis.offset));
    }
    w = {min(w.own, T(1)), min(w.opposite, T(1))};  // samples beyond their pixel (jitter + position) lift lines over it
    const Pair<T> rounding = corners.of(leftBits, rightBits, leftPx, rightPx);
    w = {w.own * rounding.own, w.opposite * rounding.opposite};
    if (axis.lengths && pixel >= 0) {
        axis.lengths[2 * pixel] = float(leftPx);
        axis.lengths[2 * pixel + 1] = float(rightPx);
    }
    return stored(a, w);
}
AA_INLINE void keep(const SmaaAxis& axis, long pixel, float own, float opposite) {
    if (!axis.weights || pixel < 0) return;
    axis.weights[2 * pixel] = own;
    axis.weights[2 * pixel + 1] = opposite;
}

}  // namespace AA_ARCH
