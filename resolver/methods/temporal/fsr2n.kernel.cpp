#include "methods/temporal/fsr2n.h"

#include "kernels/math.h"
#include "kernels/ring.h"
#include "methods/temporal/temporal_blocks.kernel.h"

// Limited by instructions: the scatter and the search for the nearest surface, which both passes need, take a third,
// the window's sums and the history's 16 texels most of the rest.
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

// The prepared colours in YCoCg: what all nine neighbours of a pixel would compute again is computed once. They are of
// a picture that has a row and a column more on each side.
template <class T>
struct Fsr2nRings {
    Ring<T, 4> c[3];
};
template <class R>
AA_INLINE void convertRow(const TemporalIn& in, const Fsr2nRings<Elem<R>>& rings, int y) {
    Elem<R>*const c0 = rings.c[0](y + 1), *const c1 = rings.c[1](y + 1), *const c2 = rings.c[2](y + 1);
    const auto convert = [&](auto one, int x) __attribute__((always_inline)) {
        using S = decltype(one);
        const vec3<S> c = toYcocg(preparedColour<S>(in, long(y) * in.stride + x));
        store(c.x, c0 + x), store(c.y, c1 + x), store(c.z, c2 + x);
    };
    for (int x = 0; x < in.width; x += N<R>) convert(R(Elem<R>(0)), x);
    convert(Elem<R>(0), -1), convert(Elem<R>(0), in.width);
}
// Rows y - 1, y, y + 1 of them.
template <class T>
struct Fsr2nWindow {
    const T* c[3][3];
};

// What one step hands to the next, for N pixels.
template <class R>
struct Fsr2nPixels {
    Surface<R> surface;
    Reprojection<R> q;
    R hidden, speed, luma, lock;
    vec3<R> current, past;
    Box<R> box;
};
template <class R>
struct Fsr2n {
    using T = Elem<R>;
    const Fsr2nArgs& a;
    const Fsr2nWindow<T>& rows;
    int y;
    const TemporalIn& in = a.in;

    AA_INLINE vec3<R> at(int x, int i, int j) const { return loadOwn<R>(rows.c[j + 1], x + i); }
    AA_INLINE long offset(int x) const { return long(y) * in.stride + x; }
    static AA_INLINE R fast(const Fsr2nPixels<R>& p) { return saturate(p.speed * R(T(1 / kFastPx))); }

