// The shared steps of every temporal method (methods/06 s.6.0, B1-B9), as small pure functions over R.
// Include from *.kernel.cpp only.
//
// Reprojection is done in displacements, never in absolute positions: the fraction of q = p - motion is then exact at
// any x, integer motion is an exact shift, and float and double choose the same texels. History is interleaved RGBA
// (one 16-byte load per texel) with a filled border, so a position inside the image needs no clamped taps.
// Comparisons are written so that NaN rejects history (methods/08 s.8.0).
#pragma once
#include "kernels/lanes.h"
#include "methods/temporal_kernels.h"

namespace AA_ARCH {
using namespace aa;

// ---- texels ---------------------------------------------------------------------------------------------------------
template <class R>
struct Texel {
    vec3<R> rgb;
    R a;
};

// W texels of an RGBA image at pixel offsets k[i]; see fetch_rgb in lanes.h.
template <class R>
AA_INLINE Texel<R> fetch_rgba(const float* p, const int* k) {
    if constexpr (N<R> == 1) {
        const float* t = p + 4l * k[0];
        return {{R(t[0]), R(t[1]), R(t[2])}, R(t[3])};
    }
#ifdef __AVX2__
    else if constexpr (std::is_same_v<R, Lanes<float, 8>>) {
        auto pair = [&](int i, int j) __attribute__((always_inline)) {
            return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(p + 4l * k[i])),
                                        _mm_loadu_ps(p + 4l * k[j]), 1);
        };
        const __m256 t04 = pair(0, 4), t15 = pair(1, 5), t26 = pair(2, 6), t37 = pair(3, 7);
        const __m256 xy01 = _mm256_unpacklo_ps(t04, t15), xy23 = _mm256_unpacklo_ps(t26, t37),
                     zw01 = _mm256_unpackhi_ps(t04, t15), zw23 = _mm256_unpackhi_ps(t26, t37);
        using V = typename R::V;
        return {{(V)_mm256_shuffle_ps(xy01, xy23, 0x44), (V)_mm256_shuffle_ps(xy01, xy23, 0xEE),
                 (V)_mm256_shuffle_ps(zw01, zw23, 0x44)},
                (V)_mm256_shuffle_ps(zw01, zw23, 0xEE)};
    }
