#include "methods/spatial/smaa_weights.kernel.h"

// SMAA's blend, row by row: the weights of a row's edges, then the row, of both images where there are two.
namespace AA_ARCH {

// ---- the weights of a row's edges, 0 where there is none

struct RowWeights {
    float *own, *opposite;
    AA_INLINE void clear(int width) {
        __builtin_memset(own, 0, size_t(width) * sizeof(float));
        __builtin_memset(opposite, 0, size_t(width) * sizeof(float));
    }
    template <class T>
    AA_INLINE void set(int x, Pair<T> w, const SmaaAxis& debug, long pixel) {
        own[x] = float(w.own), opposite[x] = float(w.opposite);
        keep(debug, pixel, own[x], opposite[x]);
    }
};
// Of the row's top edges; sets the bits of the pixels that a diagonal took. `own`: the row is one of the call's, and
// not the one after them.
template <class T>
AA_INLINE void topWeights(const SmaaBlendArgs& a, const SmaaImage& image, const Corners<T>& corners, int y, bool own,
                          RowWeights weights, uint8_t* diagonals) {
    const uint8_t* const top = image.top.along + long(y) * image.top.stride;
    const auto pixel = [&](int x) { return own ? long(y) * a.width + x : -1; };
    __builtin_memset(diagonals, 0, size_t(a.width / 8 + 9));
    weights.clear(a.width);
    if (a.diagonalSteps > 0)
        forEachBit(
            a.width,
            [&](int x) {
                const DiagonalCandidates candidates(image, x, y);
                return bitsFrom(top, x) & (candidates.rising | candidates.falling);
            },
            [&](int x) __attribute__((always_inline)) {
                const Pair<T> w = diagonalWeights<T>(a, image, x, y);
                if (!(w.own + w.opposite > T(0))) return;
                diagonals[x >> 3] = uint8_t(diagonals[x >> 3] | 1 << (x & 7));
                if (image.isDiagonal && own) image.isDiagonal[pixel(x)] = 1;
                weights.set(x, stored(a, w), image.top, pixel(x));
            });
    forEachBit(
        a.width, [&](int x) { return bitsFrom(top, x) & ~bitsFrom(diagonals, x); },
        [&](int x) __attribute__((always_inline)) {
            weights.set(x, lineWeights<T>(a, image.top, corners, x, y, pixel(x)), image.top, pixel(x));
        });
}
template <class T>
AA_INLINE void leftWeights(const SmaaBlendArgs& a, const SmaaImage& image, const Corners<T>& corners, int y,
                           RowWeights weights, const uint8_t* diagonals) {
    const uint8_t* const left = image.top.cross + long(y) * image.top.stride;
    weights.clear(a.width);
    forEachBit(
        a.width, [&](int x) { return bitsFrom(left, x) & ~bitsFrom(diagonals, x); },
        [&](int x) __attribute__((always_inline)) {
            const long pixel = long(y) * a.width + x;
            weights.set(x, lineWeights<T>(a, image.left, corners, y, x, pixel), image.left, pixel);
        });
    weights.opposite[a.width] = weights.opposite[a.width - 1];  // the sampler clamps
}
// Of one image, for the row that is blended: its top edges, those of the row below, its left edges.
struct ImageWeights {
    RowWeights top, below, left;
    uint8_t *topDiagonals, *belowDiagonals;

    AA_INLINE ImageWeights(const SmaaBlendArgs& a, int image) {
        const long size = a.stride;  // rows are read a few pixels past their end, and bits by words
        float* const rows = static_cast<float*>(a.scratch) + image * 8 * size;
        top = {rows, rows + size}, below = {rows + 2 * size, rows + 3 * size};
        left = {rows + 4 * size, rows + 5 * size};
        topDiagonals = reinterpret_cast<uint8_t*>(rows + 6 * size), belowDiagonals = topDiagonals + size;
    }
    AA_INLINE void nextRow() {
        const RowWeights spare = top;
        top = below, below = spare;
        uint8_t* const spareDiagonals = topDiagonals;
        topDiagonals = belowDiagonals, belowDiagonals = spareDiagonals;
    }
};

// ---- the blend

// Shares that N<R> pixels take of their neighbours across the stronger of their axes.
template <class R>
struct Shares {
    Mask<R> active, horizontal;
    R forward, backward;

    AA_INLINE void find(R right, R left, R bottom, R top) {
        using T = Elem<R>;
        active = right + left + bottom + top >= R(T(1e-5));
        // Symmetric corners weigh both axes alike; they count as vertical in every precision, as equal 8-bit weights
        // do.
        horizontal = max(right, left) > max(bottom, top) * R(T(1 + 1e-5));
        const R f = select(horizontal, right, bottom), b = select(horizontal, left, top);
        const R total = select(active, f + b, R(T(1)));
        forward = f * f / total, backward = b * b / total;
    }
    AA_INLINE R of(const float* p, long stride) const {
        const R own = load<R>(p);
        const R next = select(horizontal, load<R>(p + 1), load<R>(p + stride)),
                previous = select(horizontal, load<R>(p - 1), load<R>(p - stride));
        return select(active, own + forward * (next - own) + backward * (previous - own), own);
    }
};
// A row is blended in pieces, one channel after the other: all planes start at the same place in a memory page, so that
// ten of them side by side push each other out of the first-level cache.
inline constexpr int kPiece = 256;  // pixels
template <class R>
struct PieceShares {
    uint8_t any[kPiece / 8];  // of eight pixels
    Shares<R> shares[kPiece / N<R>];