    // 1
    AA_INLINE void findMotion(Fsr2nPixels<R>& p, int x) const {
        p.surface = closestSurface<R>(in, offset(x), false);
        const Motion<R> motion = p.surface.motion;
        p.q = reproject(in, motion, x, y);
        p.speed = sqrt(motion.x * motion.x + motion.y * motion.y);
    }
    // 3. as deviations from the centre
    AA_INLINE void findBox(Fsr2nPixels<R>& p, int x) const {
        const R moving = fast(p), scale = mix(R(T(a.boxScale)), R(T(1)), max(p.hidden, moving));
        R weight[9];
        eachNeighbour([&](int i, int j) __attribute__((always_inline)) {
            const int n = (j + 1) * 3 + i + 1;
            weight[n] = mix(R(T(a.still[n])), R(T(a.moving[n])), moving);
        });
        vec3<R> current;
        Box<R> box;
        R around(T(0));
        eachChannel([&](auto channel) __attribute__((always_inline)) {
            const R centre = part(at(x, 0, 0), channel);
            R filtered(T(0)), m1(T(0)), m2(T(0)), low = centre, high = centre;
            eachNeighbour([&](int i, int j) __attribute__((always_inline)) {
                const int n = (j + 1) * 3 + i + 1;
                const R c = part(at(x, i, j), channel), d = c - centre;
                filtered = filtered + d * R(T(a.lanczos[n]));
                low = min(low, c), high = max(high, c);
                m1 = m1 + d * weight[n], m2 = m2 + d * d * weight[n];
                if (channel == 0) around = around + d;
            });
            part(current, channel) = clamp(centre + filtered, low, high);
            const R mean = centre + m1, reach = sqrt(max(m2 - m1 * m1, R(T(0)))) * scale;
            part(box.lo, channel) = max(low, mean - reach), part(box.hi, channel) = min(high, mean + reach);
        });
        p.current = current, p.box = box;
        p.luma = at(x, 0, 0).x + around * R(T(1) / T(9));
    }
    // 2
    AA_INLINE void findLock(Fsr2nPixels<R>& p, int x) const {
        const R zero(T(0)), one(T(1));
        const long o = offset(x);
        const Offsets<R> nearest = nearestOffsets(p.q, in.stride);
        R lock = fetchRgba<R>(in.history + 4 * o, nearest).a;
        const R usual = gather<R>(a.previousLuma + o, nearest);
        const R brighter = max(p.luma, usual), darker = min(p.luma, usual);
        const auto kept = both(p.q.inside, either(darker >= brighter * R(T(kLockedLuma)), brighter < R(T(1e-6))));
        lock = select(kept, max(lock - R(T(a.lockDecay)), zero) * (one - p.hidden), zero);
        if (a.locks)
            lock = select(isRidge<R>([&](int i, int j) __attribute__((always_inline)) { return at(x, i, j).x; }), one,
                          lock);
        p.lock = lock;
        const R nextUsual = select(known(p), usual + (p.luma - usual) * R(T(a.lockDecay)), p.luma);
        store(select(finite(nextUsual), nextUsual, zero), a.nextLuma + o);
    }
    static AA_INLINE Mask<R> known(const Fsr2nPixels<R>& p) { return both(p.q.inside, p.hidden <= R(T(0.5))); }
    // 4
    AA_INLINE void blendAndStore(const Fsr2nPixels<R>& p, int x) const {
        const R zero(T(0)), one(T(1));
        const long o = offset(x);
        const vec3<R> history = toYcocg(p.past), held = mix(clamp3(history, p.box.lo, p.box.hi), history, p.lock);
        const auto toRgb = [&](vec3<R> c) __attribute__((always_inline)) { return max(fromYcocg(c), vec3<R>(zero)); };
        const R w(T(a.weight));
        R accumulated = one - p.hidden;
        accumulated = min(accumulated, mix(accumulated, w * R(T(10)), saturate(p.speed * R(T(10)))));
        accumulated = min(accumulated, mix(accumulated, w, fast(p)));
        const R alpha = max(w / (accumulated + w), R(T(1) - T(in.feedbackCeiling)));
        const vec3<R> current = toRgb(p.current);
        const vec3<R> result = select(p.q.inside, toneMappedMean(toRgb(held), current, alpha), current);

        storeBlend(in, x, y, sanitised(result, preparedColour<R>(in, o), p.past), select(finite(p.lock), p.lock, zero));
        if (!in.debug.rejection) return;
        storeDebug(in.debug, o, p.surface.motion, p.q.inside, p.box, held - history, one - alpha);
        const R hiddenOrOutside = select(p.q.inside, R(T(int(Rejection::disoccluded))), R(T(int(Rejection::outside))));
        store(select(known(p), zero, hiddenOrOutside), in.debug.rejection + o);
        if (a.debugLock) store(p.hidden, a.debugDepthClip + o), store(p.lock, a.debugLock + o);
    }
    AA_INLINE void row() const {
        Fsr2nPixels<R> p[kStepGroups];
        inSteps<R>(
            in.width, [&](int i, int x) __attribute__((always_inline)) { findMotion(p[i], x); },
            [&](int i, int x) __attribute__((always_inline)) {
                p[i].hidden = depthClip(a, p[i].q, p[i].surface.depthView, offset(x));
            },
            [&](int i, int x) __attribute__((always_inline)) {
                p[i].past = fetchLanczos(in.history + 4 * offset(x), in.stride, p[i].q);
            },
            [&](int i, int x) __attribute__((always_inline)) { findBox(p[i], x); },
            [&](int i, int x) __attribute__((always_inline)) { findLock(p[i], x); },
            [&](int i, int x) __attribute__((always_inline)) { blendAndStore(p[i], x); });
    }
};
template <class R>
AA_INLINE void firstFrameRow(const Fsr2nArgs& a, int y) {
    for (int x = 0; x < a.in.width; x += N<R>) {
        const long o = long(y) * a.in.stride + x;
        const vec3<R> colour = preparedColour<R>(a.in, o);
        const R zero(Elem<R>(0)), luma = toYcocg(colour).x;
        storeFirst<R>(a.in, x, y, colour, zero);
        store(select(finite(luma), luma, zero), a.nextLuma + o);
        if (a.debugLock) store(zero, a.debugDepthClip + o), store(zero, a.debugLock + o);
    }
}
template <class R>
__attribute__((flatten)) void fsr2nRows(const Fsr2nArgs& a, int y0, int y1) {
    const TemporalIn& in = a.in;
    Fsr2nRings<Elem<R>> rings;
    RingMaker<Elem<R>> maker(a.scratch, in.stride, in.width, in.height + 2);
    for (auto& channel : rings.c) maker.make(channel);
    for (int y = y0 - 2; y < y1; y++) {
        if (!in.history) {
            if (y >= y0) firstFrameRow<R>(a, y);
            continue;
        }
        convertRow<R>(in, rings, y + 1);
        if (y < y0) continue;
        Fsr2nWindow<Elem<R>> window;
        for (int j = 0; j < 3; j++)
            for (int c = 0; c < 3; c++) window.c[j][c] = rings.c[c](y + j);
        Fsr2n<R>{a, window, y}.row();
    }
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::Fsr2nKernels, fsr2nKernels) = {AA_WIDE_ROWS(fsr2nScatterRows), AA_WIDE_ROWS(fsr2nRows)};
