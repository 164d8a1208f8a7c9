// Steps that the FXAA variants share (methods/02).
#pragma once
#include "kernels/sparse.h"
#include "methods/fxaa_kernels.h"

// Edge pixels are decided in double in every precision: three of the tests compare sums that are algebraically equal
// for many neighbourhoods (methods/02 s.2.1 step 2), and the specified tolerance of 1e-6 is far above double's rounding
// but not above float's.
namespace AA_ARCH {
using namespace aa;

struct Neighbourhood {
    double m, n, s, w, e, nw, ne, sw, se;
};
AA_INLINE Neighbourhood neighbourhood(const float* luma, long o, int stride) {
    const float* c = luma + o;
    return {c[0], c[-stride], c[stride], c[-1], c[1], c[-stride - 1], c[-stride + 1], c[stride - 1], c[stride + 1]};
}
// Second differences across rows against those across columns. Where their signs agree the two sums are equal.
AA_INLINE bool horizontal_edge(const Neighbourhood& l) {
    const double across_rows = abs(l.nw + l.sw - 2 * l.w) + 2 * abs(l.n + l.s - 2 * l.m) + abs(l.ne + l.se - 2 * l.e);
    const double across_columns =
        abs(l.nw + l.ne - 2 * l.n) + 2 * abs(l.w + l.e - 2 * l.m) + abs(l.sw + l.se - 2 * l.s);
    return across_rows >= across_columns * (1 - 1e-6);
}
AA_INLINE double range_of(const Neighbourhood& l) {
    return max(max(max(l.n, l.s), max(l.w, l.e)), l.m) - min(min(min(l.n, l.s), min(l.w, l.e)), l.m);
}
// How far the pixel stands out from the mean of its 3x3 neighbours, in units of the local range: 0..1.
AA_INLINE double sub_pixel_contrast(const Neighbourhood& l, double range) {
    const double mean = (2 * (l.n + l.s + l.w + l.e) + l.nw + l.ne + l.sw + l.se) * (1.0 / 12);
    return saturate(abs(mean - l.m) / range);
}
AA_INLINE double smooth(double t) { return t * t * (3 - 2 * t); }

// The line between a pixel and its neighbour on the side of the steeper gradient.
struct EdgeLine {
    const float* m;      // luma of the pixel
    long along, across;  // to the next pixel along the line (right or down), and over it
    int first, last;     // pixels along the line, relative to the pixel, that lie inside the image
    double middle;       // mean luma of the pair
    double gradient;     // |difference| of the pair
};
AA_INLINE EdgeLine edge_line(const FxaaArgs& a, int x, int y, bool horizontal, bool positiveSide,
                             const Neighbourhood& l) {
    EdgeLine line;
    line.m = a.luma + long(y) * a.stride + x;
    line.along = horizontal ? 1 : a.stride;
    line.across = (horizontal ? a.stride : 1) * (positiveSide ? 1 : -1);
    line.first = horizontal ? -x : -y;
    line.last = (horizontal ? a.width - x : a.height - y) - 1;
    const double side = double(line.m[line.across]);
    line.middle = (side + l.m) * 0.5;
    line.gradient = abs(side - l.m);
    return line;
}
// Bilinear luma on the line at a whole or half number of pixels from the start.
AA_INLINE double luma_on(const EdgeLine& line, int halfPx) {
    const int a = halfPx >> 1, b = (halfPx + 1) >> 1;
    const long i = (a < line.first ? line.first : a > line.last ? line.last : a) * line.along;
    const long j = (b < line.first ? line.first : b > line.last ? line.last : b) * line.along;
    return ((double(line.m[i]) + line.m[i + line.across]) + (double(line.m[j]) + line.m[j + line.across])) * 0.25;
}
struct LineEnds {
    int negativeHalfPx, positiveHalfPx;
    double negative, positive;  // luma minus the pair's mean where each search stopped
};
// Marches both ways until the luma leaves the pair's mean by a quarter of the gradient. The last distance is a jump
// whose end is never sampled.
AA_INLINE LineEnds find_ends(const FxaaArgs& a, const EdgeLine& line) {
    // Half a pixel short of a clean end the luma is off by exactly a quarter: that counts as the end.
    const double threshold = line.gradient * (0.25 * (1 - 1e-6));
    const int last = a.distanceHalfPx[a.steps - 1];
    LineEnds ends{last, last, 0, 0};
    int k = 0;
    for (; k < a.steps - 1; k++) {
        ends.negative = luma_on(line, -a.distanceHalfPx[k]) - line.middle;
        if (abs(ends.negative) >= threshold) {
            ends.negativeHalfPx = a.distanceHalfPx[k];
            break;
        }
    }
    for (k = 0; k < a.steps - 1; k++) {
        ends.positive = luma_on(line, a.distanceHalfPx[k]) - line.middle;
        if (abs(ends.positive) >= threshold) {
            ends.positiveHalfPx = a.distanceHalfPx[k];
            break;
        }
    }
    return ends;
}
// Shift that makes the pixel pair follow the line: nothing unless the nearer end bends toward this pixel.
AA_INLINE double edge_shift(const LineEnds& ends, bool pixelBelowMiddle) {
    const bool nearNegative = ends.negativeHalfPx < ends.positiveHalfPx;
    const bool bends = ((nearNegative ? ends.negative : ends.positive) < 0) != pixelBelowMiddle;
    const int nearest = nearNegative ? ends.negativeHalfPx : ends.positiveHalfPx;
    return bends ? 0.5 - double(nearest) / double(ends.negativeHalfPx + ends.positiveHalfPx) : 0.0;
}
AA_INLINE void write_shifted(const FxaaArgs& a, long o, long across, double shiftPx) {
    for (int c = 0; c < 3; c++) {
        const double own = a.in.c[c][o], side = a.in.c[c][o + across];
        a.out.c[c][o] = float(shiftPx > 0 ? own + (side - own) * shiftPx : own);
    }
}
AA_INLINE void write_debug(const FxaaArgs& a, long o, bool horizontal, const LineEnds& ends, double shiftPx) {
    if (!a.orientation) return;
    a.orientation[o] = horizontal ? 1 : 2;
    a.negativePx[o] = float(ends.negativeHalfPx) * 0.5f;
    a.positivePx[o] = float(ends.positiveHalfPx) * 0.5f;
    a.shiftPx[o] = float(shiftPx);
}

// Copies the row and lists its pixels whose local contrast reaches the threshold.
template <class R>
AA_INLINE int copy_and_mark(const FxaaArgs& a, int y, int x0, int x1, int* list) {
    int count = 0;
    const R thresholdMin(Elem<R>(a.edgeThresholdMin)), threshold(Elem<R>(a.edgeThreshold)), zero(Elem<R>(0));
    for (int x = x0; x < x1; x += N<R>) {
        const long o = long(y) * a.stride + x;
        for (int c = 0; c < 3; c++) store(load<R>(a.in.c[c] + o), a.out.c[c] + o);
        const R m = load<R>(a.luma + o), n = load<R>(a.luma + o - a.stride), s = load<R>(a.luma + o + a.stride),
                w = load<R>(a.luma + o - 1), e = load<R>(a.luma + o + 1);
        const R highest = max(max(max(n, s), max(w, e)), m), lowest = min(min(min(n, s), min(w, e)), m);
        const R range = highest - lowest;
        const auto edge = both(range >= max(thresholdMin, highest * threshold), range > zero);
        if (const unsigned bits = mask_bits<R>(edge)) count = append_marked(bits, x, a.width, list, count);
    }
    return count;
}
// Runs pixel(x, y) on every listed pixel of the rows, after their copy.
template <class R, class Pixel>
AA_INLINE void for_edge_pixels(const FxaaArgs& a, int y0, int y1, const Pixel& pixel) {
    int list[kSparseChunk + N<R>];
    for (int y = y0; y < y1; y++)
        for (int x0 = 0; x0 < a.width; x0 += kSparseChunk) {
            const int x1 = x0 + kSparseChunk < a.width ? x0 + kSparseChunk : a.width;
            const int count = copy_and_mark<R>(a, y, x0, x1, list);
            for (int i = 0; i < count; i++) pixel(list[i], y);
        }
}
}  // namespace AA_ARCH