#endif
    else if constexpr (std::is_same_v<R, Lanes<float, 4>>) {
        const __m128 t0 = _mm_loadu_ps(p + 4l * k[0]), t1 = _mm_loadu_ps(p + 4l * k[1]),
                     t2 = _mm_loadu_ps(p + 4l * k[2]), t3 = _mm_loadu_ps(p + 4l * k[3]);
        const __m128 xy01 = _mm_unpacklo_ps(t0, t1), xy23 = _mm_unpacklo_ps(t2, t3), zw01 = _mm_unpackhi_ps(t0, t1),
                     zw23 = _mm_unpackhi_ps(t2, t3);
        using V = typename R::V;
        return {{(V)_mm_movelh_ps(xy01, xy23), (V)_mm_movehl_ps(xy23, xy01), (V)_mm_movelh_ps(zw01, zw23)},
                (V)_mm_movehl_ps(zw23, zw01)};
    } else {
        Texel<R> r;
        for (int i = 0; i < N<R>; i++) {
            const float* t = p + 4l * k[i];
            r.rgb.x.v[i] = t[0], r.rgb.y.v[i] = t[1], r.rgb.z.v[i] = t[2], r.a.v[i] = t[3];
        }
        return r;
    }
}
// W consecutive texels.
template <class R>
AA_INLINE void store_rgba(vec3<R> c, R a, float* p) {
    if constexpr (N<R> == 1) {
        p[0] = float(c.x), p[1] = float(c.y), p[2] = float(c.z), p[3] = float(a);
    }
#ifdef __AVX2__
    else if constexpr (std::is_same_v<R, Lanes<float, 8>>) {
        const __m256 x = (__m256)c.x.v, y = (__m256)c.y.v, z = (__m256)c.z.v, w = (__m256)a.v;
        const __m256 xyl = _mm256_unpacklo_ps(x, y), xyh = _mm256_unpackhi_ps(x, y), zwl = _mm256_unpacklo_ps(z, w),
                     zwh = _mm256_unpackhi_ps(z, w);
        const __m256 t04 = _mm256_shuffle_ps(xyl, zwl, 0x44), t15 = _mm256_shuffle_ps(xyl, zwl, 0xEE),
                     t26 = _mm256_shuffle_ps(xyh, zwh, 0x44), t37 = _mm256_shuffle_ps(xyh, zwh, 0xEE);
        _mm256_storeu_ps(p, _mm256_permute2f128_ps(t04, t15, 0x20));
        _mm256_storeu_ps(p + 8, _mm256_permute2f128_ps(t26, t37, 0x20));
        _mm256_storeu_ps(p + 16, _mm256_permute2f128_ps(t04, t15, 0x31));
        _mm256_storeu_ps(p + 24, _mm256_permute2f128_ps(t26, t37, 0x31));
    }
#endif
    else if constexpr (std::is_same_v<R, Lanes<float, 4>>) {
        const __m128 x = (__m128)c.x.v, y = (__m128)c.y.v, z = (__m128)c.z.v, w = (__m128)a.v;
        const __m128 xyl = _mm_unpacklo_ps(x, y), xyh = _mm_unpackhi_ps(x, y), zwl = _mm_unpacklo_ps(z, w),
                     zwh = _mm_unpackhi_ps(z, w);
        _mm_storeu_ps(p, _mm_movelh_ps(xyl, zwl));
        _mm_storeu_ps(p + 4, _mm_movehl_ps(zwl, xyl));
        _mm_storeu_ps(p + 8, _mm_movelh_ps(xyh, zwh));
        _mm_storeu_ps(p + 12, _mm_movehl_ps(zwh, xyh));
    } else
        for (int i = 0; i < N<R>; i++) {
            p[4 * i] = float(c.x.v[i]), p[4 * i + 1] = float(c.y.v[i]), p[4 * i + 2] = float(c.z.v[i]);
            p[4 * i + 3] = float(a.v[i]);
        }
}
template <class R>
AA_INLINE vec3<R> load3(const float* const (&c)[3], long offset) {
    return {load<R>(c[0] + offset), load<R>(c[1] + offset), load<R>(c[2] + offset)};
}
template <class R>
AA_INLINE void store3(vec3<R> v, float* const (&c)[3], long offset) {
    store(v.x, c[0] + offset), store(v.y, c[1] + offset), store(v.z, c[2] + offset);
}
template <class R>
AA_INLINE Mask<R> all(bool value) {
    return value ? R(Elem<R>(0)) == R(Elem<R>(0)) : R(Elem<R>(0)) != R(Elem<R>(0));
}
// x - x is NaN for NaN and for both infinities.
template <class R>
AA_INLINE Mask<R> finite(R x) {
    return x - x == R(Elem<R>(0));
}
template <class R>
AA_INLINE Mask<R> finite(vec3<R> c) {
    return finite(c.x - c.x + (c.y - c.y) + (c.z - c.z));
}
template <class R>
AA_INLINE vec3<R> clamp3(vec3<R> c, vec3<R> lo, vec3<R> hi) {
    return min(max(c, lo), hi);
}

// Y, Co, Cg (methods/00 s.4). The inverse does not clamp.
template <class R>
AA_INLINE vec3<R> to_ycocg(vec3<R> c) {
    using T = Elem<R>;
    const R half(T(0.5)), quarter(T(0.25)), rb = (c.x + c.z) * quarter;
    return {rb + c.y * half, (c.x - c.z) * half, c.y * half - rb};
}
template <class R>
AA_INLINE vec3<R> from_ycocg(vec3<R> c) {
    const R t = c.x - c.z;
    return {t + c.y, c.x + c.z, t - c.y};
}
template <class R>
AA_INLINE R luminance(vec3<R> c, bool bt601) {
    return bt601 ? luma601(c) : luma709(c);
}

