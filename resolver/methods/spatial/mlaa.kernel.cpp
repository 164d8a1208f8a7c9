#include "methods/spatial/mlaa.h"

#include "methods/spatial/area.kernel.h"
#include "methods/spatial/edge_bits.kernel.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
AA_INLINE vec3<R> fourHighestBits(vec3<R> c) {  // of the 8-bit code
    using T = Elem<R>;
    auto bits = [](R v) __attribute__((always_inline)) {
        return floor(floor(v * R(T(255)) + R(T(0.5))) * R(T(1.0 / 16)));
    };
    return {bits(c.x), bits(c.y), bits(c.z)};
}
template <class R>
AA_INLINE Mask<R> differ(vec3<R> a, vec3<R> b, MlaaRule rule) {
    using T = Elem<R>;
    if (rule == MlaaRule::msb4) return maxComponent(abs(fourHighestBits(a) - fourHighestBits(b))) >= R(T(0.5));
    if (rule == MlaaRule::luma) return abs(luma601(a) - luma601(b)) >= R(T(0.1));
    return maxComponent(abs(a - b)) >= R(T(1.0 / 16));
}
template <class R>
__attribute__((flatten)) void mlaaEdgeRows(const MlaaEdgeArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += 8) {
            unsigned left = 0, top = 0;
            for (int i = 0; i < 8; i += N<R>) {
                const long o = long(y) * a.stride + x + i;
                const vec3<R> c = colourAt<R>(a.in.c, o);
                left |= maskBits<R>(differ(c, colourAt<R>(a.in.c, o - 1), a.rule)) << i;
                top |= maskBits<R>(differ(c, colourAt<R>(a.in.c, o - a.stride), a.rule)) << i;
            }
            a.left[long(y) * a.bitStride + (x >> 3)] = uint8_t(left);
            a.top[long(y) * a.bitStride + (x >> 3)] = uint8_t(top);
        }
}

