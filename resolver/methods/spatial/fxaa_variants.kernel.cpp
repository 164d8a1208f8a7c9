#include "methods/spatial/fxaa_common.kernel.h"

namespace AA_ARCH {

// ---- FXAA 1 [Lottes 2009]

// The line between a pixel and the neighbour across it, walked step by step.
struct SteppedLine {
    const float* m;      // luma of the pixel
    long along, across;  // to the next pixel along the line (right or down), and over it
    int first, last;     // pixels along the line, relative to the pixel, that lie inside the image
    double middle;       // mean luma of the pair
    double gradient;     // |difference| of the pair
};
AA_INLINE SteppedLine steppedLine(const FxaaArgs& a, int x, int y, bool horizontal, bool positiveSide) {
    SteppedLine line;
    line.m = a.luma + long(y) * a.lumaStride + x;
    line.along = horizontal ? 1 : a.lumaStride;
    line.across = (horizontal ? a.lumaStride : 1) * (positiveSide ? 1 : -1);
    line.first = horizontal ? -x : -y;
    line.last = (horizontal ? a.width - x : a.height - y) - 1;
    const double side = double(line.m[line.across]), own = double(line.m[0]);
    line.middle = (side + own) * 0.5;
    line.gradient = abs(side - own);
    return line;
}
// Mean luma of the pair over `length` pixels that start `from` pixels along the line.
AA_INLINE double meanLumaOn(const SteppedLine& line, int from, int length) {
    double sum = 0;
    for (int i = from; i < from + length; i++) {
        const long o = (i < line.first ? line.first : i > line.last ? line.last : i) * line.along;
        sum += double(line.m[o]) + line.m[o + line.across];
    }
    return sum / (2 * length);
}
AA_INLINE LineEnds findEndsAccelerated(const Fxaa1Args& a, const SteppedLine& line) {
    const double threshold = line.gradient * (0.25 * (1 - 1e-6));
    const int step = a.acceleration, beyondHalfPx = step + 1 + 2 * step * a.steps;
    LineEnds ends{beyondHalfPx, beyondHalfPx, false, false};  // an unfinished search ends one step past its last read
    const auto search = [&](bool positive, int& endHalfPx, bool& below) __attribute__((always_inline)) {
        for (int k = 0; k < a.steps; k++) {
            const double e = meanLumaOn(line, positive ? 1 + k * step : -(k + 1) * step, step) - line.middle;
            below = e < 0;
            if (abs(e) >= threshold) {
                endHalfPx = step + 1 + 2 * step * k;
                return;
            }
        }
    };
    search(false, ends.negativeHalfPx, ends.negativeBelow);
    search(true, ends.positiveHalfPx, ends.positiveBelow);
    return ends;
}
AA_INLINE double lowPass(const float* c, int stride, bool cross) {
    const double plus = double(c[0]) + c[-1] + c[1] + c[-stride] + c[stride];
    if (cross) return plus * (1.0 / 5);
    return (plus + c[-stride - 1] + c[-stride + 1] + c[stride - 1] + c[stride + 1]) * (1.0 / 9);
}
AA_INLINE void fxaa1Pixel(const Fxaa1Args& a, int x, int y) {
    const long o = long(y) * a.stride + x;
    const Neighbourhood l = neighbourhood(a.luma, long(y) * a.lumaStride + x, a.lumaStride);
    const double contrast = abs((l.n + l.s + l.w + l.e) * 0.25 - l.m) / rangeOf(l);
    const double blend = min(a.subpixCap, max(0.0, contrast - a.subpixTrim) / (1 - a.subpixTrim));
    const bool horizontal = horizontalEdge(l);
    const double negativeStep = abs((horizontal ? l.n : l.w) - l.m), positiveStep = abs((horizontal ? l.s : l.e) - l.m);
    const bool positiveSide = !(negativeStep >= positiveStep);
    const SteppedLine line = steppedLine(a, x, y, horizontal, positiveSide);
    const LineEnds ends = findEndsAccelerated(a, line);
    const double shiftPx = edgeShift(ends, l.m - line.middle < 0);
    const long across = (horizontal ? a.stride : 1) * (positiveSide ? 1 : -1);
    for (int c = 0; c < 3; c++) {
        const float* const p = a.in.c[c] + o;
        const double shifted = double(p[0]) + (double(p[across]) - p[0]) * shiftPx;
        a.out.c[c][o] = float(shifted + (lowPass(p, a.stride, a.crossLowPass) - shifted) * blend);
    }
    writeDebug(a, o, horizontal, ends, shiftPx);
}
template <class R>
__attribute__((flatten)) void fxaa1Rows(const Fxaa1Args& a, int y0, int y1) {
    forEdgePixels<R>(
        a, y0, y1, [&](int x, int y) __attribute__((always_inline)) { fxaa1Pixel(a, x, y); });
}

// ---- FXAA for compute shaders [Stanard n.d.]

AA_INLINE void fxaaCsPixel(const FxaaCsArgs& a, int x, int y, int i, const Classes& classes) {
    const double contrast = smooth(classes.contrast[i]);
    const double share = min(max(0.0, contrast * contrast * a.subpix * 2), 1.0);  // NaN: 0
    const int code = int(floor(254 * share)) & ~1;                                // 7 bits in the queue
    const double subShift = code * (0.5 / 254);
    const bool horizontal = classes.horizontal >> i & 1;
    const double negativeStep = classes.negativeStep[i], positiveStep = classes.positiveStep[i];
    const bool positiveSide = positiveStep >= negativeStep;
    const EdgeLine line = lineBeside(a, x, y, horizontal, positiveSide, positiveSide ? positiveStep : negativeStep);
    const LineEnds ends = findEnds(a, line);
    const double shiftPx = max(subShift, edgeShift(ends, double(*line.own) - line.middle < 0));
    const long o = long(y) * a.stride + x, across = horizontal ? a.stride : 1;
    writeShifted(a, o, positiveSide ? across : -across, shiftPx > 0.01 ? shiftPx : 0.0);
    writeDebug(a, o, horizontal, ends, shiftPx);
}
template <class R>
__attribute__((flatten)) void fxaaCsRows(const FxaaCsArgs& a, int y0, int y1) {
    forClassifiedPixels<R>(
        a, y0, y1, [&](int x, int y, int i, const Classes& classes) __attribute__((always_inline)) {
            fxaaCsPixel(a, x, y, i, classes);
        });
}

// ---- FXAA console [Lottes 2011]

AA_INLINE double bilinear(const float* plane, const FxaaArgs& a, double px, double py) {  // centres at whole numbers
    const double ax = floor(px), ay = floor(py), fx = px - ax, fy = py - ay;
    const float* const p = plane + long(ay) * a.stride + long(ax);
    const double top = p[0] + (double(p[1]) - p[0]) * fx;
    const double bottom = p[a.stride] + (double(p[a.stride + 1]) - p[a.stride]) * fx;
    return top + (bottom - top) * fy;
}
AA_INLINE double cornerLuma(const float* c, long across, long down) {
    return (double(c[0]) + c[across] + c[down] + c[across + down]) * 0.25;
}
AA_INLINE void consolePixel(const FxaaConsoleArgs& a, int x, int y) {
    const long o = long(y) * a.stride + x;
    const float* const l = a.luma + long(y) * a.lumaStride + x;
    // The bias keeps the direction of a saddle from vanishing.
    const double nw = cornerLuma(l, -1, -a.lumaStride), ne = cornerLuma(l, 1, -a.lumaStride) + 1.0 / 384,
                 sw = cornerLuma(l, -1, a.lumaStride), se = cornerLuma(l, 1, a.lumaStride), m = l[0];
    const double highest = max(max(nw, ne), max(sw, se)), lowest = min(min(nw, ne), min(sw, se));
    if (max(highest, m) - min(lowest, m) < max(double(a.edgeThresholdMin), highest * double(a.edgeThreshold))) return;
    double dx = (sw - ne) + (se - nw), dy = (sw - ne) - (se - nw);
    const double length = sqrt(dx * dx + dy * dy);
    if (!(length > 0)) return;
    dx /= length;
    dy /= length;
    const double smallest = min(abs(dx), abs(dy)) * a.sharpness;
    auto longer = [&](double d) __attribute__((always_inline)) {
        if (d == 0) return 0.0;
        return smallest > 0 ? clamp(d / smallest, -2.0, 2.0) : d > 0 ? 2.0 : -2.0;
    };
    const double nearX = dx * a.reachPx, nearY = dy * a.reachPx, farX = 2 * longer(dx), farY = 2 * longer(dy);
    double narrow[3], wide[3];
    for (int c = 0; c < 3; c++) {
        const float* const plane = a.in.c[c];
        narrow[c] = (bilinear(plane, a, x - nearX, y - nearY) + bilinear(plane, a, x + nearX, y + nearY)) * 0.5;
        const double outer = bilinear(plane, a, x - farX, y - farY) + bilinear(plane, a, x + farX, y + farY);
        wide[c] = narrow[c] * 0.5 + outer * 0.25;
    }
    const double wideLuma = 0.299 * wide[0] + 0.587 * wide[1] + 0.114 * wide[2];
    const bool useWide = !(wideLuma < lowest || wideLuma > highest);
    for (int c = 0; c < 3; c++) a.out.c[c][o] = float(useWide ? wide[c] : narrow[c]);
    if (!a.shiftPx) return;
    a.negativePx[o] = float(dx);
    a.positivePx[o] = float(dy);
    a.shiftPx[o] = useWide ? 1.0f : 0.0f;
}
// Copies the rows; the corner test reads the luma of all eight neighbours, so their range decides who is listed.
template <class R>
__attribute__((flatten)) void consoleRows(const FxaaConsoleArgs& a, int y0, int y1) {
    const R thresholdMin(Elem<R>(a.edgeThresholdMin) - Elem<R>(1.0 / 192));  // the bias widens the range by 1/384
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            for (int c = 0; c < 3; c++) store(load<R>(a.in.c[c] + o), a.out.c[c] + o);
            const float* const l = a.luma + long(y) * a.lumaStride + x;
            R highest = load<R>(l), lowest = highest;
            for (int j = -1; j <= 1; j++)
                for (int i = -1; i <= 1; i++) {
                    const R v = load<R>(l + long(j) * a.lumaStride + i);
                    highest = max(highest, v);
                    lowest = min(lowest, v);
                }
            const unsigned bits = maskBits<R>(highest - lowest >= thresholdMin);
            if (!bits) continue;
            int list[N<R> + 1];
            const int count = appendMarked(bits, x, a.width, list, 0);
            for (int i = 0; i < count; i++) consolePixel(a, list[i], y);
        }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::FxaaVariantKernels, fxaaVariantKernels) = {AA_ROWS(fxaa1Rows), AA_ROWS(fxaaCsRows),
                                                               AA_ROWS(consoleRows)};