// ---- B1 reprojection ------------------------------------------------------------------------------------------------
// q = p - motion, as displacement from p: whole texels and fraction in [0,1).
template <class R>
struct Reprojection {
    R wholeX, wholeY, fracX, fracY;
    Mask<R> inside;  // 0 <= q.x <= width and 0 <= q.y <= height (closed, methods/00 s.1), false for NaN
};
template <class R>
struct Motion {
    R x, y;  // px, current - previous
};
// Outside the image the displacement is 0, so that fetching is always allowed; with in.clampOutside the position is
// moved to the border instead and only NaN is outside.
template <class R>
AA_INLINE Reprojection<R> reproject(const TemporalIn& in, Motion<R> motion, int x, int y) {
    using T = Elem<R>;
    const int width = in.width, height = in.height;
    const R centreX = R(T(x) + T(0.5)) + iota<R>(), centreY(T(y) + T(0.5));
    R dx = -motion.x, dy = -motion.y;
    if (in.clampOutside) {
        dx = select(dx == dx, min(max(dx, -centreX), R(T(width)) - centreX), dx);
        dy = select(dy == dy, min(max(dy, -centreY), R(T(height)) - centreY), dy);
    }
    Reprojection<R> q;
    // Exact in both precisions: the bounds are small multiples of 1/2, the displacement is as stored.
    q.inside =
        both(both(dx >= -centreX, dx <= R(T(width)) - centreX), both(dy >= -centreY, dy <= R(T(height)) - centreY));
    const R zero(T(0)), sx = select(q.inside, dx, zero), sy = select(q.inside, dy, zero);
    q.wholeX = floor(sx), q.wholeY = floor(sy);
    q.fracX = sx - q.wholeX, q.fracY = sy - q.wholeY;
    return q;
}
// Integer pixel offsets from (x, y); products stay in integers: float would lose them above 2^24 pixels.
template <class R>
AA_INLINE void texel_offsets(const Reprojection<R>& q, int stride, int* k) {
    if constexpr (N<R> == 1) {
        k[0] = int(q.wholeY) * stride + int(q.wholeX);
    } else if constexpr (std::is_same_v<Elem<R>, float>) {
        using I = typename ints_of<N<R>>::type;
        const I ix = __builtin_convertvector(q.wholeX.v, I), iy = __builtin_convertvector(q.wholeY.v, I);
        const I lane = __builtin_convertvector(iota<R>().v, I);
        *(typename ints_of<N<R>>::unaligned*)k = iy * stride + ix + lane;
    } else
        for (int i = 0; i < N<R>; i++) k[i] = int(q.wholeY.v[i]) * stride + int(q.wholeX.v[i]) + i;
}
template <class R>
AA_INLINE vec3<R> lerp_exact(vec3<R> a, vec3<R> b, R f, Mask<R> whole) {  // f = 0: a, whatever b is
    return select(whole, a, a + (b - a) * f);
}
// Bilinear with exact identity at fraction 0; texels of weight 0 cannot spread NaN. `p` is the texel of (x, y).
template <class R>
AA_INLINE Texel<R> fetch_bilinear(const float* p, int stride, const Reprojection<R>& q) {
    alignas(64) int k[N<R>];
    texel_offsets(q, stride, k);
    const Mask<R> wholeX = q.fracX == R(Elem<R>(0)), wholeY = q.fracY == R(Elem<R>(0));
    auto row = [&](const float* r) __attribute__((always_inline)) {
        const Texel<R> a = fetch_rgba<R>(r, k), b = fetch_rgba<R>(r + 4, k);
        return Texel<R>{lerp_exact(a.rgb, b.rgb, q.fracX, wholeX), select(wholeX, a.a, a.a + (b.a - a.a) * q.fracX)};
    };
    const Texel<R> top = row(p), bottom = row(p + 4l * stride);
    return {lerp_exact(top.rgb, bottom.rgb, q.fracY, wholeY),
            select(wholeY, top.a, top.a + (bottom.a - top.a) * q.fracY)};
}
// Catmull-Rom weights of taps -1, 0, 1, 2 (methods/00 s.1).
template <class R>
AA_INLINE void catmull_rom_weights(R f, R* w) {
    using T = Elem<R>;
    w[0] = f * (R(T(-0.5)) + f * (R(T(1)) - R(T(0.5)) * f));
    w[1] = R(T(1)) + f * f * (R(T(-2.5)) + R(T(1.5)) * f);
    w[2] = f * (R(T(0.5)) + f * (R(T(2)) - R(T(1.5)) * f));
    w[3] = f * f * (R(T(-0.5)) + R(T(0.5)) * f);
}
// 16 taps; `corners` false drops the four corner taps and renormalises (the "5-tap" form of GPUs, 12 texels).
// Held in the range of the four central texels against overshoot at fireflies, and >= 0 (methods/08 s.8.1).
template <bool corners, class R>
AA_INLINE vec3<R> fetch_catmull_rom(const float* p, int stride, const Reprojection<R>& q) {
    using T = Elem<R>;
    alignas(64) int k[N<R>];
    texel_offsets(q, stride, k);
    R wx[4], wy[4];
    catmull_rom_weights(q.fracX, wx);
    catmull_rom_weights(q.fracY, wy);
    const R zero(T(0));
    const Mask<R> wholeX = q.fracX == zero, wholeY = q.fracY == zero;
    vec3<R> sum(zero), lo(zero), hi(zero), whole(zero);
    const R inner = wx[1] + wx[2];
    R norm(zero);
    for (int j = 0; j < 4; j++) {
        const bool outerRow = j == 0 || j == 3;
        const float* r = p + 4l * (j - 1) * stride;
        const vec3<R> t1 = fetch_rgba<R>(r, k).rgb, t2 = fetch_rgba<R>(r + 4, k).rgb;
        vec3<R> line = t1 * wx[1] + t2 * wx[2];
        if (corners || !outerRow) {
            line = line + fetch_rgba<R>(r - 4, k).rgb * wx[0] + fetch_rgba<R>(r + 8, k).rgb * wx[3];
            norm = norm + wy[j];
        } else
            norm = norm + wy[j] * inner;
        line = select(wholeX, t1, line);
        if (j == 1) lo = min(t1, t2), hi = max(t1, t2), whole = line;
        if (j == 2) lo = min(lo, min(t1, t2)), hi = max(hi, max(t1, t2));
        sum = sum + line * wy[j];
    }
    if constexpr (!corners) sum = sum / norm;
    const vec3<R> held = max(clamp3(sum, lo, hi), vec3<R>(zero));
    return select(wholeY, whole, held);
}
template <class R>
AA_INLINE vec3<R> fetch_history(const TemporalIn& in, int x, int y, const Reprojection<R>& q) {
    const float* p = in.history + 4 * (long(y) * in.stride + x);
    if (in.filter == HistoryFilter::catmullRom) return fetch_catmull_rom<true>(p, in.stride, q);
    if (in.filter == HistoryFilter::catmullRom5) return fetch_catmull_rom<false>(p, in.stride, q);
    return fetch_bilinear(p, in.stride, q).rgb;
}
// B(plane, p + offset) with one offset for the whole frame (un-jittering: offset = -jitter).
template <class R>
struct UniformFetch {
    int dx, dy;
    Elem<R> fx, fy;
    AA_INLINE UniformFetch(float offsetX, float offsetY) {
        const float wx = floor(offsetX), wy = floor(offsetY);
        dx = int(wx), dy = int(wy), fx = offsetX - wx, fy = offsetY - wy;
    }
    AA_INLINE R operator()(const float* p, int stride) const {
        const float* t = p + long(dy) * stride + dx;
        auto row = [&](const float* r) __attribute__((always_inline)) {
            const R a = load<R>(r);
            return fx == 0 ? a : a + (load<R>(r + 1) - a) * R(fx);
        };
        const R top = row(t);
        return fy == 0 ? top : top + (row(t + stride) - top) * R(fy);
    }
};

