// Reprojection in the temporal methods (conventions 7.1): where a pixel was a frame ago, and what the history holds
// there. Include from *.kernel.cpp only.
//
// Reprojection is done in displacements, never in absolute positions: the fraction of q = p - motion is then exact at
// any x, integer motion is an exact shift, and float and double choose the same texels. History is interleaved RGBA
// (one 16-byte load per texel) with a filled border, so a position inside the image needs no clamped taps.
// Comparisons are written so that NaN rejects history (conventions 8).
#pragma once
#include "kernels/ring.h"
#include "methods/temporal/temporal_texels.kernel.h"

namespace AA_ARCH {

// q = p - motion, as displacement from p: whole texels and fraction in [0,1).
template <class R>
struct Reprojection {
    R wholeX, wholeY, fracX, fracY;
    Mask<R> inside;  // 0 <= q.x <= width and 0 <= q.y <= height (closed, conventions 1), false for NaN
};
template <class R>
struct Motion {
    R x, y;  // px, current - previous
};
// Where it is not inside the displacement is 0, so that fetching is always allowed.
template <class R>
AA_INLINE Reprojection<R> displaced(R dx, R dy, Mask<R> inside) {
    const R zero(Elem<R>(0)), sx = select(inside, dx, zero), sy = select(inside, dy, zero);
    Reprojection<R> q;
    q.inside = inside;
    q.wholeX = floor(sx), q.wholeY = floor(sy);
    q.fracX = sx - q.wholeX, q.fracY = sy - q.wholeY;
    return q;
}
// At most a texel and a half beyond the image: there and farther away every tap is its edge (conventions 1).
template <class R>
AA_INLINE Reprojection<R> displacedWithinReach(const TemporalIn& in, R dx, R dy, Mask<R> known, int x, int y) {
    using T = Elem<R>;
    const R fromLeft = R(T(x) + T(2)) + iota<R>(), fromTop(T(y) + T(2));
    return displaced(min(max(dx, -fromLeft), R(T(in.width + 3)) - fromLeft),
                     min(max(dy, -fromTop), R(T(in.height + 3)) - fromTop), known);
}
// With in.clampOutside a position outside the image is as good as one inside, unless nobody knows the motion
// (conventions 9).
template <class R>
AA_INLINE Reprojection<R> reproject(const TemporalIn& in, Motion<R> motion, int x, int y) {
    using T = Elem<R>;
    const R width(T(in.width)), height(T(in.height)), dx = -motion.x, dy = -motion.y;
    if (in.clampOutside)
        return displacedWithinReach(in, dx, dy, both(abs(dx) <= width + width, abs(dy) <= height + height), x, y);
    const R centreX = R(T(x) + T(0.5)) + iota<R>(), centreY(T(y) + T(0.5));
    // Exact in both precisions: the bounds are small multiples of 1/2, the displacement is as stored.
    return displaced(dx, dy,
                     both(both(dx >= -centreX, dx <= width - centreX), both(dy >= -centreY, dy <= height - centreY)));
}
// Pixel offsets from (x, y); products stay in integers: float would lose them above 2^24 pixels.
template <class R>
AA_INLINE Offsets<R> texelOffsets(const Reprojection<R>& q, int stride) {
    Offsets<R> at;
    if constexpr (N<R> == 1) {
        at.k[0] = int(q.wholeY) * stride + int(q.wholeX);
        at.together = true;
    } else {
        using I = typename IntsOf<N<R>>::type;
        const I ix = __builtin_convertvector(q.wholeX.v, I), iy = __builtin_convertvector(q.wholeY.v, I);
        at.set(iy * stride + ix + __builtin_convertvector(iota<R>().v, I));
    }
    return at;
}
// No lane lies between texels: at rest, or moving by whole pixels. Both fetches below then give the texel itself.
template <class R>
AA_INLINE bool allWhole(const Reprojection<R>& q) {
    const R zero(Elem<R>(0));
    return !maskBits<R>(either(q.fracX != zero, q.fracY != zero));
}
template <class R>
AA_INLINE vec3<R> lerpExact(vec3<R> a, vec3<R> b, R f, Mask<R> whole) {  // f = 0: a, whatever b is
    return select(whole, a, a + (b - a) * f);
}
// Bilinear with exact identity at fraction 0; texels of weight 0 cannot spread NaN. `p` is the texel of (x, y).
template <class R>
AA_INLINE Texel<R> fetchBilinear(const float* p, int stride, const Reprojection<R>& q) {
    const Offsets<R> k = texelOffsets(q, stride);
    if (allWhole(q)) return fetchRgba<R>(p, k);
    const Mask<R> wholeX = q.fracX == R(Elem<R>(0)), wholeY = q.fracY == R(Elem<R>(0));
    return withTexels<R>(
        k, [&](const auto& fetch) __attribute__((always_inline)) {
            const auto row = [&](const float* r) __attribute__((always_inline)) {
                const Texel<R> a = fetch(r), b = fetch(r + 4);
                return Texel<R>{lerpExact(a.rgb, b.rgb, q.fracX, wholeX),
                                select(wholeX, a.a, a.a + (b.a - a.a) * q.fracX)};
            };
            const Texel<R> top = row(p), bottom = row(p + 4l * stride);
            return Texel<R>{lerpExact(top.rgb, bottom.rgb, q.fracY, wholeY),
                            select(wholeY, top.a, top.a + (bottom.a - top.a) * q.fracY)};
        });
}
// Catmull-Rom weights of taps -1, 0, 1, 2 (conventions 1).
template <class R>
AA_INLINE void catmullRomWeights(R f, R* w) {
    using T = Elem<R>;
    w[0] = f * (R(T(-0.5)) + f * (R(T(1)) - R(T(0.5)) * f));
    w[1] = R(T(1)) + f * f * (R(T(-2.5)) + R(T(1.5)) * f);
    w[2] = f * (R(T(0.5)) + f * (R(T(2)) - R(T(1.5)) * f));
    w[3] = f * f * (R(T(-0.5)) + R(T(0.5)) * f);
}
// Lanczos-2 by squared distance, without a sine: the polynomial of FSR (public; error below 0.02, zero from 2 on).
template <class R>
AA_INLINE R lanczos2(R distanceSquared) {
    using T = Elem<R>;
    const R x2 = min(distanceSquared, R(T(4))), a = x2 * R(T(0.4)) - R(T(1)), b = x2 * R(T(0.25)) - R(T(1));
    return (a * a * R(T(1.5625)) - R(T(0.5625))) * (b * b);
}
template <class R>
AA_INLINE void lanczosWeights(R f, R* w) {
    using T = Elem<R>;
    const R one(T(1)), two(T(2));
    w[0] = lanczos2((one + f) * (one + f)), w[1] = lanczos2(f * f);
    w[2] = lanczos2((one - f) * (one - f)), w[3] = lanczos2((two - f) * (two - f));
}
// 4x4 taps of weight wx[i] wy[j]; `corners` false drops the four corner taps (the "5-tap" form of GPUs, 12 texels).
// `normalise` divides by the sum of the weights; Catmull-Rom's sixteen sum to 1. `clamped` holds the sum in the range
// of the four central texels against overshoot at fireflies, and >= 0 (conventions 9). Whole motion takes the texel
// itself; beside it, taps of weight 0 are exact because a history is finite (sanitised()).
template <bool corners, bool normalise, class R>
AA_INLINE vec3<R> fetch4x4(const float* p, int stride, const Reprojection<R>& q, const R (&wx)[4], const R (&wy)[4],
                           bool clamped) {
    using T = Elem<R>;
    const Offsets<R> k = texelOffsets(q, stride);
    if (allWhole(q)) return fetchRgba<R>(p, k).rgb;
    const R zero(T(0)), inner = wx[1] + wx[2], all4 = corners ? inner + (wx[0] + wx[3]) : R(T(1));
    return withTexels<R>(
        k, [&](const auto& fetch) __attribute__((always_inline)) {
            vec3<R> sum(zero), lo(zero), hi(zero), own(zero);
            R norm(zero);
#pragma GCC unroll 4
            for (int j = 0; j < 4; j++) {
                const bool outerRow = j == 0 || j == 3;
                const float* r = p + 4l * (j - 1) * stride;
                const vec3<R> t1 = fetch(r).rgb, t2 = fetch(r + 4).rgb;
                vec3<R> line = t1 * wx[1] + t2 * wx[2];
                if (corners || !outerRow) line = line + fetch(r - 4).rgb * wx[0] + fetch(r + 8).rgb * wx[3];
                if (j == 1) lo = min(t1, t2), hi = max(t1, t2), own = t1;
                if (j == 2) lo = min(lo, min(t1, t2)), hi = max(hi, max(t1, t2));
                sum = sum + line * wy[j];
                if constexpr (normalise) norm = norm + (!corners && outerRow ? wy[j] * inner : wy[j] * all4);
            }
            if constexpr (normalise) sum = sum * (R(T(1)) / norm);
            const vec3<R> held = clamped ? max(clamp3(sum, lo, hi), vec3<R>(zero)) : sum;
            return select(both(q.fracX == zero, q.fracY == zero), own, held);
        });
}
template <bool corners, class R>
AA_INLINE vec3<R> fetchCatmullRom(const float* p, int stride, const Reprojection<R>& q, bool clamped = true) {
    R wx[4], wy[4];
    catmullRomWeights(q.fracX, wx);
    catmullRomWeights(q.fracY, wy);
    return fetch4x4<corners, !corners>(p, stride, q, wx, wy, clamped);
}
template <class R>
AA_INLINE vec3<R> fetchLanczos(const float* p, int stride, const Reprojection<R>& q) {
    R wx[4], wy[4];
    lanczosWeights(q.fracX, wx);
    lanczosWeights(q.fracY, wy);
    return fetch4x4<true, true>(p, stride, q, wx, wy, true);
}
template <class R>
AA_INLINE vec3<R> fetchHistory(const TemporalIn& in, int x, int y, const Reprojection<R>& q) {
    const float* p = in.history + 4 * (long(y) * in.stride + x);
    const bool clamped = in.filter == HistoryFilter::catmullRom || in.filter == HistoryFilter::catmullRom5;
    if (in.filter == HistoryFilter::catmullRom || in.filter == HistoryFilter::catmullRomFree)
        return fetchCatmullRom<true>(p, in.stride, q, clamped);
    if (in.filter == HistoryFilter::catmullRom5 || in.filter == HistoryFilter::catmullRom5Free)
        return fetchCatmullRom<false>(p, in.stride, q, clamped);
    return fetchBilinear(p, in.stride, q).rgb;
}
// B(plane, p + offset) with one offset for the whole frame (un-jitter, conventions 7.0: offset = -jitter). A plane of
// float, or of Elem<R>. Offset 0 gives the texel itself.
template <class R>
struct UniformFetch {
    int dx, dy;
    Elem<R> fx, fy;
    bool wholeX, wholeY;
    AA_INLINE UniformFetch(float offsetX, float offsetY) {
        const float wx = floor(offsetX), wy = floor(offsetY);
        dx = int(wx), dy = int(wy), fx = offsetX - wx, fy = offsetY - wy;
        wholeX = fx == 0, wholeY = fy == 0;
    }
    AA_INLINE R operator()(const float* p, int stride) const {
        const float* const top = p + long(dy) * stride + dx;
        return between(
            top, top + stride, [](const float* r) __attribute__((always_inline)) { return load<R>(r); });
    }
    // The same from rows y + dy and y + dy + 1, each at the pixel's x.
    AA_INLINE R operator()(const Elem<R>* upper, const Elem<R>* lower) const {
        return between(
            upper + dx, lower + dx, [](const Elem<R>* r) __attribute__((always_inline)) { return loadOwn<R>(r); });
    }

