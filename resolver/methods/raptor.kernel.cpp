#include "methods/raptor_kernels.h"
#include "methods/temporal_blocks.kernel.h"

namespace AA_ARCH {

template <class R>
AA_INLINE vec3<R> compressed(vec3<R> c) {
    return c * (R(Elem<R>(1)) / (R(Elem<R>(1)) + max(R(Elem<R>(0)), max_component(c))));
}
template <class R>
AA_INLINE vec3<R> constrained(const RaptorArgs& a, const Box<R>& bounds, const Box<R>& variance, vec3<R> h) {
    switch (a.constraint) {
        case RaptorConstraint::none:
            return h;
        case RaptorConstraint::clamp:
            return clamp3(h, bounds.lo, bounds.hi);
        case RaptorConstraint::clip:
            return clip_to_centre(bounds, h);
        case RaptorConstraint::varianceClip:
            return clip_to_centre(variance, h);
        case RaptorConstraint::varianceClipClamp:
            break;
    }
    return clip_to_centre(variance, clamp3(h, bounds.lo, bounds.hi));
}

template <class R>
AA_INLINE void raptorPixel(const RaptorArgs& a, int x, int y) {
    using T = Elem<R>;
    const TemporalIn& in = a.in;
    const R zero(T(0)), one(T(1));
    const long o = long(y) * in.stride + x;
    const Window<R> at([&](int i, int j) __attribute__((always_inline)) {
        const vec3<R> c = load3<R>(in.color.c, o + long(j) * in.stride + i);
        return a.ycocg ? to_ycocg(c) : c;
    });
    const auto luma = [&](vec3<R> c) __attribute__((always_inline)) { return a.ycocg ? c.x : luma709(c); };
    const auto toRgb = [&](vec3<R> c) __attribute__((always_inline)) {
        return max(a.ycocg ? from_ycocg(c) : c, vec3<R>(zero));
    };

    // 1, 2
    const Motion<R> motion = dilated_motion<R>(in, o);
    const Reprojection<R> q = reproject(in, motion, x, y);
    const vec3<R> past = fetch_history(in, x, y, q), history = a.ycocg ? to_ycocg(past) : past;

    // 3. moments, bounds and filtered colour, all about the centre
    const vec3<R> centre = at(0, 0);
    vec3<R> m1(zero), m2(zero), filtered(zero);
    Box<R> bounds{centre, centre};
    T weights(0);
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            const T w(a.filter[(j + 1) * 3 + i + 1]);
            weights += w;
            if (i == 0 && j == 0) continue;
            const vec3<R> c = at(i, j), d = c - centre;
            bounds.lo = min(bounds.lo, c), bounds.hi = max(bounds.hi, c);
            m1 = m1 + d, m2 = m2 + d * d;
            filtered = filtered + d * R(w);
        }
    const R ninth(T(1) / T(9));
    const vec3<R> shift = m1 * ninth;
    const Moments<R> m{centre + shift, sqrt(max(m2 * ninth - shift * shift, vec3<R>(zero)))};
    vec3<R> current = centre;
    if (weights > T(1e-6)) current = clamp3(centre + filtered * R(T(1) / weights), bounds.lo, bounds.hi);

    // 5, 6
    if (a.ycocg) {
        const R chroma = (bounds.hi.x - bounds.lo.x) * R(T(0.125));
        bounds.lo = {bounds.lo.x, current.y - chroma, current.z - chroma};
        bounds.hi = {bounds.hi.x, current.y + chroma, current.z + chroma};
    }
    const Box<R> spread = variance_box(m, a.gamma);
    const vec3<R> held = constrained(a, bounds, spread, history);

    // 7, 8: weight of history per channel
    vec3<R> k(R(T(0.9)));
    if (a.temporalFiltering) {
        const vec3<R> contrast = saturate(abs(bounds.hi - bounds.lo) / max(current, vec3<R>(R(T(1e-4)))));
        k = vec3<R>(R(T(0.25))) + contrast * R(T(0.6));
    }
    // 9, 10
    const R lumaCurrent = max(zero, luma(compressed(current))), lumaHistory = max(zero, luma(compressed(held)));
    if (a.luminanceDifference == LuminanceDifference::corrected)
        k = vec3<R>(luminance_feedback(lumaCurrent, lumaHistory, a.kMin, a.kMax));
    if (a.luminanceDifference == LuminanceDifference::printed)
        k = vec3<R>(one - luminance_feedback(lumaCurrent, lumaHistory, 0.0f, 1.0f));
    k = min(k, vec3<R>(R(T(in.feedbackCeiling))));
    // 11, 12
    if (a.inverseLuminance) {
        const vec3<R> wc = (vec3<R>(one) - k) * (one / (one + lumaCurrent)), wh = k * (one / (one + lumaHistory));
        k = wh / max(wc + wh, vec3<R>(R(T(1e-5))));
    }
    const vec3<R> mixed{blend(current, held, k.x).x, blend(current, held, k.y).y, blend(current, held, k.z).z};

    const vec3<R> result = select(q.inside, toRgb(mixed), toRgb(current));  // 4
    store_blend(in, x, y, sanitised(result, load3<R>(in.color.c, o), past), one);
    store_debug(in.debug, o, motion, q.inside, bounds, held - history, k.y);
}
template <class R>
__attribute__((flatten)) void raptorRows(const RaptorArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.in.width; x += N<R>)
            if (a.in.history)
                raptorPixel<R>(a, x, y);
            else
                store_first<R>(a.in, x, y);
}

template <class R>
__attribute__((flatten)) void lumaSharpenRows(const LumaSharpenArgs& a, int y0, int y1) {
    using T = Elem<R>;
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            const vec3<R> c = load3<R>(a.in.c, o);
            const R centre = luma709(c);
            R around(T(0));
            for (int j = -1; j <= 1; j++)
                for (int i = -1; i <= 1; i++)
                    if (i || j) around = around + (luma709(load3<R>(a.in.c, o + long(j) * a.stride + i)) - centre);
            // L - mean of 3x3 = -(sum of differences) / 9.
            const R sharp = max(R(T(0)), centre - around * R(T(a.amount) / T(9)));
            const auto dark = centre < R(T(1e-6));
            store3(select(dark, c, c * (sharp / select(dark, R(T(1)), centre))), a.out.c, o);
        }
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::RaptorKernels, raptorKernels) = {AA_ROWS(raptorRows), AA_ROWS(lumaSharpenRows)};
