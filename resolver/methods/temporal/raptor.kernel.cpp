#include "methods/temporal/raptor.h"

#include "methods/temporal/temporal_blocks.kernel.h"

namespace AA_ARCH {

template <class R>
AA_INLINE vec3<R> compressed(vec3<R> c) {
    return c * (R(Elem<R>(1)) / (R(Elem<R>(1)) + max(R(Elem<R>(0)), maxComponent(c))));
}
template <class R>
AA_INLINE vec3<R> constrained(const RaptorArgs& a, const Box<R>& bounds, const Box<R>& variance, vec3<R> h) {
    switch (a.constraint) {
        case RaptorConstraint::none:
            return h;
        case RaptorConstraint::clamp:
            return clamp3(h, bounds.lo, bounds.hi);
        case RaptorConstraint::clip:
            return clipToCentre(bounds, h);
        case RaptorConstraint::varianceClip:
            return clipToCentre(variance, h);
        case RaptorConstraint::varianceClipClamp:
            break;
    }
    return clipToCentre(variance, clamp3(h, bounds.lo, bounds.hi));
}

template <class R, class YCoCg>
AA_INLINE void raptorPixel(const RaptorArgs& a, YCoCg ycocg, int x, int y) {
    using T = Elem<R>;
    const TemporalIn& in = a.in;
    const R zero(T(0)), one(T(1));
    const long o = long(y) * in.stride + x;
    const auto at = [&](int i, int j) __attribute__((always_inline)) {
        const vec3<R> c = load3<R>(in.color.c, o + long(j) * in.stride + i);
        return ycocg ? toYcocg(c) : c;
    };
    const auto luma = [&](vec3<R> c) __attribute__((always_inline)) { return ycocg ? c.x : luma709(c); };
    const auto toRgb = [&](vec3<R> c) __attribute__((always_inline)) {
        return max(ycocg ? fromYcocg(c) : c, vec3<R>(zero));
    };

    // 1, 2
    const Motion<R> motion = dilatedMotion<R>(in, o);
    const Reprojection<R> q = reproject(in, motion, x, y);
    const vec3<R> past = fetchHistory(in, x, y, q), history = ycocg ? toYcocg(past) : past;

    // 3. moments, bounds and filtered colour, all about the centre
    const vec3<R> centre = at(0, 0);
    vec3<R> filtered(zero);
    Box<R> bounds{centre, centre};
    T weights(a.filter[4]);
    const Moments<R> m = moments<R>(
        at, [&](int i, int j, vec3<R> d) __attribute__((always_inline)) {
            const T w(a.filter[(j + 1) * 3 + i + 1]);
            const vec3<R> c = at(i, j);
            bounds.lo = min(bounds.lo, c), bounds.hi = max(bounds.hi, c);
            filtered = filtered + d * R(w), weights += w;
        });
    vec3<R> current = centre;
    if (weights > T(1e-6)) {
        current = centre + filtered * R(T(1) / weights);
        if (a.clampCurrent) current = clamp3(current, bounds.lo, bounds.hi);
    }

    // 5, 6
    if (ycocg) {
        const R chroma = (bounds.hi.x - bounds.lo.x) * R(T(0.125));
        bounds.lo = {bounds.lo.x, current.y - chroma, current.z - chroma};
        bounds.hi = {bounds.hi.x, current.y + chroma, current.z + chroma};
    }
    const Box<R> spread = varianceBox(m, a.gamma);
    const vec3<R> held = constrained(a, bounds, spread, history);

    // 9
    const R lumaCurrent = max(zero, luma(compressed(current))), lumaHistory = max(zero, luma(compressed(held)));
    const R brighterCurrent = one + lumaCurrent, brighterHistory = one + lumaHistory, most(T(in.feedbackCeiling));
    // 11, 12: (1 - k) / (1 + Lc) against k / (1 + Lh), both times (1 + Lc) (1 + Lh) >= 1
    const auto weighted = [&](R weight) __attribute__((always_inline)) {
        const R w = min(weight, most), wh = w * brighterCurrent;
        return a.luminanceWeights ? wh / ((one - w) * brighterHistory + wh) : w;
    };
    R shown;
    vec3<R> mixed;
    if (a.luminanceDifference == LuminanceDifference::off) {
        // 7, 8: weight of history per channel
        vec3<R> k(R(T(0.9)));
        if (a.temporalFiltering) {
            const vec3<R> divisor = a.signedDivisor ? current : max(current, vec3<R>(R(T(1e-4))));
            // Black without contrast has none: 0 / 0 as printed is no number.
            const vec3<R> contrast = min(max(vec3<R>(zero), abs(bounds.hi - bounds.lo) / divisor), vec3<R>(one));
            k = vec3<R>(R(T(0.25))) + contrast * R(T(0.6));
        }
        k = {weighted(k.x), weighted(k.y), weighted(k.z)};
        mixed = {blend(current, held, k.x).x, blend(current, held, k.y).y, blend(current, held, k.z).z};
        shown = k.y;
    } else {  // 10 replaces both
        shown = weighted(a.luminanceDifference == LuminanceDifference::corrected
                             ? luminanceFeedback(lumaCurrent, lumaHistory, a.kMin, a.kMax)
                             : one - luminanceFeedback(lumaCurrent, lumaHistory, 0.0f, 1.0f));
        mixed = blend(current, held, shown);
    }

    const vec3<R> result = select(q.inside, toRgb(mixed), toRgb(current));  // 4
    storeBlend(in, x, y, sanitised(result, load3<R>(in.color.c, o), past), one);
    storeDebug(in.debug, o, motion, q.inside, bounds, held - history, shown);
}
template <class R>
__attribute__((flatten)) void raptorRows(const RaptorArgs& a, int y0, int y1) {
    const auto rows = [&](auto ycocg) __attribute__((always_inline)) {
        for (int y = y0; y < y1; y++)
            for (int x = 0; x < a.in.width; x += N<R>)
                if (a.in.history)
                    raptorPixel<R>(a, ycocg, x, y);
                else
                    storeFirst<R>(a.in, x, y);
    };
    withOptions<R>(rows, a.ycocg);
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::RaptorKernels, raptorKernels) = {AA_WIDE_ROWS(raptorRows)};