  private:
    template <class S, class Load>
    AA_INLINE R between(const S* upper, const S* lower, const Load& at) const {
        const auto row = [&](const S* r) __attribute__((always_inline)) {
            const R a = at(r);
            return wholeX ? a : a + (at(r + 1) - a) * R(fx);
        };
        const R top = row(upper);
        return wholeY ? top : top + (row(lower) - top) * R(fy);
    }
};

// The pixel that contains q, as offset from (x, y): for values that must not be interpolated (depth, ids, counts).
template <class R>
AA_INLINE Reprojection<R> nearestPixel(const Reprojection<R>& q) {
    const R half(Elem<R>(0.5)), zero(Elem<R>(0)), one(Elem<R>(1));
    return {q.wholeX + select(q.fracX >= half, one, zero), q.wholeY + select(q.fracY >= half, one, zero), zero, zero,
            q.inside};
}
template <class R>
AA_INLINE Offsets<R> nearestOffsets(const Reprojection<R>& q, int stride) {
    return texelOffsets(nearestPixel(q), stride);
}
// The same for planes without a border: on the picture's right and lower edge its last pixel.
template <class R>
AA_INLINE Offsets<R> nearestOffsetsWithin(const TemporalIn& in, const Reprojection<R>& q, int x, int y) {
    using T = Elem<R>;
    Reprojection<R> pixel = nearestPixel(q);
    pixel.wholeX = min(pixel.wholeX, R(T(in.width - 1 - x)) - iota<R>());
    pixel.wholeY = min(pixel.wholeY, R(T(in.height - 1 - y)));
    return texelOffsets(pixel, in.stride);
}
// Depth that the surface at (x, y) had in the previous camera, if it did not move by itself
// (TemporalIn::expectedDepth).
template <class R>
AA_INLINE R expectedPreviousDepth(const ExpectedDepth& e, R depthView, int x, int y) {
    using T = Elem<R>;
    if (!e.known) return depthView;
    const R px = R(T(x) + T(0.5)) + iota<R>(), py(T(y) + T(0.5));
    const R perDepth = px * R(T(e.perDepth[0])) + py * R(T(e.perDepth[1])) + R(T(e.perDepth[2]));
    const R constant = px * R(T(e.constant[0])) + py * R(T(e.constant[1])) + R(T(e.constant[2]));
    return select(depthView >= R(T(1e9)), depthView, depthView * perDepth + constant);
}

}  // namespace AA_ARCH
