// Interleaved RGBA texels in and out of lanes. Include from *.kernel.cpp only.
#pragma once
#include "kernels/transpose.h"

namespace AA_ARCH {

template <class R>
struct Texel {
    vec3<R> rgb;
    R a;
};

// W texels of an RGBA image at pixel offsets k[i]. One 128-bit load per texel and 4x4 transposes is four times faster
// than planar gathers and costs the same whatever the motion.
template <class R>
AA_INLINE Texel<R> fetchRgba(const float* p, const int* k) {
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
#ifdef __AVX512F__
    else if constexpr (std::is_same_v<R, Lanes<float, 16>>) {
        auto four = [&](int i) __attribute__((always_inline)) {
            const auto pair = [&](int a, int b) __attribute__((always_inline)) {
                return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(p + 4l * k[a])),
                                            _mm_loadu_ps(p + 4l * k[b]), 1);
            };
            return _mm512_insertf32x8(_mm512_castps256_ps512(pair(i, i + 4)), pair(i + 8, i + 12), 1);
        };
        const __m512 t0 = four(0), t1 = four(1), t2 = four(2), t3 = four(3);
        const __m512 xy01 = _mm512_unpacklo_ps(t0, t1), xy23 = _mm512_unpacklo_ps(t2, t3),
                     zw01 = _mm512_unpackhi_ps(t0, t1), zw23 = _mm512_unpackhi_ps(t2, t3);
        using V = typename R::V;
        return {{(V)_mm512_shuffle_ps(xy01, xy23, 0x44), (V)_mm512_shuffle_ps(xy01, xy23, 0xEE),
                 (V)_mm512_shuffle_ps(zw01, zw23, 0x44)},
                (V)_mm512_shuffle_ps(zw01, zw23, 0xEE)};
    }
#endif
    else if constexpr (std::is_same_v<R, Lanes<float, 4>>) {
        Four x = loadFour(p + 4l * k[0]), y = loadFour(p + 4l * k[1]), z = loadFour(p + 4l * k[2]),
             w = loadFour(p + 4l * k[3]);
        transpose(x, y, z, w);
        return {{x, y, z}, w};
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
AA_INLINE Texel<R> loadRgba(const float* p) {
    alignas(64) int k[N<R>];
    for (int i = 0; i < N<R>; i++) k[i] = i;
    return fetchRgba<R>(p, k);
}
// Where W pixels are read, as offsets in pixels. `together`: side by side, as where everything moves alike.
template <class R>
struct Offsets {
    alignas(64) int k[N<R>];
    bool together;
    // `offsets` are integers in lanes; for one lane use the members.
    template <class I>
    AA_INLINE void set(I offsets) {
        const I lane = __builtin_convertvector(iota<R>().v, I), first = offsets - lane;
        together = !maskBits<R>((Mask<R>)(first != I{} + first[0]));
        *(typename IntsOf<N<R>>::unaligned*)k = offsets;
        __asm__("" : "+m"(k));  // read them back one by one: GCC would take the vector apart, at twice the cost
    }
};
template <class R>
AA_INLINE Texel<R> fetchRgba(const float* p, const Offsets<R>& at) {
    return at.together ? loadRgba<R>(p + 4l * at.k[0]) : fetchRgba<R>(p, at.k);
}
// Calls run(fetch) for a function of several texels around each offset, fetch(p) being fetchRgba(p, at): decided once,
// so that neighbouring fetches of pixels side by side share what they load and sort.
template <class R, class Run>
AA_INLINE auto withTexels(const Offsets<R>& at, const Run& run) {
    if constexpr (N < R >> 1)
        if (at.together) {
            const long first = 4l * at.k[0];
            return run([&](const float* p) __attribute__((always_inline)) { return loadRgba<R>(p + first); });
        }
    return run([&](const float* p) __attribute__((always_inline)) { return fetchRgba<R>(p, at.k); });
}
// One value of a plane for each pixel.
template <class R>
AA_INLINE R gather(const float* p, const Offsets<R>& at) {
    if (at.together) return load<R>(p + at.k[0]);
#ifdef __AVX512F__
    if constexpr (std::is_same_v<R, Lanes<float, 16>>)
        return (typename R::V)_mm512_i32gather_ps(_mm512_loadu_si512(at.k), p, 4);
#endif
    if constexpr (N<R> == 1)
        return R(p[at.k[0]]);
    else {
        R r;
        for (int i = 0; i < N<R>; i++) r.v[i] = p[at.k[i]];
        return r;
    }
}
template <class R>
AA_INLINE void storeRgba(vec3<R> c, R a, float* p) {
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
#ifdef __AVX512F__
    else if constexpr (std::is_same_v<R, Lanes<float, 16>>) {
        const __m512 x = (__m512)c.x.v, y = (__m512)c.y.v, z = (__m512)c.z.v, w = (__m512)a.v;
        const __m512 xyl = _mm512_unpacklo_ps(x, y), xyh = _mm512_unpackhi_ps(x, y), zwl = _mm512_unpacklo_ps(z, w),
                     zwh = _mm512_unpackhi_ps(z, w);
        const __m512 t0 = _mm512_shuffle_ps(xyl, zwl, 0x44), t1 = _mm512_shuffle_ps(xyl, zwl, 0xEE),
                     t2 = _mm512_shuffle_ps(xyh, zwh, 0x44), t3 = _mm512_shuffle_ps(xyh, zwh, 0xEE);
        const __m512 low01 = _mm512_shuffle_f32x4(t0, t1, 0x44), low23 = _mm512_shuffle_f32x4(t2, t3, 0x44),
                     high01 = _mm512_shuffle_f32x4(t0, t1, 0xEE), high23 = _mm512_shuffle_f32x4(t2, t3, 0xEE);
        _mm512_storeu_ps(p, _mm512_shuffle_f32x4(low01, low23, 0x88));
        _mm512_storeu_ps(p + 16, _mm512_shuffle_f32x4(low01, low23, 0xDD));
        _mm512_storeu_ps(p + 32, _mm512_shuffle_f32x4(high01, high23, 0x88));
        _mm512_storeu_ps(p + 48, _mm512_shuffle_f32x4(high01, high23, 0xDD));
    }
#endif
    else if constexpr (std::is_same_v<R, Lanes<float, 4>>) {
        Four t0 = c.x.v, t1 = c.y.v, t2 = c.z.v, t3 = a.v;
        transpose(t0, t1, t2, t3);
        storeFour(t0, p), storeFour(t1, p + 4), storeFour(t2, p + 8), storeFour(t3, p + 12);
    } else
        for (int i = 0; i < N<R>; i++) {
            p[4 * i] = float(c.x.v[i]), p[4 * i + 1] = float(c.y.v[i]), p[4 * i + 2] = float(c.z.v[i]);
            p[4 * i + 3] = float(a.v[i]);
        }
}

}  // namespace AA_ARCH