// The pixel that contains q, as offset from (x, y): for values that must not be interpolated (depth, ids, counts).
template <class R>
AA_INLINE void nearest_offsets(const Reprojection<R>& q, int stride, int* k) {
    const R half(Elem<R>(0.5)), zero(Elem<R>(0)), one(Elem<R>(1));
    const Reprojection<R> n{q.wholeX + select(q.fracX >= half, one, zero),
                            q.wholeY + select(q.fracY >= half, one, zero), zero, zero, q.inside};
    texel_offsets(n, stride, k);
}
template <class R>
AA_INLINE R gather(const float* p, const int* k) {
    if constexpr (N<R> == 1)
        return R(p[k[0]]);
    else {
        R r;
        for (int i = 0; i < N<R>; i++) r.v[i] = p[k[i]];
        return r;
    }
}
// Depth that the surface at (x, y) had in the previous camera, if it did not move by itself
// (TemporalIn::expectedDepth).
template <class R>
AA_INLINE R expected_previous_depth(const ExpectedDepth& e, R depthView, int x, int y) {
    using T = Elem<R>;
    if (!e.known) return depthView;
    const R px = R(T(x) + T(0.5)) + iota<R>(), py(T(y) + T(0.5));
    const R perDepth = px * R(T(e.perDepth[0])) + py * R(T(e.perDepth[1])) + R(T(e.perDepth[2]));
    const R constant = px * R(T(e.constant[0])) + py * R(T(e.constant[1])) + R(T(e.constant[2]));
    return select(depthView >= R(T(1e9)), depthView, depthView * perDepth + constant);
}

