#include "methods/temporal/fsr2n.h"

#include "kernels/math.h"
#include "methods/temporal/temporal_blocks.kernel.h"

namespace AA_ARCH {

constexpr float kLeastSplat = 0.01f;   // bilinear weights below it are no evidence (FSR 2)
constexpr float kSimilarLuma = 1.05f;  // ratio up to which two pixels are of one ridge (FSR 2)
constexpr float kLockedLuma = 0.9f;    // ratio down to which a lock's luma is unchanged (FSR 2)
constexpr float kFastPx = 20;          // speed at which box and weight are those of motion (FSR 2)

AA_INLINE void takeLeastShared(float* at, float z) {
    int32_t bits, *cell = (int32_t*)at;
    std::memcpy(&bits, &z, 4);
    int32_t old = __atomic_load_n(cell, __ATOMIC_RELAXED);
    while (bits < old && !__atomic_compare_exchange_n(cell, &old, bits, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {
    }
}
// N pixels whose depths go to four texels each, those for which `lands` says so.
template <class R>
struct Splats {
    Offsets<R> texel;
    R depthView;
    Mask<R> lands[4];
};
template <class R>
AA_INLINE Splats<R> splats(const TemporalIn& in, int x, int y) {
    using T = Elem<R>;
    const Surface<R> s = closestSurface<R>(in, long(y) * in.stride + x, false);
    const Reprojection<R> q = reproject(in, s.motion, x, y);
    const R zero(T(0)), one(T(1)), left = R(T(x)) + iota<R>() + q.wholeX, top = R(T(y)) + q.wholeY;
    const auto known = both(both(q.inside, s.depthView > zero), iota<R>() < R(T(in.width - x)));
    Splats<R> p{texelOffsets(q, in.stride), s.depthView, {}};
    for (int tap = 0; tap < 4; tap++) {
        const int dx = tap & 1, dy = tap >> 1;
        const R w = (dx ? q.fracX : one - q.fracX) * (dy ? q.fracY : one - q.fracY);
        const auto inX = both(left >= R(T(-dx)), left < R(T(in.width - dx))),
                   inY = both(top >= R(T(-dy)), top < R(T(in.height - dy)));
        p.lands[tap] = both(both(known, w > R(T(kLeastSplat))), both(inX, inY));
    }
    return p;
}
// Pixels that move alike land side by side and are taken together; most of a group do.
template <class R>
AA_INLINE void takeLeast(float* at, const Splats<R>& p, Mask<R> lands) {
    if constexpr (N<R> == 1) {
        at += p.texel.k[0];
        if (lands && float(p.depthView) < *at) *at = float(p.depthView);
    } else {
        using I = typename IntsOf<N<R>>::type;
        const I first = *(const I*)p.texel.k - __builtin_convertvector(iota<R>().v, I);
        for (unsigned left = maskBits<R>(lands); left;) {
            const int i = __builtin_ctz(left);
            const Mask<R> alike = p.texel.together ? lands : Mask<R>(first == I{} + first[i]);
            float* const texels = at + first[i];
            const R old = load<R>(texels);
            const auto nearer = both(both(lands, alike), p.depthView < old);
            if (maskBits<R>(nearer)) store(select(nearer, p.depthView, old), texels);
            left &= ~maskBits<R>(alike);
        }
    }
}
template <class R>
AA_INLINE void takeLeastShared(float* at, const Splats<R>& p, Mask<R> lands) {
    alignas(64) float z[N<R>];
    store(p.depthView, z);
    for (unsigned left = maskBits<R>(lands); left; left &= left - 1) {
        const int i = __builtin_ctz(left);
        takeLeastShared(at + p.texel.k[i], z[i]);
    }
}
// Some pixels, then one of their texels after the other: the neighbours that read what was just written are far away.
template <class R>
__attribute__((flatten)) void fsr2nScatterRows(const Fsr2nScatterArgs& a, int y0, int y1) {
    constexpr int kGroups = 32;
    const TemporalIn& in = a.in;
    Splats<R> group[kGroups];
    for (int y = y0; y < y1; y++)
        for (int x0 = 0; x0 < in.width; x0 += kGroups * N<R>) {
            int count = 0;
            for (int x = x0; x < in.width && count < kGroups; x += N<R>) group[count++] = splats<R>(in, x, y);
            for (int tap = 0; tap < 4; tap++) {
                float* const at = a.nearest + long(y + (tap >> 1)) * in.stride + x0 + (tap & 1);
                for (int i = 0; i < count; i++)
                    if (a.shared)
                        takeLeastShared(at + i * N<R>, group[i], group[i].lands[tap]);
                    else
                        takeLeast(at + i * N<R>, group[i], group[i].lands[tap]);
            }
        }
}

// 0: the surface was visible a frame ago. 1: something nearer stood before it.
template <class R>
AA_INLINE R depthClip(const Fsr2nArgs& a, const Reprojection<R>& q, R depth, long o) {
    using T = Elem<R>;
    const R zero(T(0)), one(T(1));
    const Offsets<R> k = texelOffsets(q, a.in.stride);
    const R wx[2] = {one - q.fracX, q.fracX}, wy[2] = {one - q.fracY, q.fracY};
    R visible(zero), weights(zero);
    for (int tap = 0; tap < 4; tap++) {
        const R w = wx[tap & 1] * wy[tap >> 1];
        const auto evident = w > R(T(kLeastSplat));
        if (maskBits<R>(evident) == 0) continue;  // three of the four where nothing moves
        const R found = gather<R>(a.nearest + o + long(tap >> 1) * a.in.stride + (tap & 1), k);
        const R behind = depth - found;
        const auto counts = both(behind > zero, evident);
        if (maskBits<R>(counts) == 0) continue;
        const R least = max(depth, found) * R(T(a.separation));
        const R share = min(least / select(counts, behind, one), one);
        // From 1080p on the power is 3: no logarithm.
        const R graded = a.power == 3 ? share * share * share : powPositive(share, R(T(a.power)));
        visible = visible + select(counts, w * graded, zero);
        weights = weights + select(counts, w, zero);
    }
    return select(weights > zero, saturate(one - visible / max(weights, R(T(1e-6)))), zero);
}

// A pixel brighter or darker than all that differ from it, and not part of a 2x2 block of its kind: a thin line's.
template <class R, class LumaAt>
AA_INLINE Mask<R> isRidge(const LumaAt& at) {
    using T = Elem<R>;
    const R y = at(0, 0), far(T(1e30));
    R darkest(far), brightest(-far);
    Mask<R> similar[9];
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            const R v = at(i, j), most = max(v, y);
            const auto same = either(most < min(v, y) * R(T(kSimilarLuma)), most < R(T(1e-6)));
            similar[(j + 1) * 3 + i + 1] = same;
            darkest = min(darkest, select(same, far, v));
            brightest = max(brightest, select(same, -far, v));
        }
    const auto block = [&](int a, int b, int c) { return both(both(similar[a], similar[b]), similar[c]); };
    const auto solid = either(either(block(0, 1, 3), block(1, 2, 5)), either(block(3, 6, 7), block(5, 7, 8)));
    return both(either(y > brightest, y < darkest), negate(solid));
}

// The mean of h and c in the space x / (1 + max(x)), taken back. As a step from h, so that equal colours stay exact and
// nothing cancels: with H = 1 + max(h), C = 1 + max(c), P = (1 - a) C and Q = a H the mean is
// (P h + Q c) / (P + Q + least over the channels of P (H - 1 - h) + Q (C - 1 - c)).
template <class R>
AA_INLINE vec3<R> toneMappedMean(vec3<R> h, vec3<R> c, R a) {
    using T = Elem<R>;
    const R zero(T(0)), one(T(1)), mh = maxComponent(h), mc = maxComponent(c);
    const R P = (one - a) * (one + mc), Q = a * (one + mh);
    const vec3<R> below = (vec3<R>(mh) - h) * P + (vec3<R>(mc) - c) * Q;
    const R excess = min(below.x, min(below.y, below.z));
    const vec3<R> mean = h + ((c - h) * Q - h * excess) * (one / (P + Q + excess));
    return select(a == one, c, select(a == zero, h, max(mean, vec3<R>(zero))));
}

// Colours as FSR 2 prepares them: what a half float holds. x / (1 + max) comes so near to 1 beyond that float cannot
// tell one from another.
template <class R>
AA_INLINE vec3<R> preparedColour(const TemporalIn& in, long o) {
    return min(load3<R>(in.color.c, o), vec3<R>(R(Elem<R>(65504))));
}

template <class R>
AA_INLINE void fsr2nPixel(const Fsr2nArgs& a, int x, int y) {
    using T = Elem<R>;
    const TemporalIn& in = a.in;
    const R zero(T(0)), one(T(1));
    const long o = long(y) * in.stride + x;
    const vec3<R> raw = preparedColour<R>(in, o);
    const Window<R> at([&](int i, int j) __attribute__((always_inline)) {
        return toYcocg(preparedColour<R>(in, o + long(j) * in.stride + i));
    });

    // 1
    const Surface<R> surface = closestSurface<R>(in, o, false);
    const Motion<R> motion = surface.motion;
    const Reprojection<R> q = reproject(in, motion, x, y);
    const R hidden = depthClip(a, q, surface.depthView, o);
    const R speed = sqrt(motion.x * motion.x + motion.y * motion.y), fast = saturate(speed * R(T(1 / kFastPx)));

    // 3. as deviations from the centre
    const vec3<R> centre = at(0, 0);
    vec3<R> filtered(zero), m1(zero), m2(zero);
    R around(zero);
    Box<R> bounds{centre, centre};
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            if (i == 0 && j == 0) continue;
            const int n = (j + 1) * 3 + i + 1;
            const vec3<R> c = at(i, j), d = c - centre;
            const R w = mix(R(T(a.still[n])), R(T(a.moving[n])), fast);
            filtered = filtered + d * R(T(a.lanczos[n]));
            bounds.lo = min(bounds.lo, c), bounds.hi = max(bounds.hi, c);
            m1 = m1 + d * w, m2 = m2 + d * d * w;
            around = around + d.x;
        }
    const vec3<R> current = clamp3(centre + filtered, bounds.lo, bounds.hi);
    const vec3<R> mean = centre + m1, sigma = sqrt(max(m2 - m1 * m1, vec3<R>(zero)));
    const vec3<R> reach = sigma * mix(R(T(a.boxScale)), one, max(hidden, fast));
    const Box<R> box{max(bounds.lo, mean - reach), min(bounds.hi, mean + reach)};

    // 2
    const Offsets<R> nearest = nearestOffsets(q, in.stride);
    R lock = fetchRgba<R>(in.history + 4 * o, nearest).a;
    const R luma = centre.x + around * R(T(1) / T(9)), usual = gather<R>(a.previousLuma + o, nearest);
    const R brighter = max(luma, usual), darker = min(luma, usual);
    const auto kept = both(q.inside, either(darker >= brighter * R(T(kLockedLuma)), brighter < R(T(1e-6))));
    lock = select(kept, max(lock - R(T(a.lockDecay)), zero) * (one - hidden), zero);
    if (a.locks)
        lock = select(isRidge<R>([&](int i, int j) __attribute__((always_inline)) { return at(i, j).x; }), one, lock);
    const auto known = both(q.inside, hidden <= R(T(0.5)));
    const R nextUsual = select(known, usual + (luma - usual) * R(T(a.lockDecay)), luma);

    // 4
    const vec3<R> past = fetchLanczos(in.history + 4 * o, in.stride, q), history = toYcocg(past);
    const vec3<R> held = mix(clamp3(history, box.lo, box.hi), history, lock);
    const auto toRgb = [&](vec3<R> c) __attribute__((always_inline)) { return max(fromYcocg(c), vec3<R>(zero)); };
    const R w(T(a.weight));
    R accumulated = one - hidden;
    accumulated = min(accumulated, mix(accumulated, w * R(T(10)), saturate(speed * R(T(10)))));
    accumulated = min(accumulated, mix(accumulated, w, fast));
    const R alpha = max(w / (accumulated + w), R(T(1) - T(in.feedbackCeiling)));
    const vec3<R> mixed = toneMappedMean(toRgb(held), toRgb(current), alpha);
    const vec3<R> result = select(q.inside, mixed, toRgb(current));

    storeBlend(in, x, y, sanitised(result, raw, past), select(finite(lock), lock, zero));
    store(select(finite(nextUsual), nextUsual, zero), a.nextLuma + o);
    if (!in.debug.rejection) return;
    storeDebug(in.debug, o, motion, q.inside, box, held - history, one - alpha);
    store(select(known, zero, select(q.inside, R(T(int(Rejection::disoccluded))), R(T(int(Rejection::outside))))),
          in.debug.rejection + o);
    if (a.debugLock) store(hidden, a.debugDepthClip + o), store(lock, a.debugLock + o);
}
template <class R>
__attribute__((flatten)) void fsr2nRows(const Fsr2nArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.in.width; x += N<R>) {
            if (a.in.history) {
                fsr2nPixel<R>(a, x, y);
                continue;
            }
            const long o = long(y) * a.in.stride + x;
            const vec3<R> colour = preparedColour<R>(a.in, o);
            const R zero(Elem<R>(0)), luma = toYcocg(colour).x;
            storeFirst<R>(a.in, x, y, colour, zero);
            store(select(finite(luma), luma, zero), a.nextLuma + o);
            if (a.debugLock) store(zero, a.debugDepthClip + o), store(zero, a.debugLock + o);
        }
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::Fsr2nKernels, fsr2nKernels) = {AA_WIDE_ROWS(fsr2nScatterRows), AA_WIDE_ROWS(fsr2nRows)};
