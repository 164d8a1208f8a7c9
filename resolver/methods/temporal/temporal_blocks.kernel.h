// The shared steps of every temporal method (conventions 7.2 to 7.9), as small pure functions over R; reprojection lies
// in temporal_reprojection.kernel.h. Include from *.kernel.cpp only.
#pragma once
#include "methods/temporal/temporal_options.kernel.h"
#include "methods/temporal/temporal_reprojection.kernel.h"

namespace AA_ARCH {

// ---- dilation (conventions 7.2) -------------------------------------------------------------------------------------
template <class R>
AA_INLINE Motion<R> loadMotion(const TemporalIn& in, long o) {
    return {load<R>(in.motionXPx + o), load<R>(in.motionYPx + o)};
}
// The surface nearest to the camera in 3x3, or of the centre and the diagonals alone. The centre wins ties, otherwise
// the first in row-major order (conventions 3).
template <class R>
struct Surface {
    R depthView;
    Motion<R> motion;
};
template <class R>
AA_INLINE Surface<R> closestSurface(const TemporalIn& in, long o, bool diagonalsOnly) {
    Surface<R> best{load<R>(in.depthView + o), loadMotion<R>(in, o)};
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            if ((i == 0 && j == 0) || (diagonalsOnly && (i == 0 || j == 0))) continue;
            const long n = o + long(j) * in.stride + i;
            const R z = load<R>(in.depthView + n);
            const auto nearer = z < best.depthView;
            best.depthView = select(nearer, z, best.depthView);
            best.motion.x = select(nearer, load<R>(in.motionXPx + n), best.motion.x);
            best.motion.y = select(nearer, load<R>(in.motionYPx + n), best.motion.y);
        }
    return best;
}
template <class R>
AA_INLINE Motion<R> dilatedMotion(const TemporalIn& in, long o) {
    if (in.dilation == Dilation::closest3x3) return closestSurface<R>(in, o, false).motion;
    if (in.dilation == Dilation::closestX) return closestSurface<R>(in, o, true).motion;
    Motion<R> best = loadMotion<R>(in, o);
    if (in.dilation == Dilation::longest3x3) {
        R longest = best.x * best.x + best.y * best.y;
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++) {
                if (i == 0 && j == 0) continue;
                const Motion<R> m = loadMotion<R>(in, o + long(j) * in.stride + i);
                const R length = m.x * m.x + m.y * m.y;
                const auto longer = length > longest;
                longest = select(longer, length, longest);
                best.x = select(longer, m.x, best.x);
                best.y = select(longer, m.y, best.y);
            }
    }
    return best;
}

// Of the surface that dilatedMotion() takes by its depth; otherwise the pixel's own.
template <class R>
AA_INLINE R dilatedDepth(const TemporalIn& in, long o) {
    if (in.dilation == Dilation::closest3x3) return closestSurface<R>(in, o, false).depthView;
    if (in.dilation == Dilation::closestX) return closestSurface<R>(in, o, true).depthView;
    return load<R>(in.depthView + o);
}

// The nine colours around a pixel, loaded (and converted) once; at(i, j) as the functions below take it.
template <class R>
struct Window {
    vec3<R> color[9];
    template <class Load>
    AA_INLINE explicit Window(const Load& load) {
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++) color[(j + 1) * 3 + i + 1] = load(i, j);
    }
    AA_INLINE vec3<R> operator()(int i, int j) const { return color[(j + 1) * 3 + i + 1]; }
};

