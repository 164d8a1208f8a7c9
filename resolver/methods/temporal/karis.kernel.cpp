#include "methods/temporal/karis.h"

#include "kernels/pq.h"
#include "kernels/ring.h"
#include "methods/temporal/temporal_blocks.kernel.h"

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

// In the box's space, and weights in the filter: what all nine neighbours of a pixel would compute again is computed
// once.
template <class T>
struct KarisRings {
    Ring<T, 4> c[3], weight;
};
template <class T>
struct KarisWindow {  // rows y - 1, y, y + 1
    const T *c[3][3], *weight[3];
};
template <class R>
AA_INLINE vec3<R> karisColor(const KarisArgs& a, bool pq, long o) {
    const vec3<R> c = load3<R>(a.in.color.c, o);
    return pq ? vec3<R>{pqEncode(*a.pq, c.x), pqEncode(*a.pq, c.y), pqEncode(*a.pq, c.z)} : c;
}
// Pixels of an un-jittered frame beyond the picture: bilinear, they are not its edge's (conventions 7.0).
AA_INLINE int pixelsBeyond(const TemporalIn& in) { return in.readXPx != 0 || in.readYPx != 0 ? 1 : 0; }
template <class R>
AA_INLINE void convertRow(const KarisArgs& a, bool ycocg, bool pq, const KarisRings<Elem<R>>& rings, int y) {
    const int beyond = pixelsBeyond(a.in), row = y + beyond;
    Elem<R>*const c0 = rings.c[0](row), *const c1 = rings.c[1](row), *const c2 = rings.c[2](row),
                  *const weight = rings.weight(row);
    for (int x = -beyond; x < a.in.width + beyond; x += N<R>) {
        const vec3<R> rgb = karisColor<R>(a, pq, long(y) * a.in.stride + x), c = ycocg ? toYcocg(rgb) : rgb;
        store(c.x, c0 + x), store(c.y, c1 + x), store(c.z, c2 + x);
        const R one(Elem<R>(1));
        if (a.filtered) store(a.toneWeighted ? toneWeight(ycocg ? c.x : luma709(c), a.hdr4) : one, weight + x);
    }
    if (beyond) return;
    for (const auto& channel : rings.c) channel.continueBeyond(y);
    if (a.filtered) rings.weight.continueBeyond(y);
}
template <class R>
AA_INLINE void storeResult(const KarisArgs& a, bool pq, long o, vec3<R> result) {
    storeRgba(result, R(Elem<R>(1)), a.in.next + 4 * o);
    if (pq) result = {pqDecode(*a.pq, result.x), pqDecode(*a.pq, result.y), pqDecode(*a.pq, result.z)};
    store3(result, a.in.out.c, o);
}