// ---- B2 dilation ----------------------------------------------------------------------------------------------------
template <class R>
AA_INLINE Motion<R> load_motion(const TemporalIn& in, long o) {
    return {load<R>(in.motionXPx + o), load<R>(in.motionYPx + o)};
}
// The centre wins ties, otherwise the first in row-major order (methods/00 s.3).
template <class R>
AA_INLINE Motion<R> dilated_motion(const TemporalIn& in, long o) {
    Motion<R> best = load_motion<R>(in, o);
    if (in.dilation == Dilation::closest3x3 || in.dilation == Dilation::closestX) {
        const bool diagonalsOnly = in.dilation == Dilation::closestX;
        R nearest = load<R>(in.depthView + o);
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++) {
                if ((i == 0 && j == 0) || (diagonalsOnly && (i == 0 || j == 0))) continue;
                const long n = o + long(j) * in.stride + i;
                const R z = load<R>(in.depthView + n);
                const auto nearer = z < nearest;
                nearest = select(nearer, z, nearest);
                best.x = select(nearer, load<R>(in.motionXPx + n), best.x);
                best.y = select(nearer, load<R>(in.motionYPx + n), best.y);
            }
    } else if (in.dilation == Dilation::longest3x3) {
        R longest = best.x * best.x + best.y * best.y;
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++) {
                if (i == 0 && j == 0) continue;
                const Motion<R> m = load_motion<R>(in, o + long(j) * in.stride + i);
                const R length = m.x * m.x + m.y * m.y;
                const auto longer = length > longest;
                longest = select(longer, length, longest);
                best.x = select(longer, m.x, best.x);
                best.y = select(longer, m.y, best.y);
            }
    }
    return best;
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

// ---- B4 neighbourhoods ----------------------------------------------------------------------------------------------
template <class R>
struct Box {
    vec3<R> lo, hi;
};
template <class R>
struct Neighbours {  // of the 3x3 window and of its plus-shaped part
    Box<R> square, plus;
    vec3<R> meanSquare, meanPlus;
};
// `at(i, j)` is the colour of the neighbour (x + i, y + j).
template <class R, class At>
AA_INLINE Neighbours<R> neighbours(const At& at) {
    using T = Elem<R>;
    const vec3<R> c = at(0, 0), w = at(-1, 0), e = at(1, 0), n = at(0, -1), s = at(0, 1);
    Neighbours<R> b;
    b.plus = {min(min(min(c, w), min(e, n)), s), max(max(max(c, w), max(e, n)), s)};
    // Means as deviations from the centre: a constant window has exactly its value.
    const vec3<R> around = (w - c) + (e - c) + ((n - c) + (s - c));
    const vec3<R> nw = at(-1, -1), ne = at(1, -1), sw = at(-1, 1), se = at(1, 1);
    b.square = {min(b.plus.lo, min(min(nw, ne), min(sw, se))), max(b.plus.hi, max(max(nw, ne), max(sw, se)))};
    b.meanPlus = c + around * R(T(1) / T(5));
    b.meanSquare = c + (around + ((nw - c) + (ne - c) + ((sw - c) + (se - c)))) * R(T(1) / T(9));
    return b;
}
// "Rounded": the mean of both windows' bounds (Pedersen 2016).
template <class R>
AA_INLINE Box<R> box_of(const Neighbours<R>& b, Neighbourhood kind) {
    const R half(Elem<R>(0.5));
    if (kind == Neighbourhood::box3x3) return b.square;
    if (kind == Neighbourhood::plus) return b.plus;
    return {(b.square.lo + b.plus.lo) * half, (b.square.hi + b.plus.hi) * half};
}
template <class R>
AA_INLINE vec3<R> mean_of(const Neighbours<R>& b, Neighbourhood kind) {
    if (kind == Neighbourhood::box3x3) return b.meanSquare;
    if (kind == Neighbourhood::plus) return b.meanPlus;
    return (b.meanSquare + b.meanPlus) * R(Elem<R>(0.5));
}