// ---- neighbourhoods (conventions 7.4) -------------------------------------------------------------------------------
template <class R>
struct Box {
    vec3<R> lo, hi;
};
template <class R>
struct Range {  // of one channel
    R lo, hi;
};
// `at(i, j)` is the colour of the neighbour (x + i, y + j); combine(channel, plus, square) makes the box's range from
// those of the 3x3 window and of its plus-shaped part.
template <class R, class At, class Combine>
AA_INLINE Box<R> windowBox(const At& at, const Combine& combine) {
    Box<R> box;
    eachChannel([&](auto channel) __attribute__((always_inline)) {
        const auto v = [&](int i, int j) __attribute__((always_inline)) { return part(at(i, j), channel); };
        const R c = v(0, 0), w = v(-1, 0), e = v(1, 0), n = v(0, -1), s = v(0, 1);
        const Range<R> plus{min(min(min(c, w), min(e, n)), s), max(max(max(c, w), max(e, n)), s)};
        const R nw = v(-1, -1), ne = v(1, -1), sw = v(-1, 1), se = v(1, 1);
        const Range<R> square{min(plus.lo, min(min(nw, ne), min(sw, se))), max(plus.hi, max(max(nw, ne), max(sw, se)))};
        const Range<R> range = combine(channel, plus, square);
        part(box.lo, channel) = range.lo, part(box.hi, channel) = range.hi;
    });
    return box;
}
// "Rounded": the mean of both windows' bounds [Pedersen 2016].
template <class R, class At>
AA_INLINE Box<R> neighbourBox(const At& at, Neighbourhood kind) {
    return windowBox<R>(
        at, [&](auto, Range<R> plus, Range<R> square) __attribute__((always_inline)) {
            const R half(Elem<R>(0.5));
            if (kind == Neighbourhood::box3x3) return square;
            if (kind == Neighbourhood::plus) return plus;
            return Range<R>{(square.lo + plus.lo) * half, (square.hi + plus.hi) * half};
        });
}
template <class R>
struct NeighbourMeans {
    vec3<R> square, plus;
};
// Means as deviations from the centre: a constant window has exactly its value.
template <class R, class At>
AA_INLINE NeighbourMeans<R> neighbourMeans(const At& at) {
    using T = Elem<R>;
    const vec3<R> c = at(0, 0);
    const vec3<R> around = (at(-1, 0) - c) + (at(1, 0) - c) + ((at(0, -1) - c) + (at(0, 1) - c));
    const vec3<R> corners = (at(-1, -1) - c) + (at(1, -1) - c) + ((at(-1, 1) - c) + (at(1, 1) - c));
    return {c + (around + corners) * R(T(1) / T(9)), c + around * R(T(1) / T(5))};
}
template <class R>
AA_INLINE vec3<R> meanOf(const NeighbourMeans<R>& m, Neighbourhood kind) {
    if (kind == Neighbourhood::box3x3) return m.square;
    if (kind == Neighbourhood::plus) return m.plus;
    return (m.square + m.plus) * R(Elem<R>(0.5));
}

// ---- constraints (conventions 7.5, 7.6) -----------------------------------------------------------------------------
// The smallest of three ratios n_k / d_k >= 0 by cross multiplication: one division, where the processor has few. n > 0
// over 0 is infinite, as it should be; 0 over 0 is the caller's to avoid. Exact up to rounding while the products stay
// finite (colours below 1e18).
template <class R>
AA_INLINE R leastRatio(vec3<R> n, vec3<R> d) {
    const auto xy = n.x * d.y <= n.y * d.x;
    const R nxy = select(xy, n.x, n.y), dxy = select(xy, d.x, d.y);
    const auto xyz = nxy * d.z <= n.z * dxy;
    return select(xyz, nxy, n.z) / select(xyz, dxy, d.z);
}
// Clip toward the box centre [Pedersen 2016]: h moves on the line to the centre until it meets the box's surface.
template <class R>
AA_INLINE vec3<R> clipToCentre(Box<R> box, vec3<R> h) {
    using T = Elem<R>;
    const R half(T(0.5));
    // Scaled floor: with an absolute 1e-8 a flat bright box would divide rounding noise by almost nothing
    // (conventions 9).
    const R floorExtent = max(R(T(1e-8)), maxComponent(abs(box.hi)) * R(T(1e-6)));
    const vec3<R> centre = (box.lo + box.hi) * half, extent = (box.hi - box.lo) * half + vec3<R>(floorExtent);
    const vec3<R> offset = h - centre;
    const R t = leastRatio(extent, abs(offset));  // infinite at the centre
    return select(t < R(T(1)), centre + offset * t, h);
}
// Exact line clip toward a point r of the box.
template <class R>
AA_INLINE vec3<R> clipToward(Box<R> box, vec3<R> r, vec3<R> h) {
    const R zero(Elem<R>(0)), one(Elem<R>(1));
    r = clamp3(r, box.lo, box.hi);
    // Share of the way from r to h that each channel allows: (bound - r) / (h - r) outside, 1 inside.
    const vec3<R> way = h - r, room = clamp3(h, box.lo, box.hi) - r;
    const auto allowed = [&](R part, R whole) { return select(whole == zero, one, abs(part)); };
    const R t = leastRatio(vec3<R>{allowed(room.x, way.x), allowed(room.y, way.y), allowed(room.z, way.z)}, abs(way));
    return select(t < one, r + way * t, h);
}
// `mean()` is computed where it is the target only: it costs as much as the box.
template <class R, class Mean>
AA_INLINE vec3<R> constrain(Box<R> box, ClipTarget target, const Mean& mean, vec3<R> current, vec3<R> h) {
    if (target == ClipTarget::mean) return clipToward(box, mean(), h);
    if (target == ClipTarget::current) return clipToward(box, current, h);
    if (target == ClipTarget::clamp) return clamp3(h, box.lo, box.hi);
    return clipToCentre(box, h);
}

