// Steps that the FXAA variants share.
#pragma once
#include "kernels/sparse.h"
#include "methods/spatial/fxaa.h"

// Edge pixels are decided in double in every precision: three of the tests compare sums that are algebraically equal
// for many neighbourhoods (decisions 37), and the tolerance of 1e-6 is far above double's rounding but not above
// float's.
namespace AA_ARCH {
using namespace aa;

#ifdef __AVX512DQ__
inline constexpr int kWide = 8;
#elif defined(__AVX2__)
inline constexpr int kWide = 4;
#else
inline constexpr int kWide = 2;
#endif
using Wide = Lanes<double, kWide>;  // one register of doubles
AA_INLINE Wide loadWide(const float* p) {
#ifdef __AVX512DQ__
    return Wide((Wide::V)_mm512_maskz_cvtps_pd(0xff, _mm256_loadu_ps(p)));  // GCC 12 converts in four steps by itself
#endif
    typedef float Floats __attribute__((vector_size(kWide * 4)));
    Floats f;
    __builtin_memcpy(&f, p, sizeof f);
    return __builtin_convertvector(f, Wide::V);
}

struct Neighbourhood {
    double m, n, s, w, e, nw, ne, sw, se;
};
AA_INLINE Neighbourhood neighbourhood(const float* luma, long o, int stride) {
    const float* c = luma + o;
    return {c[0], c[-stride], c[stride], c[-1], c[1], c[-stride - 1], c[-stride + 1], c[stride - 1], c[stride + 1]};
}
// Second differences across rows against those across columns. Where their signs agree the two sums are equal.
template <class R>
AA_INLINE Mask<R> runsHorizontally(R m, R n, R s, R w, R e, R nw, R ne, R sw, R se) {
    const R two(Elem<R>(2));
    const R acrossRows = abs(nw + sw - two * w) + two * abs(n + s - two * m) + abs(ne + se - two * e);
    const R acrossColumns = abs(nw + ne - two * n) + two * abs(w + e - two * m) + abs(sw + se - two * s);
    return acrossRows >= acrossColumns * R(Elem<R>(1 - 1e-6));
}
AA_INLINE bool horizontalEdge(const Neighbourhood& l) {
    return runsHorizontally(l.m, l.n, l.s, l.w, l.e, l.nw, l.ne, l.sw, l.se);
}
AA_INLINE double rangeOf(const Neighbourhood& l) {
    return max(max(max(l.n, l.s), max(l.w, l.e)), l.m) - min(min(min(l.n, l.s), min(l.w, l.e)), l.m);
}
template <class R>
AA_INLINE R smooth(R t) {
    return t * t * (R(Elem<R>(3)) - R(Elem<R>(2)) * t);
}

// What the 3x3 neighbours say about a pixel of a row: the edge's orientation, the luma differences to either side of
// it, and how far the pixel stands out of the mean of its neighbours in units of the local range (0..1).
inline constexpr int kChunk = 64;  // pixels that are classified before any is filtered
struct Classes {
    uint64_t horizontal;
    alignas(64) double negativeStep[kChunk], positiveStep[kChunk], contrast[kChunk];
};
// Eight pixels from l on, into the classes from `at` on.
AA_INLINE void classify(const float* l, long s, Classes& to, int at) {
    for (int i = 0; i < 8; i += kWide) {
        const float* const p = l + i;
        const Wide m = loadWide(p), n = loadWide(p - s), so = loadWide(p + s), w = loadWide(p - 1), e = loadWide(p + 1),
                   nw = loadWide(p - s - 1), ne = loadWide(p - s + 1), sw = loadWide(p + s - 1),
                   se = loadWide(p + s + 1);
        const auto horizontal = runsHorizontally(m, n, so, w, e, nw, ne, sw, se);
        to.horizontal |= uint64_t(maskBits<Wide>(horizontal)) << (at + i);
        store(abs(select(horizontal, n, w) - m), to.negativeStep + at + i);
        store(abs(select(horizontal, so, e) - m), to.positiveStep + at + i);
        const Wide range = max(max(max(n, so), max(w, e)), m) - min(min(min(n, so), min(w, e)), m);
        const Wide mean = (Wide(2.0) * (n + so + w + e) + nw + ne + sw + se) * Wide(1.0 / 12);
        store(saturate(abs(mean - m) / range), to.contrast + at + i);
    }
}

struct LineEnds {
    int negativeHalfPx, positiveHalfPx;
    bool negativeBelow, positiveBelow;  // is the luma below the pair's mean where each search stopped?
};
// The line between a pixel and its neighbour on the side of the steeper gradient, as two rows of lumas.
struct EdgeLine {
    const float *own, *side;  // the pixel and its neighbour; the next ones along the line lie beside them in memory
    double middle;            // mean luma of the pair
    double threshold;         // difference from it that ends the line
};
// Bit i set where the luma at the window's i-th address has left the pair's mean; `below` where it is below it.
// `further` is the step in memory away from the pixel. All sums are kept fourfold: a scaling by 4 rounds nothing.
AA_INLINE unsigned ended(const EdgeLine& line, const float* own, const float* side, int further, unsigned half,
                         unsigned& below) {
    const Wide middle(4 * line.middle), threshold(4 * line.threshold);
    unsigned bits = 0;
    below = 0;
    for (int i = 0; i < 8; i += kWide) {
        const Wide near = loadWide(own + i) + loadWide(side + i);
        const Wide far = loadWide(own + i + further) + loadWide(side + i + further);
#ifdef __AVX512DQ__
        const Wide e =
            Wide((Wide::V)_mm512_mask_blend_pd(__mmask8(half), (__m512d)near.v, (__m512d)far.v)) + near - middle;
        bits = _mm512_cmp_pd_mask((__m512d)abs(e).v, (__m512d)threshold.v, _CMP_GE_OQ);
        below = _mm512_movepi64_mask((__m512i)e.v);  // the sign; e is never -0, being a difference
#else
        Mask<Wide> lane;
        for (int k = 0; k < kWide; k++) lane[k] = 1ll << (i + k);
        const Wide e = select((lane & (long long)half) != 0, far, near) + near - middle;
        bits |= maskBits<Wide>(abs(e) >= threshold) << i;
        below |= maskBits<Wide>(e < Wide(0.0)) << i;
#endif
    }
    return bits;
}
// Marches both ways until the luma leaves the pair's mean by a quarter of the gradient. The last distance is a jump
// whose end is never sampled.
AA_INLINE LineEnds findEnds(const FxaaArgs& a, const EdgeLine& line) {
    const int last = a.distanceHalfPx[a.steps - 1];
    LineEnds ends{last, last, false, false};
    for (int w = 0; w < a.windows; w++) {
        unsigned below;
        const unsigned bits =
            ended(line, line.own + 8 * w + 1, line.side + 8 * w + 1, 1, a.half[w], below) & a.sampled[w];
        const int at = bits ? __builtin_ctz(bits) : 31 - __builtin_clz(a.sampled[w]);
        ends.positiveBelow = below >> at & 1;
        if (bits) {
            ends.positiveHalfPx = 2 * (8 * w + 1 + at) + int(a.half[w] >> at & 1);
            break;
        }
    }
    for (int w = 0; w < a.windows; w++) {
        unsigned below;  // addresses ascend toward the pixel: the highest bit is nearest
        const unsigned bits = ended(line, line.own - 8 * w - 8, line.side - 8 * w - 8, -1, a.halfMirrored[w], below) &
                              a.sampledMirrored[w];
        const int at = bits ? 31 - __builtin_clz(bits) : __builtin_ctz(a.sampledMirrored[w]);
        ends.negativeBelow = below >> at & 1;
        if (bits) {
            ends.negativeHalfPx = 2 * (8 * w + 8 - at) + int(a.halfMirrored[w] >> at & 1);
            break;
        }
    }
    return ends;
}
// Shift that makes the pixel pair follow the line: nothing unless the nearer end bends toward this pixel.
AA_INLINE double edgeShift(const LineEnds& ends, bool pixelBelowMiddle) {
    const bool nearNegative = ends.negativeHalfPx < ends.positiveHalfPx;
    const bool bends = ((int(nearNegative) & int(ends.negativeBelow)) |
                        (int(!nearNegative) & int(ends.positiveBelow))) != int(pixelBelowMiddle);
    const int nearest = ends.negativeHalfPx < ends.positiveHalfPx ? ends.negativeHalfPx : ends.positiveHalfPx;
    return double(bends) * (0.5 - double(nearest) / double(ends.negativeHalfPx + ends.positiveHalfPx));
}
AA_INLINE void writeShifted(const FxaaArgs& a, long o, long across, double shiftPx) {
    using Channels = Lanes<double, 4>;  // without branches: nobody can foretell whether a pixel shifts
    const auto channels = [&](long at) __attribute__((always_inline)) {
        return Channels(Channels::V{a.in.c[0][at], a.in.c[1][at], a.in.c[2][at], 0});
    };
    const Channels own = channels(o), shift(shiftPx), zero(0.0);
    const Channels shifted = own + select(shift > zero, (channels(o + across) - own) * shift, zero);
    for (int c = 0; c < 3; c++) a.out.c[c][o] = float(shifted.v[c]);
}
AA_INLINE void writeDebug(const FxaaArgs& a, long o, bool horizontal, const LineEnds& ends, double shiftPx) {
    if (!a.orientation) return;
    a.orientation[o] = horizontal ? 1 : 2;
    a.negativePx[o] = float(ends.negativeHalfPx) * 0.5f;
    a.positivePx[o] = float(ends.positiveHalfPx) * 0.5f;
    a.shiftPx[o] = float(shiftPx);
}

// Copies 8 pixels and marks those whose local contrast reaches the threshold.
template <class R>
AA_INLINE unsigned copyAndMark(const FxaaArgs& a, int x, int y) {
    const R thresholdMin(Elem<R>(a.edgeThresholdMin)), threshold(Elem<R>(a.edgeThreshold)), zero(Elem<R>(0));
    unsigned bits = 0;
    for (int i = 0; i < 8; i += N<R>) {
        const long o = long(y) * a.stride + x + i;
        const float* const l = a.luma + long(y) * a.lumaStride + x + i;
        for (int c = 0; c < 3; c++) store(load<R>(a.in.c[c] + o), a.out.c[c] + o);
        const R m = load<R>(l), n = load<R>(l - a.lumaStride), s = load<R>(l + a.lumaStride), w = load<R>(l - 1),
                e = load<R>(l + 1);
        const R highest = max(max(max(n, s), max(w, e)), m), lowest = min(min(min(n, s), min(w, e)), m);
        const R range = highest - lowest;
        bits |= maskBits<R>(both(range >= max(thresholdMin, highest * threshold), range > zero)) << i;
    }
    return a.width - x < 8 ? bits & ((1u << (a.width - x)) - 1u) : bits;
}
// Runs pixel(x, y) on every edge pixel of the rows, after the copy of its group.
template <class R, class Pixel>
AA_INLINE void forEdgePixels(const FxaaArgs& a, int y0, int y1, const Pixel& pixel) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += 8)
            for (unsigned bits = copyAndMark<R>(a, x, y); bits; bits &= bits - 1) pixel(x + __builtin_ctz(bits), y);
}
// The form for searches by windows: pixel(x, y, i, classes) gets the classes of its chunk, of which it is the i-th.
template <class R, class Pixel>
AA_INLINE void forClassifiedPixels(const FxaaArgs& a, int y0, int y1, const Pixel& pixel) {
    Classes classes;
    for (int y = y0; y < y1; y++)
        for (int x0 = 0; x0 < a.width; x0 += kChunk) {
            const int end = a.width - x0 < kChunk ? a.width - x0 : kChunk;
            uint64_t marked = 0;
            classes.horizontal = 0;
            for (int i = 0; i < end; i += 8) {
                const unsigned bits = copyAndMark<R>(a, x0 + i, y);
                if (!bits) continue;
                marked |= uint64_t(bits) << i;
                classify(a.luma + long(y) * a.lumaStride + x0 + i, a.lumaStride, classes, i);
            }
            for (; marked; marked &= marked - 1) {
                const int i = __builtin_ctzll(marked);
                pixel(x0 + i, y, i, classes);
            }
        }
}
AA_INLINE EdgeLine lineBeside(const FxaaArgs& a, int x, int y, bool horizontal, bool positiveSide, double gradient) {
    const float* const own =
        horizontal ? a.luma + long(y) * a.lumaStride + x : a.transposedLuma + long(x) * a.transposedStride + y;
    const long across = horizontal ? a.lumaStride : a.transposedStride;
    const float* const side = own + (positiveSide ? across : -across);
    // Half a pixel short of a clean end the luma is off by exactly a quarter: that counts as the end.
    return {own, side, (double(*side) + double(*own)) * 0.5, gradient * (0.25 * (1 - 1e-6))};
}
}  // namespace AA_ARCH