    AA_INLINE void find(const SmaaBlendArgs& a, const SmaaImage& image, const ImageWeights& w, int x0, int y,
                        int groups) {
        const RowWeights& below = y + 1 == a.height ? w.top : w.below;  // the sampler clamps
        const uint8_t *tops = image.top.along + long(y) * image.top.stride, *belows = tops + image.top.stride,
                      *lefts = image.top.cross + long(y) * image.top.stride;
        for (int g = 0; g < groups; g++) {
            const int byte = (x0 >> 3) + g;
            any[g] = uint8_t(tops[byte] | belows[byte] | lefts[byte] | (lefts[byte + 1] & 1));
            if (!any[g]) continue;
            for (int i = 0; i < 8; i += N<R>) {
                const int x = x0 + 8 * g + i;
                shares[(8 * g + i) / N<R>].find(load<R>(w.left.opposite + x + 1), load<R>(w.left.own + x),
                                                load<R>(below.opposite + x), load<R>(w.top.own + x));
            }
        }
    }
    // N<R> pixels, the i-th and after, of which `p` is the first.
    AA_INLINE R of(int i, const float* p, long stride) const {
        return any[i >> 3] ? shares[i / N<R>].of(p, stride) : load<R>(p);
    }
};
// As a plane of float would hold it.
template <class R>
AA_INLINE R rounded(R x) {
    if constexpr (std::is_same_v<R, double>)
        return double(float(x));
    else
        return x;
}
template <int images, class R>
AA_INLINE void blendRow(const SmaaBlendArgs& a, int y, const ImageWeights (&weights)[kSmaaImages]) {
    for (int x0 = 0; x0 < a.width; x0 += kPiece) {
        const int left = a.width - x0, groups = (left < kPiece ? left + 7 : kPiece) / 8;
        const long o = long(y) * a.stride + x0;
        PieceShares<R> piece[images];
        for (int k = 0; k < images; k++) piece[k].find(a, a.image[k], weights[k], x0, y, groups);
        for (int c = 0; c < a.channels; c++) {
            const float* in[images];
            for (int k = 0; k < images; k++) in[k] = (c < 3 ? a.image[k].color.c[c] : a.motion[c - 3]) + o;
            float* const out = a.out[c] + o;
            for (int i = 0; i < 8 * groups; i += 16) {  // the next row's, into the second-level cache
                for (int k = 0; k < images; k++) __builtin_prefetch(in[k] + a.stride + i, 0, 2);
                __builtin_prefetch(out + a.stride + i, 1, 2);
            }
            for (int i = 0; i < 8 * groups; i += N<R>) {
                R result = piece[0].of(i, in[0] + i, a.stride);
                if constexpr (images == 2) {
                    result = rounded(result);
                    result = result + (piece[1].of(i, in[1] + i, a.stride) - result) * R(Elem<R>(0.5));
                }
                store(result, out + i);
            }
        }
    }
}
template <int images, class R>
AA_INLINE void blendRowsOf(const SmaaBlendArgs& a, int y0, int y1) {
    using T = Elem<R>;
    const Corners<T> corners(a.cornerRounding);
    ImageWeights weights[kSmaaImages] = {{a, 0}, {a, 1}};
    for (int k = 0; k < images; k++)
        topWeights<T>(a, a.image[k], corners, y0, true, weights[k].top, weights[k].topDiagonals);
    for (int y = y0; y < y1; y++) {
        for (int k = 0; k < images; k++) {
            ImageWeights& w = weights[k];
            if (y + 1 < a.height) topWeights<T>(a, a.image[k], corners, y + 1, y + 1 < y1, w.below, w.belowDiagonals);
            leftWeights<T>(a, a.image[k], corners, y, w.left, w.topDiagonals);
        }
        blendRow<images, R>(a, y, weights);
        for (int k = 0; k < images; k++) weights[k].nextRow();
    }
}
template <class R>
__attribute__((flatten)) void blendRows(const SmaaBlendArgs& a, int y0, int y1) {
    a.images == 2 ? blendRowsOf<2, R>(a, y0, y1) : blendRowsOf<1, R>(a, y0, y1);
}

template <class R>
void areaRows(const SmaaAreaArgs& a, int from, int to) {
    for (int k = from; k < to; k++) {
        SmaaAreaQuery& q = a.queries[k];
        const auto w = orthoArea<Elem<R>>(q.left, q.right, q.leftPx, q.rightPx, Elem<R>(q.offset));
        q.own = double(w.own);
        q.opposite = double(w.opposite);
    }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::SmaaBlendKernels, smaaBlendKernels) = {AA_ROWS(blendRows), AA_ROWS(areaRows)};