// ---- variance box (conventions 7.7) ---------------------------------------------------------------------------------
template <class R>
struct Moments {
    vec3<R> mean, sigma;
};
// Calls visit(i, j) for the eight neighbours of a pixel, in row-major order.
template <class Visit>
AA_INLINE void eachNeighbour(const Visit& visit) {
#pragma GCC unroll 3
    for (int j = -1; j <= 1; j++)
#pragma GCC unroll 3
        for (int i = -1; i <= 1; i++)
            if (i || j) visit(i, j);
}
// Moments of the 3x3 window about its centre colour: E[x^2] - mean^2 loses all digits of bright windows
// (conventions 9). `also(channel, i, j, v, d)` sees every neighbour's value v and its deviation d from the centre on
// the way.
template <class R, class At, class Also>
AA_INLINE Moments<R> moments(const At& at, const Also& also) {
    using T = Elem<R>;
    Moments<R> m;
    eachChannel([&](auto channel) __attribute__((always_inline)) {
        const R c = part(at(0, 0), channel), ninth(T(1) / T(9));
        R m1(T(0)), m2(T(0));
        eachNeighbour([&](int i, int j) __attribute__((always_inline)) {
            const R v = part(at(i, j), channel), d = v - c;
            m1 = m1 + d;
            m2 = m2 + d * d;
            also(channel, i, j, v, d);
        });
        const R shift = m1 * ninth;
        part(m.mean, channel) = c + shift;
        part(m.sigma, channel) = sqrt(max(m2 * ninth - shift * shift, R(T(0))));
    });
    return m;
}
template <class R, class At>
AA_INLINE Moments<R> moments(const At& at) {
    return moments<R>(at, [](auto, int, int, R, R) __attribute__((always_inline)){});
}
template <class R>
AA_INLINE Box<R> varianceBox(const Moments<R>& m, float gamma) {
    const vec3<R> e = m.sigma * R(Elem<R>(gamma));
    return {m.mean - e, m.mean + e};
}