// ---- B5, B6 constraints ---------------------------------------------------------------------------------------------
// Clip toward the box centre (Pedersen 2016): h moves on the line to the centre until it meets the box's surface.
template <class R>
AA_INLINE vec3<R> clip_to_centre(Box<R> box, vec3<R> h) {
    using T = Elem<R>;
    const R half(T(0.5)), one(T(1));
    // Scaled floor: with an absolute 1e-8 a flat bright box would divide rounding noise by almost nothing (methods/08).
    const R floorExtent = max(R(T(1e-8)), max_component(abs(box.hi)) * R(T(1e-6)));
    const vec3<R> centre = (box.lo + box.hi) * half, extent = (box.hi - box.lo) * half + vec3<R>(floorExtent);
    const vec3<R> offset = h - centre;
    const R m = max_component(abs(offset) / extent);
    return select(m > one, centre + offset * (one / max(m, one)), h);
}
// Exact line clip toward a point r of the box.
template <class R>
AA_INLINE R line_clip_limit(R lo, R hi, R r, R h) {
    const R one(Elem<R>(1)), d = h - r;
    const auto above = h > hi, below = h < lo;
    const R bound = select(above, hi, lo);
    return select(either(above, below), (bound - r) / select(d == R(Elem<R>(0)), one, d), one);
}
template <class R>
AA_INLINE vec3<R> clip_toward(Box<R> box, vec3<R> r, vec3<R> h) {
    r = clamp3(r, box.lo, box.hi);
    const R t = min(min(line_clip_limit(box.lo.x, box.hi.x, r.x, h.x), line_clip_limit(box.lo.y, box.hi.y, r.y, h.y)),
                    line_clip_limit(box.lo.z, box.hi.z, r.z, h.z));
    const R one(Elem<R>(1));
    return select(t < one, r + (h - r) * max(t, R(Elem<R>(0))), h);
}
template <class R>
AA_INLINE vec3<R> constrain(Box<R> box, ClipTarget target, vec3<R> mean, vec3<R> current, vec3<R> h) {
    if (target == ClipTarget::mean) return clip_toward(box, mean, h);
    if (target == ClipTarget::current) return clip_toward(box, current, h);
    if (target == ClipTarget::clamp) return clamp3(h, box.lo, box.hi);
    return clip_to_centre(box, h);
}

// ---- B7 variance box ------------------------------------------------------------------------------------------------
template <class R>
struct Moments {
    vec3<R> mean, sigma;
};
// Moments of the 3x3 window about its centre colour: E[x^2] - mean^2 loses all digits of bright windows (methods/08).
template <class R, class At>
AA_INLINE Moments<R> moments(const At& at) {
    using T = Elem<R>;
    const vec3<R> c = at(0, 0);
    vec3<R> m1(R(T(0))), m2(R(T(0)));
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            if (i == 0 && j == 0) continue;
            const vec3<R> d = at(i, j) - c;
            m1 = m1 + d;
            m2 = m2 + d * d;
        }
    const R ninth(T(1) / T(9));
    const vec3<R> shift = m1 * ninth;
    return {c + shift, sqrt(max(m2 * ninth - shift * shift, vec3<R>(R(T(0)))))};
}
template <class R>
AA_INLINE Box<R> variance_box(const Moments<R>& m, float gamma) {
    const vec3<R> e = m.sigma * R(Elem<R>(gamma));
    return {m.mean - e, m.mean + e};
}

