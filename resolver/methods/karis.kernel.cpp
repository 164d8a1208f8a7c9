#include "kernels/pq.h"
#include "methods/karis_kernels.h"
#include "methods/temporal_blocks.kernel.h"

namespace AA_ARCH {

template <class R>
AA_INLINE R toneWeight(R y, bool hdr4) {
    using T = Elem<R>;
    const R zero(T(0)), one(T(1)), four(T(4));
    return hdr4 ? four / (four + max(zero, y)) : one / (one + max(zero, y));
}
// Public UE4: the speed raises the current weight to 0.2; nearly equal luminance takes the current colour.
template <class R>
AA_INLINE R karisWeight(R alpha, Motion<R> motion, R lumaCurrent, R lumaHistory) {
    using T = Elem<R>;
    const R speed = sqrt(motion.x * motion.x + motion.y * motion.y);
    const R moving = mix(alpha, R(T(0.2)), saturate(speed * R(T(1) / T(40))));
    return max(moving, saturate(lumaHistory * R(T(0.01)) / max(abs(lumaCurrent - lumaHistory), R(T(1e-4)))));
}
// Falcor: less of the current colour where history lies near the end of a wide box.
template <class R>
AA_INLINE R falcorWeight(R alpha, R low, R high, R lumaHistory) {
    using T = Elem<R>;
    const R toClamp = min(abs(low - lumaHistory), abs(high - lumaHistory)), sum = toClamp + (high - low);
    const auto flat = sum <= R(T(1e-12));
    return select(flat, alpha, saturate(alpha * toClamp / select(flat, R(T(1)), sum)));
}

template <class R>
AA_INLINE void karisPixel(const KarisArgs& a, int x, int y) {
    using T = Elem<R>;
    const TemporalIn& in = a.in;
    const R zero(T(0)), one(T(1));
    const long o = long(y) * in.stride + x;
    const Window<R> at([&](int i, int j) __attribute__((always_inline)) {
        const vec3<R> c = load3<R>(in.color.c, o + long(j) * in.stride + i);
        return a.ycocg ? to_ycocg(c) : c;
    });
    const auto luma = [&](vec3<R> c) __attribute__((always_inline)) { return a.ycocg ? c.x : luma709(c); };
    const vec3<R> centre = at(0, 0);

    // 1. filtered current colour, as deviation from the centre: a constant stays exactly itself
    vec3<R> current = centre;
    if (a.filtered) {
        vec3<R> sum(zero);
        R weights(zero);
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++) {
                const vec3<R> c = at(i, j);
                R w(T(a.filter[(j + 1) * 3 + i + 1]));
                if (a.toneWeighted) w = w * toneWeight(luma(c), a.hdr4);
                sum = sum + (c - centre) * w;
                weights = weights + w;
            }
        current = centre + sum * (one / max(weights, R(T(1e-20))));
    }

    // 2. box
    Box<R> box;
    vec3<R> mean = centre;
    if (a.box != BoxKind::variance) box = box_of(neighbours<R>(at), a.neighbourhood);
    if (a.box != BoxKind::minmax) {
        const Moments<R> m = moments<R>(at);
        const Box<R> spread = variance_box(m, a.gamma);
        if (a.box == BoxKind::variance)
            box = spread;
        else
            box = {max(box.lo, spread.lo), min(box.hi, spread.hi)};
        mean = m.mean;
    }
    box.lo = min(box.lo, box.hi);

    // 3. history
    const Motion<R> motion = dilated_motion<R>(in, o);
    const Reprojection<R> q = reproject(in, motion, x, y);
    const vec3<R> past = fetch_history(in, x, y, q);
    const vec3<R> history = a.ycocg ? to_ycocg(past) : past;
    const vec3<R> held = a.constraint == HistoryConstraint::clamp      ? clamp3(history, box.lo, box.hi)
                         : a.constraint == HistoryConstraint::clipMean ? clip_toward(box, mean, history)
                                                                       : clip_toward(box, current, history);

    // 4. weight of the current colour
    R alpha(T(a.alpha));
    if (a.antiFlicker == AntiFlicker::karis) alpha = karisWeight(alpha, motion, luma(current), luma(held));
    if (a.antiFlicker == AntiFlicker::falcor) alpha = falcorWeight(alpha, luma(box.lo), luma(box.hi), luma(history));
    const R k = min(one - alpha, R(T(in.feedbackCeiling)));

    // 5. blend
    const vec3<R> mixed = a.inverseLuminance ? inverse_luminance_blend(current, luma(current), held, luma(held), k)
                                             : blend(current, held, k);
    const auto toRgb = [&](vec3<R> c) __attribute__((always_inline)) {
        return max(a.ycocg ? from_ycocg(c) : c, vec3<R>(zero));
    };
    const vec3<R> raw = load3<R>(in.color.c, o);
    const vec3<R> result = select(q.inside, toRgb(mixed), a.filtered ? toRgb(current) : raw);
    store_blend(in, x, y, sanitised(result, raw, past), one);
    store_debug(in.debug, o, motion, q.inside, box, held - history, k);
}
template <class R>
__attribute__((flatten)) void karisRows(const KarisArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.in.width; x += N<R>)
            if (a.in.history)
                karisPixel<R>(a, x, y);
            else
                store_first<R>(a.in, x, y);
}

template <class R>
__attribute__((flatten)) void pqEncodeRows(const PqArgs& a, int y0, int y1) {
    for (int c = 0; c < 3; c++)
        for (int y = y0; y < y1; y++)
            for (int x = 0; x < a.width; x += N<R>) {
                const long o = long(y) * a.stride + x;
                store(pq_encode(load<R>(a.in.c[c] + o)), a.out.c[c] + o);
            }
}
template <class R>
__attribute__((flatten)) void pqDecodeRows(const PqArgs& a, int y0, int y1) {
    for (int c = 0; c < 3; c++)
        for (int y = y0; y < y1; y++)
            for (int x = 0; x < a.width; x += N<R>) {
                const long o = long(y) * a.stride + x;
                store(pq_decode(load<R>(a.in.c[c] + o)), a.out.c[c] + o);
            }
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::KarisKernels, karisKernels) = {AA_ROWS(karisRows), AA_ROWS(pqEncodeRows), AA_ROWS(pqDecodeRows)};
