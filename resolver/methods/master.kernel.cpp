#include "kernels/srgb.h"
#include "methods/master_kernels.h"
#include "methods/master_terms.kernel.h"

namespace AA_ARCH {

template <class R>
__attribute__((flatten)) void luminanceRows(const MasterLuminanceArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            const vec3<R> albedo = load3<R>(a.albedoLinear.c, o);
            const vec3<R> encoded{srgb_encode(saturate(albedo.x)), srgb_encode(saturate(albedo.y)),
                                  srgb_encode(saturate(albedo.z))};
            store(luminance(encoded, a.bt601), a.luminanceAlbedo + o);
            store(luminance(load3<R>(a.colorEncoded.c, o), a.bt601), a.luminanceLit + o);
        }
}

template <class R>
__attribute__((flatten)) void sobelRows(const MasterSobelArgs& a, int y0, int y1) {
    using T = Elem<R>;
    const R farDepth = R(T(a.farDepth));
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            const auto window = [&](const float* plane) __attribute__((always_inline)) {
                return sobel_magnitude<R>([=](int i, int j) __attribute__((always_inline)) {
                    return load<R>(plane + o + long(j) * a.stride + i);
                });
            };
            const R depth = sobel_magnitude<R>([&](int i, int j) __attribute__((always_inline)) {
                return min(farDepth, load<R>(a.depthView + o + long(j) * a.stride + i));
            });
            const R sum = window(a.luminanceAlbedo) * R(T(a.weightAlbedo)) +
                          window(a.luminanceLit) * R(T(a.weightLit)) + depth * R(T(a.depthScale));
            store(sobel_curve(sum), a.sobel + o);
        }
}

template <class R>
AA_INLINE void pastPixel(const MasterPastArgs& a, int x, int y) {
    using T = Elem<R>;
    const TemporalIn& in = a.in;
    const long o = long(y) * in.stride + x;
    const Motion<R> motion = dilated_motion<R>(in, o);
    const Reprojection<R> q = reproject(in, motion, x, y);
    const Texel<R> past = fetch_bilinear<R>(in.history + 4 * o, in.stride, q);

    const auto sobelAt = [&](int i, int j) __attribute__((always_inline)) {
        return load<R>(a.sobel + o + long(j) * in.stride + i);
    };
    const R now = sobelAt(0, 0);
    R filtered = now;
    if (a.temporalSobel) {
        const R plusLow = min(min(min(now, sobelAt(-1, 0)), min(sobelAt(1, 0), sobelAt(0, -1))), sobelAt(0, 1));
        const R plusHigh = max(max(max(now, sobelAt(-1, 0)), max(sobelAt(1, 0), sobelAt(0, -1))), sobelAt(0, 1));
        const R low = min(plusLow, min(min(sobelAt(-1, -1), sobelAt(1, -1)), min(sobelAt(-1, 1), sobelAt(1, 1))));
        const R high = max(plusHigh, max(max(sobelAt(-1, -1), sobelAt(1, -1)), max(sobelAt(-1, 1), sobelAt(1, 1))));
        const R half(T(0.5)), held = clamp(past.a, (low + plusLow) * half, (high + plusHigh) * half);
        const R k = min(luminance_feedback(now, held, a.kMin, a.kMax), R(T(in.feedbackCeiling)));
        filtered = select(q.inside, held + (now - held) * (R(T(1)) - k), now);
    }
    store(filtered, a.sobelFiltered + o);

    alignas(64) int k[N<R>];
    nearest_offsets(q, in.stride, k);
    R depth = a.samePixelDepth ? load<R>(a.previousDepth + o) : gather<R>(a.previousDepth + o, k);
    depth = select(q.inside, depth, R(T(__builtin_nanf(""))));
    const vec3<R> color = in.filter == HistoryFilter::bilinear ? past.rgb : fetch_history(in, x, y, q);
    store_rgba(color, depth, in.next + 4 * o);
    if (in.debug.feedback) store(motion.x, in.debug.motionXPx + o), store(motion.y, in.debug.motionYPx + o);
}
template <class R>
__attribute__((flatten)) void pastRows(const MasterPastArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.in.width; x += N<R>) pastPixel<R>(a, x, y);
}