// The last pixel of the run of set bits that holds p, and the first. The bits around the image are 0.
AA_INLINE int lastOfRun(const uint8_t* row, int p) {
    for (int q = p;; q += kWindow) {
        const int n = __builtin_ctzll(~bitsFrom(row, q) | uint64_t(1) << kWindow);
        if (n < kWindow) return q + n - 1;
    }
}
AA_INLINE int firstOfRun(const uint8_t* row, int p) {
    for (int q = p;; q -= kWindow) {
        const int n =
            __builtin_clzll(~(bitsFrom(row, q - (kWindow - 1)) << (64 - kWindow)) | uint64_t(1) << (63 - kWindow));
        if (n < kWindow) return q - n + 1;
    }
}
// Where the silhouette meets the edge that crosses an end of a line, as a share of its length: where the line's last
// pixel (`own`) and the one beyond the crossing edge, if that has a line of its own one row farther, get one luma.
template <class T>
AA_INLINE T meetingHeight(const RgbIn& in, long own, long beyond, long across) {
    const auto luma = [&](long o) __attribute__((always_inline)) { return luma601(colourAt<T>(in.c, o)); };
    const T gained = luma(beyond + across) - luma(own), lost = luma(own - across) - luma(beyond);
    const T sum = gained + lost;
    if (!(abs(sum) >= T(2.5 / 255))) return T(0.5);  // within two codes: rounding to 8 bits would decide
    return clamp(gained / sum, T(1e-3), T(1));       // not 0: the crossing edges alone make the shape
}
template <class T>
AA_INLINE MlaaLine lineThrough(const MlaaBlendArgs& a, const MlaaAxis& axis, int p, int q) {
    const uint8_t *along = axis.along + long(q) * axis.stride, *cross = axis.cross + long(q) * axis.stride;
    const int first = firstOfRun(along, p), last = lastOfRun(along, p);
    auto height = [&](int at) __attribute__((always_inline)) {  // +1/2 up, -1/2 down, 2 both
        const bool up = bitAt(cross - axis.stride, at), down = bitAt(cross, at);
        return up && down ? 2.0f : up ? 0.5f : down ? -0.5f : 0.0f;
    };
    float left = height(first), right = height(last + 1);
    if (left == 2) left = right == 2 ? 0 : -right;  // make a Z with the other end where there is one
    if (right == 2) right = -left;
    if (a.heights == MlaaHeights::colour) {
        const auto choose = [&](float& end, int own, int beyond) __attribute__((always_inline)) {
            if (end == 0 || !bitAt(end > 0 ? along - axis.stride : along + axis.stride, beyond)) return;
            // Up: the row before the line, and what lies behind it is one row farther up.
            const long row = (end > 0 ? long(q) - 1 : long(q)) * axis.acrossStep;
            const T share = meetingHeight<T>(a.in, own * axis.alongStep + row, beyond * axis.alongStep + row,
                                             end > 0 ? -axis.acrossStep : axis.acrossStep);
            end = float(end > 0 ? share : -share);
        };
        choose(left, first, first - 1), choose(right, last, last + 1);
    }
    return {first, last, left, right};
}
template <class T>
AA_INLINE Pair<T> mlaaArea(T left, T right, int leftPx, int rightPx) {
    const T l = T(leftPx), d = T(leftPx + rightPx + 1);
    if (left * right < T(0)) return segmentArea(T(0), left, d, right, l);
    Pair<T> sum{T(0), T(0)};
    if (left != T(0)) sum = firstHalf(left, d, l);
    if (right != T(0)) sum = sum + secondHalf(right, d, l);
    return sum;
}
AA_INLINE long areaIndex(int pair, int leftPx, int rightPx) {
    return 2 * ((long(pair) * kMlaaTabled + leftPx) * kMlaaTabled + rightPx);
}
template <class R>
void mlaaAreaRows(const MlaaAreaArgs& a, int from, int to) {
    static constexpr float heights[] = {0.0f, 0.5f, -0.5f};
    for (int pair = from; pair < to; pair++)
        for (int l = 0; l < kMlaaTabled; l++)
            for (int r = 0; r < kMlaaTabled; r++) {
                const auto w = mlaaArea<float>(heights[pair / 3], heights[pair % 3], l, r);
                a.areas[areaIndex(pair, l, r)] = w.own;
                a.areas[areaIndex(pair, l, r) + 1] = w.opposite;
            }
}
// Weights of the edge at position p of a line; `pixel` is its index in the debug planes, negative where another block
// keeps it.
template <class T>
AA_INLINE void writeWeights(const MlaaBlendArgs& a, const MlaaAxis& axis, const MlaaLine& line, int p, long pixel,
                            float* weights) {
    const int leftPx = p - line.first, rightPx = line.last - p;
    if (std::is_same_v<T, float> && a.heights == MlaaHeights::half && leftPx < kMlaaTabled && rightPx < kMlaaTabled) {
        auto side = [](float height) { return height > 0 ? 1 : height < 0 ? 2 : 0; };
        const float* const entry = a.areas + areaIndex(3 * side(line.left) + side(line.right), leftPx, rightPx);
        weights[0] = entry[0];
        weights[1] = entry[1];
    } else {
        const Pair<T> w = mlaaArea<T>(T(line.left), T(line.right), leftPx, rightPx);
        weights[0] = float(w.own);
        weights[1] = float(w.opposite);
    }
    if (!axis.weights || pixel < 0) return;
    axis.weights[2 * pixel] = weights[0];
    axis.weights[2 * pixel + 1] = weights[1];
    const float product = line.left * line.right;
    axis.shapes[pixel] = product < 0 ? 2.0f : product > 0 ? 3.0f : line.left + line.right != 0 ? 1.0f : 0.0f;
}
template <class T>
AA_INLINE void topWeights(const MlaaBlendArgs& a, int y, bool own, float* weights) {
    const uint8_t* const top = a.top.along + long(y) * a.top.stride;
    MlaaLine line{0, -1, 0, 0};
    forEachBit(
        a.width, [&](int x) { return bitsFrom(top, x); },
        [&](int x) __attribute__((always_inline)) {
            if (x > line.last) line = lineThrough<T>(a, a.top, x, y);
            writeWeights<T>(a, a.top, line, x, own ? long(y) * a.width + x : -1, weights + 2 * x);
        });
}
template <class T>
AA_INLINE void leftWeights(const MlaaBlendArgs& a, int y, MlaaLine* columns, float* weights) {
    const uint8_t* const left = a.top.cross + long(y) * a.top.stride;
    forEachBit(
        a.width, [&](int x) { return bitsFrom(left, x); },
        [&](int x) __attribute__((always_inline)) {
            if (y > columns[x].last) columns[x] = lineThrough<T>(a, a.left, y, x);
            writeWeights<T>(a, a.left, columns[x], y, long(y) * a.width + x, weights + 2 * x);
        });
}

