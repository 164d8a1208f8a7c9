// Rejection tests (conventions 7.3), shared by the methods that reject by geometry; include from *.kernel.cpp only.
#pragma once
#include "methods/temporal/temporal_blocks.kernel.h"

namespace AA_ARCH {

// Bilinear depth from the history's alpha. Bilinear over a silhouette invents depths: when the taps differ more than
// tenfold (background), the nearest counts (conventions 9).
template <class R>
AA_INLINE R fetchDepth(const float* p, int stride, const Reprojection<R>& q) {
    using T = Elem<R>;
    const Offsets<R> k = texelOffsets(q, stride);
    const R zero(T(0));
    if (allWhole(q)) {
        const R own = fetchRgba<R>(p, k).a;
        return own + (own - own);  // infinite depths are no numbers, as below
    }
    const auto wholeX = q.fracX == zero, wholeY = q.fracY == zero;
    return withTexels<R>(
        k, [&](const auto& fetch) __attribute__((always_inline)) {
            const R a = fetch(p).a;
            const R b = select(wholeX, a, fetch(p + 4).a);
            const R c = select(wholeY, a, fetch(p + 4l * stride).a);
            const R d = select(wholeY, b, select(wholeX, c, fetch(p + 4l * stride + 4).a));
            const R nearest = min(min(a, b), min(c, d)), farthest = max(max(a, b), max(c, d));
            const R top = a + (b - a) * q.fracX, bottom = c + (d - c) * q.fracX;
            return select(farthest > nearest * R(T(10)), nearest, top + (bottom - top) * q.fracY);
        });
}
// True where the surface was hidden: it should have been at `expected`, something nearer by more than `tolerance` times
// that was there. NaN is hidden.
template <class R>
AA_INLINE Mask<R> disoccluded(R expected, R found, float tolerance, bool bothSides) {
    const R difference = expected - found, limit = expected * R(Elem<R>(tolerance));
    return negate(bothSides ? abs(difference) <= limit : difference <= limit);
}
// Change of the motion to the next pixel along x and along y; in the last column and row, beyond which the motion is
// repeated, from the pixel before.
template <class R>
struct MotionSlope {
    Motion<R> alongX, alongY;
};
template <class R>
AA_INLINE MotionSlope<R> motionSlope(const TemporalIn& in, int x, int y) {
    using T = Elem<R>;
    const long o = long(y) * in.stride + x, below = y + 1 < in.height ? in.stride : 0;
    const auto change = [&](long from, long to) __attribute__((always_inline)) {
        const Motion<R> a = loadMotion<R>(in, o + from), b = loadMotion<R>(in, o + to);
        return Motion<R>{b.x - a.x, b.y - a.y};
    };
    MotionSlope<R> slope{change(0, 1), change(below - in.stride, below)};
    if (x + N<R> >= in.width) {
        const Motion<R> before = change(-1, 0);
        const auto last = R(T(x)) + iota<R>() == R(T(in.width - 1));
        slope.alongX.x = select(last, before.x, slope.alongX.x);
        slope.alongX.y = select(last, before.y, slope.alongX.y);
    }
    return slope;
}
// Pixels that one pixel covered `age` frames ago, the longer way along each axis.
template <class R>
struct Footprint {
    R x, y;
};
template <class R>
AA_INLINE Footprint<R> footprint(const MotionSlope<R>& slope, R age) {
    const R one(Elem<R>(1));
    return {max(abs(one - slope.alongX.x * age), abs(slope.alongY.x * age)),
            max(abs(slope.alongX.y * age), abs(one - slope.alongY.y * age))};
}
// True where a pixel covers less than a previous pixel and q is far from that pixel's centre: reading would enlarge one
// sample ([Stejmar n.d., 3.6.2]; distances to centres and absolute derivatives: decisions 18).
template <class R>
AA_INLINE Mask<R> magnified(const Reprojection<R>& q, const Footprint<R>& covered, float scale) {
    using T = Elem<R>;
    const R one(T(1));
    const R distanceX = min(q.fracX, one - q.fracX), distanceY = min(q.fracY, one - q.fracY);
    return either(negate(distanceX <= covered.x * R(T(scale))), negate(distanceY <= covered.y * R(T(scale))));
}
// Lane mask of pixels whose id is nowhere in the previous 3x3 around q. The window is searched only where q's own pixel
// shows another object.
template <class R>
AA_INLINE Mask<R> idLost(const uint32_t* ids, const uint32_t* previous, int stride, const Offsets<R>& nearest) {
    if (nearest.together) {
        const Mask<R> elsewhere = idsDiffer<R>(ids, previous + nearest.k[0]);
        if (!maskBits<R>(elsewhere)) return elsewhere;
    }
    const auto lostAt = [&](int lane) {
        const uint32_t* p = previous + nearest.k[lane];
        const uint32_t id = ids[lane];
        if (*p == id) return false;
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++)
                if (p[long(j) * stride + i] == id) return false;
        return true;
    };
    if constexpr (N<R> == 1)
        return lostAt(0);
    else {
        Mask<R> m{};
        for (int i = 0; i < N<R>; i++) m[i] = lostAt(i) ? -1 : 0;
        return m;
    }
}

}  // namespace AA_ARCH