template <class R, class YCoCg>
AA_INLINE void karisPixel(const KarisArgs& a, YCoCg ycocg, bool pq, const KarisWindow<Elem<R>>& window, int x, int y) {
    const bool filtered = a.filtered, spread = a.box != BoxKind::minmax;
    using T = Elem<R>;
    const TemporalIn& in = a.in;
    const R zero(T(0)), one(T(1));
    const long o = long(y) * in.stride + x;
    const auto at = [&](int i, int j) __attribute__((always_inline)) { return loadOwn<R>(window.c[j + 1], x + i); };
    const auto luma = [&](vec3<R> c) __attribute__((always_inline)) { return ycocg ? c.x : luma709(c); };
    const vec3<R> centre = at(0, 0);

    // 1. filtered current colour and moments, as deviations from the centre: a constant stays exactly itself
    R weight[9], weights(zero);
    const auto weigh = [&](int i, int j) __attribute__((always_inline)) {
        const int n = (j + 1) * 3 + i + 1;
        return weight[n] = R(T(a.filter[n])) * loadOwn<R>(window.weight[j + 1] + x + i);
    };
    vec3<R> sum(zero);
    const auto filter = [&](auto channel, int i, int j, R, R d) __attribute__((always_inline)) {
        part(sum, channel) = part(sum, channel) + d * weight[(j + 1) * 3 + i + 1];
    };
    if (filtered) eachNeighbour([&](int i, int j) __attribute__((always_inline)) { weights = weights + weigh(i, j); });
    Moments<R> m{centre, centre};
    if (spread && filtered)
        m = moments<R>(at, filter);
    else if (spread)
        m = moments<R>(at);
    else if (filtered)
        eachChannel([&](auto channel) __attribute__((always_inline)) {
            eachNeighbour([&](int i, int j) __attribute__((always_inline)) {
                const R v = part(at(i, j), channel);
                filter(channel, i, j, v, v - part(centre, channel));
            });
        });
    const vec3<R> current = filtered ? centre + sum * (one / max(weights + weigh(0, 0), R(T(1e-20)))) : centre;

    // 2. box
    Box<R> box;
    if (spread) box = varianceBox(m, a.gamma);
    if (!spread || a.box == BoxKind::intersection) {
        const Box<R> bounds = neighbourBox<R>(at, a.neighbourhood);
        box = spread ? Box<R>{max(box.lo, bounds.lo), min(box.hi, bounds.hi)} : bounds;
    }
    box.lo = min(box.lo, box.hi);

    // 3. history
    const Motion<R> motion = dilatedMotion<R>(in, o);
    const Reprojection<R> q = reproject(in, motion, x, y);
    const vec3<R> past = fetchHistory(in, x, y, q);
    const vec3<R> history = ycocg ? toYcocg(past) : past;
    const auto target = [&]() __attribute__((always_inline)) {
        if (a.constraint != HistoryConstraint::clipMean) return current;
        return spread ? m.mean : neighbourMeans<R>(at).square;
    };
    const vec3<R> held =
        a.constraint == HistoryConstraint::clamp ? clamp3(history, box.lo, box.hi) : clipToward(box, target(), history);

    // 4. weight of the current colour
    R alpha(T(a.alpha));
    if (a.antiFlicker == AntiFlicker::karis) alpha = karisWeight(alpha, motion, luma(current), luma(held));
    if (a.antiFlicker == AntiFlicker::falcor) alpha = falcorWeight(alpha, luma(box.lo), luma(box.hi), luma(history));
    const R k = min(one - alpha, R(T(in.feedbackCeiling)));

    // 5. blend
    const vec3<R> mixed = a.inverseLuminance ? inverseLuminanceBlend(current, luma(current), held, luma(held), k)
                                             : blend(current, held, k);
    const auto toRgb = [&](vec3<R> c) __attribute__((always_inline)) {
        return max(ycocg ? fromYcocg(c) : c, vec3<R>(zero));
    };
    vec3<R> result = toRgb(mixed);
    if (maskBits<R>(negate(both(q.inside, finite(result))))) {
        const vec3<R> raw = karisColor<R>(a, pq, o);
        result = sanitised(select(q.inside, result, filtered ? toRgb(current) : raw), raw, past);
    }
    storeResult(a, pq, o, result);
    storeDebug(in.debug, o, motion, q.inside, box, held - history, k);
}
template <class R>
__attribute__((flatten)) void karisRows(const KarisArgs& a, int y0, int y1) {
    const TemporalIn& in = a.in;
    KarisRings<Elem<R>> rings;
    const int beyond = pixelsBeyond(in);
    RingMaker<Elem<R>> maker(a.scratch, in.stride, in.width, in.height + 2 * beyond);
    for (auto& channel : rings.c) maker.make(channel);
    maker.make(rings.weight);
    const bool pq = a.pq != nullptr;  // outside of the window's loop, hence no copy of the kernel
    const auto rows = [&](auto ycocg) __attribute__((always_inline)) {
        if (!in.history) {
            for (int y = y0; y < y1; y++)
                for (int x = 0; x < in.width; x += N<R>) {
                    const long o = long(y) * in.stride + x;
                    const vec3<R> current = karisColor<R>(a, pq, o);
                    storeResult(a, pq, o, sanitised(current, current, vec3<R>(R(Elem<R>(0)))));
                    storeFirstDebug(in, o, current);
                }
            return;
        }
        for (int y = y0 - 2; y < y1; y++) {
            const int next = y + 1;
            if (next >= -beyond && next < in.height + beyond) convertRow<R>(a, ycocg, pq, rings, next);
            if (y < y0) continue;
            KarisWindow<Elem<R>> window;
            for (int j = -1; j <= 1; j++) {
                for (int i = 0; i < 3; i++) window.c[j + 1][i] = rings.c[i](y + j + beyond);
                window.weight[j + 1] = rings.weight(y + j + beyond);
            }
            for (int x = 0; x < in.width; x += N<R>) karisPixel<R>(a, ycocg, pq, window, x, y);
        }
    };
    withOptions<R>(rows, a.ycocg);
}

void fillPqTables(PqTables& t) { fillTables(t); }

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::KarisKernels, karisKernels) = {AA_WIDE_ROWS(karisRows), fillPqTables};
