#include "methods/temporal/master.h"

#include "kernels/ring.h"
#include "methods/temporal/master_terms.kernel.h"
#include "methods/temporal/temporal_sharpen.kernel.h"

// All steps row by row, each as far ahead of the next one as that one's window reaches; what lies between them is a few
// rows long and stays in the second-level cache. What limits it is the number of instructions, a thousand for eight
// pixels: neither memory nor, since a row's steps are loops of their own, waiting for what the step before computes.
namespace AA_ARCH {

template <class T>
struct MasterRings {
    Ring<T, 4> luminanceAlbedo, luminanceLit, sobel, filtered;
    Ring<T, 8> depth;                // in its unit, at the texels of the jittered frame
    Ring<T, 4> current[3], sobelAt;  // read at p - jitter; of a picture that has a row and a column more on each side
    Ring<T, 2> past[3], pastDepth;   // colour, and depth: NaN where history is outside
};

template <class R>
AA_INLINE R inDepthUnit(const MasterArgs& a, R depthView) {
    using T = Elem<R>;
    const R far(T(a.farDepth)), z = min(far, depthView);
    if (a.depthUnit == DepthUnit::world) return z;
    return a.depthUnit == DepthUnit::zfar ? z * R(T(1) / T(a.farDepth)) : (z + z) / (z + far);
}
template <class R>
AA_INLINE void depthRow(const MasterArgs& a, const MasterRings<Elem<R>>& rings, int y) {
    Elem<R>* const row = rings.depth(y);
    for (int x = 0; x < a.in.width; x += N<R>)
        store(inDepthUnit(a, load<R>(a.depthOfTexel + long(y) * a.in.stride + x)), row + x);
    rings.depth.continueBeyond(y);
}
// Calls one(x) for one value at x = -1 and x = width, and lanes(x) for all between.
template <class R, class Lanes, class One>
AA_INLINE void withBothEnds(int width, const Lanes& lanes, const One& one) {
    for (int x = 0; x < width; x += N<R>) lanes(x);
    one(-1), one(width);
}
// The un-jittered colours (conventions 7.0), row y of -1 .. height.
template <class R>
AA_INLINE void currentRow(const MasterArgs& a, const MasterRings<Elem<R>>& rings, int y) {
    using T = Elem<R>;
    const UniformFetch<R> fetch(a.in.readXPx, a.in.readYPx);
    const UniformFetch<T> fetchOne(a.in.readXPx, a.in.readYPx);
    for (int c = 0; c < 3; c++) {
        T* const row = rings.current[c](y + 1);
        const float* const from = a.in.color.c[c] + long(y) * a.in.stride;
        withBothEnds<R>(
            a.in.width, [&](int x) __attribute__((always_inline)) { store(fetch(from + x, a.in.stride), row + x); },
            [&](int x) __attribute__((always_inline)) { row[x] = fetchOne(from + x, a.in.stride); });
    }
}
// And of the Sobel values.
template <class R>
AA_INLINE void sobelAtRow(const MasterArgs& a, const MasterRings<Elem<R>>& rings, int y) {
    using T = Elem<R>;
    const UniformFetch<R> fetch(a.in.readXPx, a.in.readYPx);
    const UniformFetch<T> fetchOne(a.in.readXPx, a.in.readYPx);
    T* const row = rings.sobelAt(y + 1);
    const T *const upper = rings.sobel(y + fetch.dy), *const lower = rings.sobel(y + fetch.dy + 1);
    withBothEnds<R>(
        a.in.width, [&](int x) __attribute__((always_inline)) { store(fetch(upper + x, lower + x), row + x); },
        [&](int x) __attribute__((always_inline)) { row[x] = fetchOne(upper + x, lower + x); });
}

template <class R>
AA_INLINE void luminanceRow(const MasterArgs& a, const MasterRings<Elem<R>>& rings, int y) {
    Elem<R>*const albedo = rings.luminanceAlbedo(y), *const lit = rings.luminanceLit(y);
    for (int x = 0; x < a.in.width; x += N<R>) {
        const long o = long(y) * a.in.stride + x;
        store(luminance(load3<R>(a.albedoEncoded.c, o), a.luminance), albedo + x);
        store(luminance(load3<R>(a.in.color.c, o), a.luminance), lit + x);
    }
    rings.luminanceAlbedo.continueBeyond(y);
    rings.luminanceLit.continueBeyond(y);
}
// A line of the cache is fetched once.
template <class R>
AA_INLINE bool beginsLine(int x) {
    return N<R> >= 16 || (N<R> > 1 && x % 16 == 0);
}
AA_INLINE long prefetched(const MasterArgs& a, int x, int row) {
    return long(row < a.in.height ? row : a.in.height - 1) * a.in.stride + x;
}
// S: one Sobel value per pixel. No part of masterRows(), nor is sharpening: in one function with all steps GCC keeps
// more at hand than there are registers.
template <class R>
__attribute__((noinline)) void sobelRow(const MasterArgs& a, const MasterRings<Elem<R>>& rings, int y) {
    using T = Elem<R>;
    T* const sobel = rings.sobel(y);
    const T *const albedo[3] = {rings.luminanceAlbedo(y - 1), rings.luminanceAlbedo(y), rings.luminanceAlbedo(y + 1)},
                   *const lit[3] = {rings.luminanceLit(y - 1), rings.luminanceLit(y), rings.luminanceLit(y + 1)},
                   *const depth[3] = {rings.depth(y - 1), rings.depth(y), rings.depth(y + 1)};
    for (int x = 0; x < a.in.width; x += N<R>) {
        // What luminanceRow() and depthRow() read next: memory has little to do while roots are drawn.
        if (beginsLine<R>(x)) {
            const long next = prefetched(a, x, y + 2);
            for (int c = 0; c < 3; c++) {
                __builtin_prefetch(a.albedoEncoded.c[c] + next, 0, 2);
                __builtin_prefetch(a.in.color.c[c] + next, 0, 2);
            }
            __builtin_prefetch(a.depthOfTexel + next, 0, 2);
        }
        if (!a.useSobel) {
            store(R(T(0)), sobel + x);
            continue;
        }
        const auto magnitude = [&](const T* const(&rows)[3]) __attribute__((always_inline)) {
            return sobelMagnitude<R>([&](int i, int j)
                                         __attribute__((always_inline)) { return loadOwn<R>(rows[j + 1] + x + i); });
        };
        const R sum = magnitude(albedo) * R(T(a.weightAlbedo)) + magnitude(lit) * R(T(a.weightLit)) + magnitude(depth);
        store(sobelCurve(sum), sobel + x);
    }
    rings.sobel.continueBeyond(y);
}

// T: the Sobel value over time, and the past of colour and depth.
template <class R>
AA_INLINE void pastRow(const MasterArgs& a, const MasterRings<Elem<R>>& rings, int y) {
    using T = Elem<R>;
    const TemporalIn& in = a.in;
    T* const filteredRow = rings.filtered(y);
    const T* const sobel[3] = {rings.sobelAt(y), rings.sobelAt(y + 1), rings.sobelAt(y + 2)};
    T *const pastX = rings.past[0](y), *const pastY = rings.past[1](y), *const pastZ = rings.past[2](y),
             *const pastDepth = rings.pastDepth(y);
    Reprojection<R> from[kStepGroups];
    Texel<R> pasts[kStepGroups];
    const auto reprojected = [&](int i, int x) __attribute__((always_inline)) {
        from[i] = reproject(in, dilatedMotion<R>(in, long(y) * in.stride + x), x, y);
    };
    const auto fetched = [&](int i, int x) __attribute__((always_inline)) {
        const long o = long(y) * in.stride + x;
        const Reprojection<R> q = from[i];
        const Texel<R> past = fetchBilinear<R>(in.history + 4 * o, in.stride, q);
        const Offsets<R> k = nearestOffsets(q, in.stride);
        const R depth = a.samePixelDepth ? load<R>(a.previousDepth + o) : gather<R>(a.previousDepth + o, k);
        store(select(q.inside, depth, R(T(__builtin_nanf("")))), pastDepth + x);
        const vec3<R> color = in.filter == HistoryFilter::bilinear ? past.rgb : fetchHistory(in, x, y, q);
        store(color.x, pastX + x), store(color.y, pastY + x), store(color.z, pastZ + x);
        pasts[i] = past;
    };
    const auto filter = [&](int i, int x) __attribute__((always_inline)) {
        const auto at = [&](int di, int dj) __attribute__((always_inline)) {
            return loadOwn<R>(sobel[dj + 1] + x + di);
        };
        const R now = at(0, 0);
        R filtered = now;
        if (a.temporalSobel) {
            const R plusLow = min(min(min(now, at(-1, 0)), min(at(1, 0), at(0, -1))), at(0, 1));
            const R plusHigh = max(max(max(now, at(-1, 0)), max(at(1, 0), at(0, -1))), at(0, 1));
            const R low = min(plusLow, min(min(at(-1, -1), at(1, -1)), min(at(-1, 1), at(1, 1))));
            const R high = max(plusHigh, max(max(at(-1, -1), at(1, -1)), max(at(-1, 1), at(1, 1))));
            const R half(T(0.5)), held = clamp(pasts[i].a, (low + plusLow) * half, (high + plusHigh) * half);
            const R k = min(luminanceFeedback(now, held, a.kMin, a.kMax), R(T(in.feedbackCeiling)));
            filtered = select(from[i].inside, held + (now - held) * (R(T(1)) - k), now);
        }
        store(filtered, filteredRow + x);
    };
    inSteps<R>(in.width, reprojected, fetched, filter);
    rings.filtered.continueBeyond(y);
}

// Rows y - 1, y, y + 1 of the current colours, of the depth nearest to them and of the filtered Sobel value, row y of
// the past.
template <class T>
struct MasterWindow {
    const T *current[3][3], *depth[3], *filtered[3], *past[3], *pastDepth;
    AA_INLINE MasterWindow(const MasterArgs& a, const MasterRings<T>& rings, int y)
        : filtered{rings.filtered(y - 1), rings.filtered(y), rings.filtered(y + 1)},
          past{rings.past[0](y), rings.past[1](y), rings.past[2](y)},
          pastDepth(rings.pastDepth(y)) {
        for (int j = 0; j < 3; j++) {
            for (int c = 0; c < 3; c++) current[j][c] = rings.current[c](y + j);
            depth[j] = rings.depth(y + a.texelY + j - 1) + a.texelX;
        }
    }
};
// What one step hands to the next, for N pixels.
template <class R>
struct MasterPixels {
    R aliased, model, sobel;
    PseudoVariances<R> variance;
    Box<R> box;
    vec3<R> clipped;
};
// How aliased is a pixel?
template <class R>
AA_INLINE void findAliased(const MasterArgs& a, const MasterWindow<Elem<R>>& rows, MasterPixels<R>& p, int x, int y) {
    using T = Elem<R>;
    const R zero(T(0)), one(T(1));
    const long o = long(y) * a.in.stride + x;
    R model(zero), sobel(zero);
    PseudoVariances<R> variance{zero, zero};
    if (a.useModel)
        model = modelAverage<R>([&](int i, int j) __attribute__((always_inline)) {
            return idsDiffer<R>(a.objectId + o + long(j) * a.in.stride + i, a.objectId + o);
        });
    if (a.useDepth || a.useDepthTemporal) {
        const R depth = loadOwn<R>(rows.depth[1] + x), pastDepth = loadOwn<R>(rows.pastDepth + x);
        const DepthWindow<R> window = depthWindow<R>([&](int i, int j) __attribute__((always_inline)) {
            return loadOwn<R>(rows.depth[j + 1] + x + i);
        });
        R past = pastDepth - depth;
        if (a.compensate)
            past = pastDepth - inDepthUnit(a, expectedPreviousDepth(a.expected, load<R>(a.in.depthView + o), x, y));
        R threshold(T(a.depthThreshold));
        if (a.relativeThreshold) threshold = threshold * max(depth + window.mean, one);
        variance = pseudoVariances(window, past, threshold);
        if (!a.useDepth) variance.depth = zero;
        variance.depthTemporal =
            a.useDepthTemporal ? select(pastDepth == pastDepth, variance.depthTemporal, one) : zero;
    }
    if (a.useSobel) {
        const auto s = [&](int i, int j) __attribute__((always_inline)) {
            return loadOwn<R>(rows.filtered[j + 1] + x + i);
        };
        const R plus = s(0, 0) + ((s(-1, 0) + s(1, 0)) + (s(0, -1) + s(0, 1)));
        const R square = plus + ((s(-1, -1) + s(1, -1)) + (s(-1, 1) + s(1, 1)));
        sobel = mix(plus * R(T(1) / T(5)), square * R(T(1) / T(9)), saturate(model + s(0, 0)));  // eqs 4.12, 4.13
    }
    p.aliased = max(saturate(sobel + variance.depth + variance.depthTemporal + model), R(T(a.minAlias)));
    p.model = model, p.sobel = sobel, p.variance = variance;
}
// Holds the past to the box: loose where aliased, the current colour alone where not (eqs 4.15, 4.16).
template <class R>
AA_INLINE void findBox(const MasterWindow<Elem<R>>& rows, MasterPixels<R>& p, int x) {
    const R aliased = p.aliased;
    p.box = windowBox<R>(
        [&](int i, int j) __attribute__((always_inline)) { return loadOwn<R>(rows.current[j + 1], x + i); },
        [&](auto channel, Range<R> plus, Range<R> square) __attribute__((always_inline)) {
            const R low = mix(plus.lo, square.lo, aliased), high = mix(plus.hi, square.hi, aliased);
            const R own = loadOwn<R>(rows.current[1][channel] + x);
            return Range<R>{mix(own, low, aliased), mix(own, high, aliased)};
        });
}
template <class R>
AA_INLINE void clipPast(const MasterArgs& a, const MasterWindow<Elem<R>>& rows, MasterPixels<R>& p, int x) {
    const auto mean = [&]() __attribute__((always_inline)) {
        const NeighbourMeans<R> m = neighbourMeans<R>([&](int i, int j) __attribute__((always_inline)) {
            return loadOwn<R>(rows.current[j + 1], x + i);
        });
        return mix(m.plus, m.square, p.aliased);
    };
    p.clipped = constrain(p.box, a.clipTarget, mean, loadOwn<R>(rows.current[1], x), loadOwn<R>(rows.past, x));
}
template <class R>
AA_INLINE void blendAndStore(const MasterArgs& a, const MasterWindow<Elem<R>>& rows, const MasterPixels<R>& p, int x,
                             int y) {
    using T = Elem<R>;
    const TemporalIn& in = a.in;
    const long o = long(y) * in.stride + x;
    const vec3<R> current = loadOwn<R>(rows.current[1], x), history = loadOwn<R>(rows.past, x), clipped = p.clipped;
    const R pastDepth = loadOwn<R>(rows.pastDepth + x);
    const auto inside = pastDepth == pastDepth;
    const R k = min(luminanceFeedback(luminance(current, a.luminance), luminance(clipped, a.luminance), a.kMin, a.kMax),
                    R(T(in.feedbackCeiling)));
    const vec3<R> mixed = select(inside, blend(current, clipped, k), current);

    storeBlend(in, x, y, sanitised(mixed, current, history), loadOwn<R>(rows.filtered[1] + x));
    if (!in.debug.feedback) {
        storeDebug(in.debug, o, Motion<R>{k, k}, inside, p.box, history, k);
    } else {
        storeDebug(in.debug, o, dilatedMotion<R>(in, o), inside, p.box, clipped - history, k);
        store(p.aliased, a.debugAliased + o), store(p.sobel, a.debugSobel + o), store(p.model, a.debugModel + o);
        store(p.variance.depth, a.debugDepth + o), store(p.variance.depthTemporal, a.debugDepthTemporal + o);
    }
}
// Brings in what the next row of each step will be the first to read or write, while this one computes; not what
// luminances and Sobel read, for which the cache's way to memory is used earlier.
template <class R>
AA_INLINE void prefetchNextRows(const MasterArgs& a, int x, int y) {
    if (!beginsLine<R>(x)) return;
    const TemporalIn& in = a.in;
    const auto at = [&](int row) __attribute__((always_inline)) { return prefetched(a, x, row); };
    const long sobel = at(y + 3), past = at(y + 2), own = at(y + 1);
    for (float* const plane : a.sharpened.c)
        if (plane) __builtin_prefetch(plane + own, 0, 2);
    __builtin_prefetch(in.depthView + sobel, 0, 2);
    __builtin_prefetch(in.motionXPx + past + in.stride, 0, 2);
    __builtin_prefetch(in.motionYPx + past + in.stride, 0, 2);
    __builtin_prefetch(a.previousDepth + past + in.stride, 0, 2);
    __builtin_prefetch(a.objectId + past, 0, 2);
    for (int i = 0; i < 4; i++) {
        __builtin_prefetch(in.history + 4 * (past + in.stride) + i * 16, 0, 2);
        __builtin_prefetch(in.next + 4 * own + i * 16, 0, 2);
    }
    __builtin_prefetch(a.keptDepth + own, 0, 2);
}
template <class R>
AA_INLINE void resolveRow(const MasterArgs& a, const MasterRings<Elem<R>>& rings, int y) {
    const TemporalIn& in = a.in;
    const long o = long(y) * in.stride;
    const MasterWindow<Elem<R>> rows(a, rings, y);
    const Elem<R>* const sobel = rings.sobelAt(y + 1);
    MasterPixels<R> pixels[kStepGroups];
    if (in.history)
        inSteps<R>(
            in.width,
            [&](int i, int x) __attribute__((always_inline)) {
                prefetchNextRows<R>(a, x, y);
                findAliased(a, rows, pixels[i], x, y);
            },
            [&](int i, int x) __attribute__((always_inline)) { findBox(rows, pixels[i], x); },
            [&](int i, int x) __attribute__((always_inline)) { clipPast(a, rows, pixels[i], x); },
            [&](int i, int x) __attribute__((always_inline)) { blendAndStore(a, rows, pixels[i], x, y); });
    else
        for (int x = 0; x < in.width; x += N<R>)
            storeFirst<R>(in, x, y, loadOwn<R>(rows.current[1], x), loadOwn<R>(sobel + x));
    for (int x = 0; x < in.width; x += N<R>) store(loadOwn<R>(rows.depth[1] + x), a.keptDepth + o + x);
    float* const row = in.next + 4 * o;
    for (int c = 0; c < 4; c++) row[c - 4] = row[c], row[4 * in.width + c] = row[4 * in.width - 4 + c];
}
template <class R>
__attribute__((noinline)) void sharpenResolvedRow(const MasterArgs& a, int y) {
    const TemporalIn& in = a.in;
    const auto row = [&](int r) __attribute__((always_inline)) {
        return in.next + 4l * in.stride * (r < 0 ? 0 : r >= in.height ? in.height - 1 : r);
    };
    sharpenRow<R>(row(y - 1), row(y), row(y + 1), a.sharpenGain, a.sharpened, long(y) * in.stride, in.width);
}
template <class R>
__attribute__((flatten)) void masterRows(const MasterArgs& a, int y0, int y1) {
    using T = Elem<R>;
    const TemporalIn& in = a.in;
    const int width = in.width, height = in.height;
    MasterRings<T> rings;
    RingMaker<T> maker(a.scratch, in.stride, width, height);
    maker.make(rings.luminanceAlbedo), maker.make(rings.luminanceLit);
    maker.make(rings.sobel), maker.make(rings.filtered), maker.make(rings.depth);
    for (auto& channel : rings.past) maker.make(channel);
    maker.make(rings.pastDepth);
    maker.height = height + 2;
    for (auto& channel : rings.current) maker.make(channel);
    maker.make(rings.sobelAt);

    // A step runs ahead of the last one by the margin that the windows between them add up to.
    const int past = in.history ? 1 : 0, sobelAt = 2 * past, sobel = sobelAt + 1, luminance = sobel + 1;
    const auto within = [&](int y, int margin, int beyond = 0) __attribute__((always_inline)) {
        return y >= -beyond && y < height + beyond && y >= y0 - margin && y < y1 + margin;
    };
    for (int y = y0 - 2 * luminance; y <= y1; y++) {
        if (a.useSobel && within(y + luminance, luminance)) luminanceRow<R>(a, rings, y + luminance);
        if (within(y + luminance, luminance)) depthRow<R>(a, rings, y + luminance);
        if (within(y + sobel, sobel)) sobelRow<R>(a, rings, y + sobel);
        if (within(y + sobelAt, sobelAt, 1)) sobelAtRow<R>(a, rings, y + sobelAt);
        if (within(y + 1, 1, 1)) currentRow<R>(a, rings, y + 1);
        if (in.history && within(y + past, past)) pastRow<R>(a, rings, y + past);
        if (within(y, 0)) resolveRow<R>(a, rings, y);
        const int r = y - 1;
        if (a.sharpened.c[0] && r >= y0 && (r > y0 || r == 0) && (r + 1 < y1 || r + 1 == height))
            sharpenResolvedRow<R>(a, r);
    }
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::MasterKernels, masterKernels) = {AA_WIDE_ROWS(masterRows)};