// ---- B8, B9 feedback and blends -------------------------------------------------------------------------------------
// Weight of history from the relative luminance difference (Lottes 2012; Pedersen 2016).
template <class R>
AA_INLINE R luminance_feedback(R current, R history, float kMin, float kMax) {
    using T = Elem<R>;
    const R d = min(abs(current - history) / max(max(current, history), R(T(0.2))), R(T(1)));
    const R u = R(T(1)) - d;
    return R(T(kMin)) + R(T(kMax) - T(kMin)) * (u * u);
}
// history + (current - history) * (1 - k): k = 0 and k = 1 are exact (methods/08 s.8.3).
template <class R>
AA_INLINE vec3<R> blend(vec3<R> current, vec3<R> history, R k) {
    const R zero(Elem<R>(0)), one(Elem<R>(1));
    const vec3<R> mixed = history + (current - history) * (one - k);
    return select(k == zero, current, select(k == one, history, mixed));
}
// Each colour weighted by 1 / (1 + luminance), against fireflies (Karis 2014).
template <class R>
AA_INLINE vec3<R> inverse_luminance_blend(vec3<R> current, R luminanceCurrent, vec3<R> history, R luminanceHistory,
                                          R k) {
    using T = Elem<R>;
    const R zero(T(0)), one(T(1));
    const R wc = (one - k) / (one + max(zero, luminanceCurrent)), wh = k / (one + max(zero, luminanceHistory));
    // As blend() with the normalised weight of history, so that equal colours and k = 0, 1 stay exact.
    return blend(current, history, wh / max(wc + wh, R(T(1e-20))));
}

// ---- history --------------------------------------------------------------------------------------------------------
// A non-finite blend becomes the current colour, that of a broken current pixel its history (finite by induction): one
// bad value must not live in the history for ever (methods/08 s.8.3, taaSimplest).
template <class R>
AA_INLINE vec3<R> sanitised(vec3<R> blended, vec3<R> current, vec3<R> history) {
    const vec3<R> fallback = select(finite(current), current, select(finite(history), history, vec3<R>(R(Elem<R>(0)))));
    return select(finite(blended), blended, fallback);
}
template <class R>
AA_INLINE void store_blend(const TemporalIn& in, int x, int y, vec3<R> result, R alpha) {
    const long o = long(y) * in.stride + x;
    store_rgba(result, alpha, in.next + 4 * o);
    if (in.out.c[0]) store3(result, in.out.c, o);
}
// The first frame after a reset: the current colour.
template <class R>
AA_INLINE void store_first(const TemporalIn& in, int x, int y, R alpha = R(Elem<R>(1))) {
    const long o = long(y) * in.stride + x;
    const R zero(Elem<R>(0));
    const vec3<R> current = load3<R>(in.color.c, o);
    store_blend(in, x, y, sanitised(current, current, vec3<R>(zero)), alpha);
    const TemporalDebug& d = in.debug;
    if (!d.rejection) return;
    store(R(Elem<R>(int(Rejection::firstFrame))), d.rejection + o);
    if (!d.feedback) return;
    const Motion<R> motion = load_motion<R>(in, o);
    store(motion.x, d.motionXPx + o), store(motion.y, d.motionYPx + o);
    store3(current, d.boxLow, o), store3(current, d.boxHigh, o);
    store(zero, d.clipAmount + o), store(zero, d.feedback + o);
}
template <class R>
AA_INLINE void store_debug(const TemporalDebug& d, long o, Motion<R> motion, Mask<R> inside, const Box<R>& box,
                           vec3<R> moved, R k) {
    if (!d.rejection) return;
    using T = Elem<R>;
    store(select(inside, R(T(0)), R(T(int(Rejection::outside)))), d.rejection + o);
    if (!d.feedback) return;
    store(motion.x, d.motionXPx + o), store(motion.y, d.motionYPx + o);
    store3(box.lo, d.boxLow, o), store3(box.hi, d.boxHigh, o);
    store(max_component(abs(moved)), d.clipAmount + o);
    store(select(inside, k, R(T(0))), d.feedback + o);
}

}  // namespace AA_ARCH