// ---- feedback and blends (conventions 7.8, 7.9) ---------------------------------------------------------------------
// Weight of history from the relative luminance difference ([Pedersen 2016], after T. Lottes).
template <class R>
AA_INLINE R luminanceFeedback(R current, R history, float kMin, float kMax) {
    using T = Elem<R>;
    const R d = min(abs(current - history) / max(max(current, history), R(T(0.2))), R(T(1)));
    const R u = R(T(1)) - d;
    return R(T(kMin)) + R(T(kMax) - T(kMin)) * (u * u);
}
// history + (current - history) * (1 - k): k = 0 and k = 1 are exact (conventions 11).
template <class R>
AA_INLINE vec3<R> blend(vec3<R> current, vec3<R> history, R k) {
    const R zero(Elem<R>(0)), one(Elem<R>(1));
    const vec3<R> mixed = history + (current - history) * (one - k);
    return select(k == zero, current, select(k == one, history, mixed));
}
// Each colour weighted by 1 / (1 + luminance), against fireflies [Karis 2014].
template <class R>
AA_INLINE vec3<R> inverseLuminanceBlend(vec3<R> current, R luminanceCurrent, vec3<R> history, R luminanceHistory, R k) {
    using T = Elem<R>;
    const R zero(T(0)), one(T(1));
    // (1 - k) / (1 + Lc) against k / (1 + Lh), both times (1 + Lc) (1 + Lh): one division, and k = 0, 1 stay exact.
    const R wc = (one - k) * (one + max(zero, luminanceHistory)), wh = k * (one + max(zero, luminanceCurrent));
    return blend(current, history, wh / (wc + wh));
}

// ---- history --------------------------------------------------------------------------------------------------------
// A non-finite blend becomes the current colour, that of a broken current pixel its history (finite by induction): one
// bad value must not live in the history for ever (conventions 11).
template <class R>
AA_INLINE vec3<R> sanitised(vec3<R> blended, vec3<R> current, vec3<R> history) {
    const Mask<R> good = finite(blended);
    if (!maskBits<R>(negate(good))) return blended;
    const vec3<R> fallback = select(finite(current), current, select(finite(history), history, vec3<R>(R(Elem<R>(0)))));
    return select(good, blended, fallback);
}
template <class R>
AA_INLINE void storeBlend(const TemporalIn& in, int x, int y, vec3<R> result, R alpha) {
    const long o = long(y) * in.stride + x;
    storeRgba(result, alpha, in.next + 4 * o);
    if (in.out.c[0]) store3(result, in.out.c, o);
}
// The first frame after a reset: the current colour.
template <class R>
AA_INLINE void storeFirstDebug(const TemporalIn& in, long o, vec3<R> current) {
    const TemporalDebug& d = in.debug;
    if (!d.rejection) return;
    const R zero(Elem<R>(0));
    store(R(Elem<R>(int(Rejection::firstFrame))), d.rejection + o);
    if (!d.feedback) return;
    const Motion<R> motion = loadMotion<R>(in, o);
    store(motion.x, d.motionXPx + o), store(motion.y, d.motionYPx + o);
    store3(current, d.boxLow, o), store3(current, d.boxHigh, o);
    store(zero, d.clipAmount + o), store(zero, d.feedback + o);
}
template <class R>
AA_INLINE void storeFirst(const TemporalIn& in, int x, int y, vec3<R> current, R alpha) {
    storeBlend(in, x, y, sanitised(current, current, vec3<R>(R(Elem<R>(0)))), alpha);
    storeFirstDebug(in, long(y) * in.stride + x, current);
}
template <class R>
AA_INLINE void storeFirst(const TemporalIn& in, int x, int y) {
    storeFirst<R>(in, x, y, load3<R>(in.color.c, long(y) * in.stride + x), R(Elem<R>(1)));
}
template <class R>
AA_INLINE void storeDebug(const TemporalDebug& d, long o, Motion<R> motion, Mask<R> inside, const Box<R>& box,
                          vec3<R> moved, R k) {
    if (!d.rejection) return;
    using T = Elem<R>;
    store(select(inside, R(T(0)), R(T(int(Rejection::outside)))), d.rejection + o);
    if (!d.feedback) return;
    store(motion.x, d.motionXPx + o), store(motion.y, d.motionYPx + o);
    store3(box.lo, d.boxLow, o), store3(box.hi, d.boxHigh, o);
    store(maxComponent(abs(moved)), d.clipAmount + o);
    store(select(inside, k, R(T(0))), d.feedback + o);
}

}  // namespace AA_ARCH