// Heights by colour can take more than all of a pixel between two lines.
template <class T>
AA_INLINE void shareOut(T& toFirst, T& toSecond) {
    const T sum = toFirst + toSecond;
    if (sum > T(1)) toFirst = toFirst / sum, toSecond = toSecond / sum;
}
template <class T>
AA_INLINE void blendPixel(const MlaaBlendArgs& a, long o, T toFirst, T toSecond, const T first[3], const T second[3]) {
    shareOut(toFirst, toSecond);
    for (int c = 0; c < 3; c++) {
        const T own = a.out.c[c][o];
        // Rounded, two shares that sum to 1 may leave less than nothing of a bright pixel between black ones.
        a.out.c[c][o] = float(max(own + toFirst * (first[c] - own) + toSecond * (second[c] - own), T(0)));
    }
}
// Horizontal lines blend the original rows; vertical lines blend the row that this gives, or (simultaneous) the
// original one too, and a pixel that both move goes halfway with each.
template <class T>
AA_INLINE void blendRow(const MlaaBlendArgs& a, int y, const float* top, const float* below, const float* left) {
    const uint8_t *tops = a.top.along + long(y) * a.top.stride, *belows = tops + a.top.stride,
                  *lefts = a.top.cross + long(y) * a.top.stride;
    auto weight = [](const uint8_t* bits, int x, float w) __attribute__((always_inline)) {
        return bitAt(bits, x) ? T(w) : T(0);  // where there is no edge the scratch holds what was there before
    };
    forEachBit(
        a.width, [&](int x) { return bitsFrom(tops, x) | bitsFrom(belows, x); },
        [&](int x) __attribute__((always_inline)) {
            const long o = long(y) * a.stride + x;
            T above[3], under[3];
            for (int c = 0; c < 3; c++) above[c] = a.in.c[c][o - a.stride], under[c] = a.in.c[c][o + a.stride];
            blendPixel(a, o, weight(tops, x, top[2 * x]), weight(belows, x, below[2 * x + 1]), above, under);
        });
    int lastX = -2;
    T beforeBlend[3] = {T(0), T(0), T(0)};  // of pixel lastX
    forEachBit(
        a.width, [&](int x) { return bitsFrom(lefts, x) | bitsFrom(lefts, x + 1); },
        [&](int x) __attribute__((always_inline)) {
            const long o = long(y) * a.stride + x;
            T toLeft = weight(lefts, x, left[2 * x]), toRight = weight(lefts, x + 1, left[2 * x + 3]);
            if (a.simultaneous) {
                shareOut(toLeft, toRight);
                const bool both =
                    weight(tops, x, top[2 * x]) + weight(belows, x, below[2 * x + 1]) > T(0) && toLeft + toRight > T(0);
                for (int c = 0; c < 3; c++) {
                    const float* p = a.in.c[c] + o;
                    const T own = p[0], moved = toLeft * (T(p[-1]) - own) + toRight * (T(p[1]) - own);
                    const T sum = T(a.out.c[c][o]) - own + moved;
                    a.out.c[c][o] = float(max(own + (both ? sum * T(0.5) : sum), T(0)));
                }
                return;
            }
            T before[3], after[3];
            for (int c = 0; c < 3; c++) {
                // Beyond the picture lies nothing that was written, and no weight leads there.
                before[c] = lastX == x - 1 ? beforeBlend[c] : T(a.out.c[c][x > 0 ? o - 1 : o]);
                after[c] = a.out.c[c][x + 1 < a.width ? o + 1 : o];
                beforeBlend[c] = a.out.c[c][o];
            }
            lastX = x;
            blendPixel(a, o, toLeft, toRight, before, after);
        });
}
template <class R>
__attribute__((flatten)) void mlaaBlendBlocks(const MlaaBlendArgs& a, int b0, int b1) {
    using T = Elem<R>;
    const long rowSize = 2l * a.width + 2;
    for (int block = b0; block < b1; block++) {
        float* top = a.scratch + block * a.scratchSize;
        float *below = top + rowSize, *const left = below + rowSize;
        MlaaLine* const columns = a.columns + long(block) * a.width;
        for (int x = 0; x < a.width; x++) columns[x].last = -1;
        const int y0 = block * kMlaaBlockRows, y1 = y0 + kMlaaBlockRows < a.height ? y0 + kMlaaBlockRows : a.height;
        topWeights<T>(a, y0, true, top);
        for (int y = y0; y < y1; y++) {
            for (int c = 0; c < 3; c++)
                for (int x = 0; x < a.width; x += N<R>) {
                    const long o = long(y) * a.stride + x;
                    store(load<R>(a.in.c[c] + o), a.out.c[c] + o);
                }
            if (y + 1 < a.height) topWeights<T>(a, y + 1, y + 1 < y1, below);
            leftWeights<T>(a, y, columns, left);
            blendRow<T>(a, y, top, below, left);
            float* const spare = top;
            top = below, below = spare;
        }
    }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::MlaaKernels, mlaaKernels) = {AA_ROWS(mlaaEdgeRows), AA_ROWS(mlaaBlendBlocks),
                                                 AA_ROWS(mlaaAreaRows)};