template <class R>
AA_INLINE void keep_depth(const MasterArgs& a, long o) {
    if (a.keptDepth) store(load<R>(a.in.depthView + o), a.keptDepth + o);
}
template <class R>
AA_INLINE void masterPixel(const MasterArgs& a, int x, int y) {
    using T = Elem<R>;
    const TemporalIn& in = a.in;
    const R zero(T(0)), one(T(1)), farDepth = R(T(a.farDepth));
    const long o = long(y) * in.stride + x;
    const auto at = [&](int i, int j) __attribute__((always_inline)) { return o + long(j) * in.stride + i; };
    const Texel<R> waiting = load_rgba<R>(in.next + 4 * o);
    const vec3<R> current = load3<R>(in.color.c, o), history = waiting.rgb;
    const R pastDepth = waiting.a;
    const auto inside = pastDepth == pastDepth;

    // How aliased is this pixel?
    R model(zero), sobel(zero);
    PseudoVariances<R> variance{zero, zero};
    if (a.useModel)
        model = model_average<R>([&](int i, int j) __attribute__((always_inline)) {
            return ids_differ<R>(a.objectId + at(i, j), a.objectId + o);
        });
    if (a.useDepth || a.useDepthTemporal) {
        const R depth = min(farDepth, load<R>(in.depthView + o));
        const DepthWindow<R> window = depth_window<R>([&](int i, int j) __attribute__((always_inline)) {
            return min(farDepth, load<R>(in.depthView + at(i, j)));
        });
        R past = min(farDepth, pastDepth) - depth;
        if (a.compensate) {
            const R expected = min(farDepth, expected_previous_depth(a.expected, load<R>(in.depthView + o), x, y));
            past = min(farDepth, pastDepth) - expected;
        }
        R threshold(T(a.depthThreshold));
        if (a.relativeThreshold) threshold = threshold * max(depth + window.mean, one);
        variance = pseudo_variances(window, past, threshold);
        if (!a.useDepth) variance.depth = zero;
        variance.depthTemporal = a.useDepthTemporal ? select(inside, variance.depthTemporal, one) : zero;
    }
    if (a.useSobel) {
        const auto s = [&](int i, int j) __attribute__((always_inline)) { return load<R>(a.sobelFiltered + at(i, j)); };
        const R plus = s(0, 0) + ((s(-1, 0) + s(1, 0)) + (s(0, -1) + s(0, 1)));
        const R square = plus + ((s(-1, -1) + s(1, -1)) + (s(-1, 1) + s(1, 1)));
        sobel = mix(plus * R(T(1) / T(5)), square * R(T(1) / T(9)), saturate(model + s(0, 0)));  // eqs 4.12, 4.13
    }
    const R aliased = max(saturate(sobel + variance.depth + variance.depthTemporal + model), R(T(a.minAlias)));

    // The box: loose where aliased, the current colour alone where not (eqs 4.15, 4.16).
    const Neighbours<R> window =
        neighbours<R>([&](int i, int j) __attribute__((always_inline)) { return load3<R>(in.color.c, at(i, j)); });
    const vec3<R> low = mix(window.plus.lo, window.square.lo, aliased),
                  high = mix(window.plus.hi, window.square.hi, aliased),
                  mean = mix(window.meanPlus, window.meanSquare, aliased);
    const Box<R> box{mix(current, low, aliased), mix(current, high, aliased)};
    const vec3<R> clipped = constrain(box, a.clipTarget, mean, current, history);

    const R k = min(luminance_feedback(luma709(current), luma709(clipped), a.kMin, a.kMax), R(T(in.feedbackCeiling)));
    const vec3<R> mixed = select(inside, blend(current, clipped, k), current);

    store_blend(in, x, y, sanitised(mixed, current, history), load<R>(a.sobelFiltered + o));
    if (!in.debug.feedback) {
        store_debug(in.debug, o, Motion<R>{k, k}, inside, box, history, k);
    } else {
        store_debug(in.debug, o, Motion<R>{load<R>(in.debug.motionXPx + o), load<R>(in.debug.motionYPx + o)}, inside,
                    box, clipped - history, k);
        store(aliased, a.debugAliased + o), store(sobel, a.debugSobel + o), store(model, a.debugModel + o);
        store(variance.depth, a.debugDepth + o), store(variance.depthTemporal, a.debugDepthTemporal + o);
    }
}
template <class R>
__attribute__((flatten)) void masterRows(const MasterArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.in.width; x += N<R>) {
            const long o = long(y) * a.in.stride + x;
            if (a.in.history)
                masterPixel<R>(a, x, y);
            else
                store_first<R>(a.in, x, y, load<R>(a.sobelFiltered + o));
            keep_depth<R>(a, o);
        }
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::MasterKernels, masterKernels) = {AA_ROWS(luminanceRows), AA_ROWS(sobelRows), AA_ROWS(pastRows),
                                                     AA_ROWS(masterRows)};
