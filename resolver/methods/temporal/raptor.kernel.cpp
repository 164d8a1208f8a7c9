#include "methods/temporal/raptor.h"

#include "methods/temporal/temporal_blocks.kernel.h"

// Limited by the additions and bounds of the window, eight neighbours in three channels, and by the history's 16
// texels.
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

// What one step hands to the next, for N pixels.
template <class R>
struct RaptorPixels {
    Motion<R> motion;
    Reprojection<R> q;
    vec3<R> past, current, history, held;
    Box<R> bounds;
    Moments<R> moments;
};
template <class R, class YCoCg>
struct Raptor {
    using T = Elem<R>;
    const RaptorArgs& a;
    YCoCg ycocg;
    T weights;  // sum of the filter's
    const TemporalIn& in = a.in;

    AA_INLINE R luma(vec3<R> c) const { return ycocg ? c.x : luma709(c); }
    AA_INLINE vec3<R> toRgb(vec3<R> c) const { return max(ycocg ? fromYcocg(c) : c, vec3<R>(R(T(0)))); }

    // 3: moments, bounds and filtered colour, all about the centre
    AA_INLINE void findBox(RaptorPixels<R>& p, long o) const {
        const auto at = [&](int i, int j) __attribute__((always_inline)) {
            const vec3<R> c = load3<R>(in.color.c, o + long(j) * in.stride + i);
            return ycocg ? toYcocg(c) : c;
        };
        const vec3<R> centre = at(0, 0);
        vec3<R> filtered(R(T(0)));
        Box<R> bounds{centre, centre};
        p.moments = moments<R>(
            at, [&](auto channel, int i, int j, R v, R d) __attribute__((always_inline)) {
                R &low = part(bounds.lo, channel), &high = part(bounds.hi, channel), &sum = part(filtered, channel);
                low = min(low, v), high = max(high, v);
                sum = sum + d * R(T(a.filter[(j + 1) * 3 + i + 1]));
            });
        vec3<R> current = centre;
        if (weights > T(1e-6)) {
            current = centre + filtered * R(T(1) / weights);
            if (a.clampCurrent) current = clamp3(current, bounds.lo, bounds.hi);
        }
        p.current = current, p.bounds = bounds;
    }
    // 5, 6
    AA_INLINE void constrain(RaptorPixels<R>& p) const {
        if (ycocg) {
            const R chroma = (p.bounds.hi.x - p.bounds.lo.x) * R(T(0.125));
            p.bounds.lo = {p.bounds.lo.x, p.current.y - chroma, p.current.z - chroma};
            p.bounds.hi = {p.bounds.hi.x, p.current.y + chroma, p.current.z + chroma};
        }
        p.history = ycocg ? toYcocg(p.past) : p.past;
        p.held = constrained(a, p.bounds, varianceBox(p.moments, a.gamma), p.history);
    }
    // 7 to 12
    AA_INLINE void blendAndStore(const RaptorPixels<R>& p, int x, int y) const {
        const R zero(T(0)), one(T(1));
        const long o = long(y) * in.stride + x;
        const vec3<R> current = p.current, held = p.held;
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
                const vec3<R> contrast =
                    min(max(vec3<R>(zero), abs(p.bounds.hi - p.bounds.lo) / divisor), vec3<R>(one));
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
        const vec3<R> result = select(p.q.inside, toRgb(mixed), toRgb(current));  // 4
        storeBlend(in, x, y, sanitised(result, load3<R>(in.color.c, o), p.past), one);
        storeDebug(in.debug, o, p.motion, p.q.inside, p.bounds, held - p.history, shown);
    }
    AA_INLINE void row(int y) const {
        RaptorPixels<R> pixels[kStepGroups];
        inSteps<R>(
            in.width,
            [&](int i, int x) __attribute__((always_inline)) {  // 1
                pixels[i].motion = dilatedMotion<R>(in, long(y) * in.stride + x);
                pixels[i].q = reproject(in, pixels[i].motion, x, y);
            },
            [&](int i, int x) __attribute__((always_inline)) {  // 2
                pixels[i].past = fetchHistory(in, x, y, pixels[i].q);
            },
            [&](int i, int x) __attribute__((always_inline)) { findBox(pixels[i], long(y) * in.stride + x); },
            [&](int i, int) __attribute__((always_inline)) { constrain(pixels[i]); },
            [&](int i, int x) __attribute__((always_inline)) { blendAndStore(pixels[i], x, y); });
    }
};
template <class R>
__attribute__((flatten)) void raptorRows(const RaptorArgs& a, int y0, int y1) {
    Elem<R> weights(a.filter[4]);
    eachNeighbour([&](int i, int j) { weights += Elem<R>(a.filter[(j + 1) * 3 + i + 1]); });
    const auto rows = [&](auto ycocg) __attribute__((always_inline)) {
        const Raptor<R, decltype(ycocg)> raptor{a, ycocg, weights};
        for (int y = y0; y < y1; y++)
            if (a.in.history)
                raptor.row(y);
            else
                for (int x = 0; x < a.in.width; x += N<R>) storeFirst<R>(a.in, x, y);
    };
    withOptions<R>(rows, a.ycocg);
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::RaptorKernels, raptorKernels) = {AA_WIDE_ROWS(raptorRows)};
