// Lanes<T, W>: W pixels at a time on compiler vector extensions; plain float and double are the one-lane case.
//
// Every algorithm is a template over R: Lanes<float, W> is the product, float the portable form, double the oracle.
// On purpose there is no include guard against a second instruction set: each kernel translation unit defines AA_ARCH
// (v2, v3, v4, neon) and everything here lives in that namespace, so that the linker can never merge a function
// compiled for one instruction set into code that runs on another (tests/nm_test guards it).
//
// Same input, same bits: only +, -, *, /, sqrt, floor and comparisons are used, all exactly rounded; contraction into
// FMA is off for the whole build; roots and powers are our own polynomials because libm differs between machines.
//
// Where a processor's own instruction is named, it is for speed: the text without it gives the same bits, and Arm runs
// that wherever its compiler finds the instruction by itself.
#pragma once
#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__ARM_NEON)
#include <arm_neon.h>
#endif

#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

#ifndef AA_ARCH
#error "AA_ARCH names the instruction set's namespace: include lanes.h from *.kernel.cpp files only"
#endif
#ifndef AA_LANES
#define AA_LANES 8
#endif
#define AA_INLINE inline __attribute__((always_inline))

namespace AA_ARCH {

// A struct of its own: GCC 12 loses a dependent vector_size on a typedef inside the class that overloads operators.
template <class T, int W>
struct VecOf {
    typedef T type __attribute__((vector_size(W * sizeof(T))));
    typedef T unaligned __attribute__((vector_size(W * sizeof(T)), aligned(sizeof(T)), may_alias));
};
template <int W>
struct IntsOf {
    typedef int32_t type __attribute__((vector_size(W * 4)));
    typedef int32_t unaligned __attribute__((vector_size(W * 4), aligned(4), may_alias));
};
template <int W>
struct WordsOf {
    typedef uint32_t type __attribute__((vector_size(W * 4)));
};

// GCC 12 keeps to 256 bits where it vectorises by itself, so 16 lanes name their instructions.
#ifdef __AVX512F__
template <class T, int W>
inline constexpr bool kZmm = std::is_same_v<T, float>&& W == 16;
#endif

// a < b ? a : b and a > b ? a : b: one instruction, which GCC 12 misses where an operand is constant. Arm's own minimum
// is another function: of a number and NaN it is NaN, and -0 is less than 0.
template <class T, int W, class V = typename VecOf<T, W>::type>
AA_INLINE V least(V a, V b) {
#ifdef __SSE__
    if constexpr (std::is_same_v<T, float> && W == 4) return (V)_mm_min_ps((__m128)a, (__m128)b);
#endif
#ifdef __AVX2__
    if constexpr (std::is_same_v<T, float> && W == 8) return (V)_mm256_min_ps((__m256)a, (__m256)b);
#endif
#ifdef __AVX512F__
    if constexpr (kZmm<T, W>) return (V)_mm512_min_ps((__m512)a, (__m512)b);
#endif
    return a < b ? a : b;
}
template <class T, int W, class V = typename VecOf<T, W>::type>
AA_INLINE V greatest(V a, V b) {
#ifdef __SSE__
    if constexpr (std::is_same_v<T, float> && W == 4) return (V)_mm_max_ps((__m128)a, (__m128)b);
#endif
#ifdef __AVX2__
    if constexpr (std::is_same_v<T, float> && W == 8) return (V)_mm256_max_ps((__m256)a, (__m256)b);
#endif
#ifdef __AVX512F__
    if constexpr (kZmm<T, W>) return (V)_mm512_max_ps((__m512)a, (__m512)b);
#endif
    return a > b ? a : b;
}

template <class T, int W>
struct Lanes {
    using V = typename VecOf<T, W>::type;
    using Vu = typename VecOf<T, W>::unaligned;
    using Bits = typename IntsOf<W>::type;  // meaningful for T = float
    V v;
    Lanes() = default;
    AA_INLINE Lanes(V a) : v(a) {}
    AA_INLINE Lanes(T a) : v(a - V{}) {}
    // static_assert: takes the semicolon, without which clang-format loses its way.
#define AA_OP(o)                                                              \
    friend AA_INLINE Lanes operator o(Lanes a, Lanes b) { return a.v o b.v; } \
    static_assert(true)
    AA_OP(+);
    AA_OP(-);
    AA_OP(*);
    AA_OP(/);
#undef AA_OP
    friend AA_INLINE Lanes operator-(Lanes a) { return -a.v; }
#define AA_CMP(o)                                                            \
    friend AA_INLINE auto operator o(Lanes a, Lanes b) { return a.v o b.v; } \
    static_assert(true)
    AA_CMP(<);
    AA_CMP(>);
    AA_CMP(<=);
    AA_CMP(>=);
    AA_CMP(==);
    AA_CMP(!=);
#undef AA_CMP
    // min(x, NaN) == x and max(x, NaN) == x
    friend AA_INLINE Lanes min(Lanes a, Lanes b) { return least<T, W>(b.v, a.v); }
    friend AA_INLINE Lanes max(Lanes a, Lanes b) { return greatest<T, W>(b.v, a.v); }
    friend AA_INLINE Lanes abs(Lanes a) {
#ifdef __AVX512F__
        if constexpr (kZmm<T, W>) return (V)_mm512_abs_ps((__m512)a.v);
#endif
        V r;
        for (int i = 0; i < W; i++) r[i] = std::fabs(a.v[i]);
        return r;
    }
    friend AA_INLINE Lanes sqrt(Lanes a) {
#ifdef __AVX512F__
        if constexpr (kZmm<T, W>) return (V)_mm512_sqrt_ps((__m512)a.v);
#endif
        V r;
        for (int i = 0; i < W; i++) r[i] = std::sqrt(a.v[i]);
        return r;
    }
    friend AA_INLINE Lanes floor(Lanes a) {
#ifdef __AVX512F__
        if constexpr (kZmm<T, W>) return (V)_mm512_floor_ps((__m512)a.v);
#endif
        V r;
        for (int i = 0; i < W; i++) r[i] = std::floor(a.v[i]);
        return r;
    }
};

template <class R>
struct LaneTraits {
    using T = R;
    using Mask = bool;
    static constexpr int n = 1;
};
template <class T_, int W>
struct LaneTraits<Lanes<T_, W>> {
    using T = T_;
    using Mask = decltype(Lanes<T_, W>{}.v < Lanes<T_, W>{}.v);
    static constexpr int n = W;
};
template <class R>
inline constexpr int N = LaneTraits<R>::n;  // pixels per value
template <class R>
using Elem = typename LaneTraits<R>::T;
template <class R>
using Mask = typename LaneTraits<R>::Mask;

AA_INLINE float min(float a, float b) { return b < a ? b : a; }
AA_INLINE float max(float a, float b) { return a < b ? b : a; }
AA_INLINE double min(double a, double b) { return b < a ? b : a; }
AA_INLINE double max(double a, double b) { return a < b ? b : a; }
AA_INLINE float abs(float a) { return std::fabs(a); }
AA_INLINE double abs(double a) { return std::fabs(a); }
AA_INLINE float sqrt(float a) { return std::sqrt(a); }
AA_INLINE double sqrt(double a) { return std::sqrt(a); }
AA_INLINE float floor(float a) { return std::floor(a); }
AA_INLINE double floor(double a) { return std::floor(a); }

template <class M, class R>
AA_INLINE R select(M m, R a, R b) {
    if constexpr (N<R> == 1)
        return m ? a : b;
    else
        return m ? a.v : b.v;
}
AA_INLINE bool both(bool a, bool b) { return a && b; }
AA_INLINE bool either(bool a, bool b) { return a || b; }
AA_INLINE bool negate(bool a) { return !a; }
template <class M>
requires(!std::is_same_v<M, bool>) AA_INLINE M both(M a, M b) { return a & b; }
template <class M>
requires(!std::is_same_v<M, bool>) AA_INLINE M either(M a, M b) { return a | b; }
template <class M>
requires(!std::is_same_v<M, bool>) AA_INLINE M negate(M a) { return ~a; }
// Bit i set when lane i of a mask is set.
template <class R>
AA_INLINE unsigned maskBits(Mask<R> m) {
    if constexpr (N<R> == 1) return m ? 1u : 0u;
#ifdef __SSE__
    else if constexpr (std::is_same_v<R, Lanes<float, 4>>)
        return unsigned(_mm_movemask_ps((__m128)m));
    else if constexpr (std::is_same_v<R, Lanes<double, 2>>)
        return unsigned(_mm_movemask_pd((__m128d)m));
#endif
#ifdef __AVX2__
    else if constexpr (std::is_same_v<R, Lanes<float, 8>>)
        return unsigned(_mm256_movemask_ps((__m256)m));
    else if constexpr (std::is_same_v<R, Lanes<double, 4>>)
        return unsigned(_mm256_movemask_pd((__m256d)m));
#endif
#ifdef __AVX512DQ__
    else if constexpr (std::is_same_v<R, Lanes<float, 16>>)
        return unsigned(_mm512_movepi32_mask((__m512i)m));
    else if constexpr (std::is_same_v<R, Lanes<double, 8>>)
        return unsigned(_mm512_movepi64_mask((__m512i)m));
#endif
#ifdef __ARM_NEON
    else if constexpr (std::is_same_v<R, Lanes<float, 4>>)
        return vaddvq_u32(vandq_u32((uint32x4_t)m, (uint32x4_t){1, 2, 4, 8}));
#endif
    else {
        unsigned b = 0;
        for (int i = 0; i < N<R>; i++) b |= unsigned(m[i] & 1) << i;
        return b;
    }
}
template <class R>
AA_INLINE R clamp(R x, std::type_identity_t<R> lo, std::type_identity_t<R> hi) {
    return min(max(x, lo), hi);
}
template <class R>
AA_INLINE R saturate(R x) {
    return clamp(x, R(Elem<R>(0)), R(Elem<R>(1)));
}
template <class R>
AA_INLINE R mix(R a, R b, std::type_identity_t<R> t) {
    return a + (b - a) * t;
}

template <class R>
AA_INLINE R load(const float* p) {  // storage is float; arithmetic is Elem<R>
    if constexpr (N<R> == 1)
        return R(*p);
    else if constexpr (std::is_same_v<Elem<R>, float>)
        return typename R::V(*(const typename R::Vu*)p);
    else {
        R r;
        for (int i = 0; i < N<R>; i++) r.v[i] = p[i];
        return r;
    }
}
template <class R, class O>
AA_INLINE void store(R a, O* p) {
    if constexpr (N<R> == 1)
        *p = O(a);
    else if constexpr (std::is_same_v<Elem<R>, O>)
        *(typename R::Vu*)p = a.v;
    else
        for (int i = 0; i < N<R>; i++) p[i] = O(a.v[i]);
}
template <class R>
AA_INLINE R iota() {
    if constexpr (N<R> == 1)
        return R(0);
    else {
        R r;
        for (int i = 0; i < N<R>; i++) r.v[i] = Elem<R>(i);
        return r;
    }
}
template <class R>
AA_INLINE void toInts(R a, int* k) {
    if constexpr (N<R> == 1)
        k[0] = int(a);
    else
        for (int i = 0; i < N<R>; i++) k[i] = int(a.v[i]);
}
// Lane mask of ids[x + i] != other[x + i]; ids are compared as integers, never through float.
template <class R>
AA_INLINE Mask<R> idsDiffer(const uint32_t* a, const uint32_t* b) {
    if constexpr (N<R> == 1)
        return *a != *b;
    else if constexpr (std::is_same_v<Elem<R>, float>) {
        using I = typename IntsOf<N<R>>::unaligned;
        return (Mask<R>)(typename IntsOf<N<R>>::type(*(const I*)a) != typename IntsOf<N<R>>::type(*(const I*)b));
    } else {
        Mask<R> m;
        for (int i = 0; i < N<R>; i++) m[i] = a[i] != b[i] ? -1 : 0;
        return m;
    }
}
// The value's bits as float/double: used only to seed Newton iterations below.
AA_INLINE float bitsScaled(float a, float mul, float add) {
    int32_t i;
    std::memcpy(&i, &a, 4);
    i = int32_t(float(i) * mul + add);
    std::memcpy(&a, &i, 4);
    return a;
}
AA_INLINE double bitsScaled(double a, float mul, float add) { return double(bitsScaled(float(a), mul, add)); }
template <class T, int W>
AA_INLINE Lanes<T, W> bitsScaled(Lanes<T, W> a, float mul, float add) {
    if constexpr (std::is_same_v<T, float>) {
        using I = typename IntsOf<W>::type;
        I i = (I)a.v;
        typename Lanes<T, W>::V f = __builtin_convertvector(i, typename Lanes<T, W>::V) * mul + add;
        i = __builtin_convertvector(f, I);
        return (typename Lanes<T, W>::V)i;
    } else {
        Lanes<T, W> r;
        for (int k = 0; k < W; k++) r.v[k] = bitsScaled(a.v[k], mul, add);
        return r;
    }
}
// x^(1/3) and x^(1/5) for x > 0, to the last bit or two of R for x in 1e-30..1e30. Newton's method for the reciprocal
// root r, which needs no division, from a seed by the exponent's bits (4 % off); then one step for the root itself,
// whose small correction costs no digits. x <= 0 gives some finite number: callers select.
template <class R>
inline constexpr int kRootSteps = std::is_same_v<Elem<R>, double> ? 4 : 2;
template <class R>
AA_INLINE R cbrtPositive(R x) {
    using T = Elem<R>;
    const R third(T(1) / T(3)), fourThirds(T(4) / T(3));
    R r = bitsScaled(x, -1.0f / 3.0f, 1419967600.0f);
    for (int i = 0; i < kRootSteps<R>; i++) r = r * (fourThirds - x * (r * r) * r * third);
    const R r2 = r * r, y = x * r2;
    return y - (y * y * y - x) * r2 * third;
}
template <class R>
AA_INLINE R fifthRootPositive(R x) {
    using T = Elem<R>;
    const R fifth(T(1) / T(5)), sixFifths(T(6) / T(5));
    R r = bitsScaled(x, -1.0f / 5.0f, 1277929000.0f);
    for (int i = 0; i < kRootSteps<R>; i++) {
        const R r2 = r * r;
        r = r * (sixFifths - x * (r2 * r2) * r * fifth);
    }
    const R r2 = r * r, r4 = r2 * r2, y = x * r4, y2 = y * y;
    return y - (y2 * y2 * y - x) * r4 * fifth;
}

template <class R>
struct vec3 {
    R x, y, z;
    vec3() = default;
    AA_INLINE vec3(R a, R b, R c) : x(a), y(b), z(c) {}
    AA_INLINE explicit vec3(R a) : x(a), y(a), z(a) {}
};
#define AA_OP(o)                                                         \
    template <class R>                                                   \
    AA_INLINE vec3<R> operator o(vec3<R> a, vec3<R> b) {                 \
        return {a.x o b.x, a.y o b.y, a.z o b.z};                        \
    }                                                                    \
    template <class R>                                                   \
    AA_INLINE vec3<R> operator o(vec3<R> a, std::type_identity_t<R> b) { \
        return {a.x o b, a.y o b, a.z o b};                              \
    }                                                                    \
    static_assert(true)
AA_OP(+);
AA_OP(-);
AA_OP(*);
AA_OP(/);
#undef AA_OP
template <class R>
AA_INLINE vec3<R> abs(vec3<R> a) {
    return {abs(a.x), abs(a.y), abs(a.z)};
}
template <class R>
AA_INLINE vec3<R> sqrt(vec3<R> a) {
    return {sqrt(a.x), sqrt(a.y), sqrt(a.z)};
}
template <class R>
AA_INLINE vec3<R> min(vec3<R> a, vec3<R> b) {
    return {min(a.x, b.x), min(a.y, b.y), min(a.z, b.z)};
}
template <class R>
AA_INLINE vec3<R> max(vec3<R> a, vec3<R> b) {
    return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)};
}
template <class M, class R>
AA_INLINE vec3<R> select(M m, vec3<R> a, vec3<R> b) {
    return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
template <class R>
AA_INLINE vec3<R> mix(vec3<R> a, vec3<R> b, std::type_identity_t<R> t) {
    return a + (b - a) * t;
}
template <class R>
AA_INLINE vec3<R> saturate(vec3<R> a) {
    return {saturate(a.x), saturate(a.y), saturate(a.z)};
}
template <class R>
AA_INLINE R dot(vec3<R> a, vec3<R> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class R>
AA_INLINE R maxComponent(vec3<R> a) {
    return max(a.x, max(a.y, a.z));
}
// Luminance of linear RGB, BT.709 (conventions 4); SMAA, INSIDE and Uncharted apply the same weights to encoded RGB.
template <class R>
AA_INLINE R luma709(vec3<R> c) {
    using T = Elem<R>;
    return c.x * R(T(0.2126)) + c.y * R(T(0.7152)) + c.z * R(T(0.0722));
}
template <class R>
AA_INLINE R luma601(vec3<R> c) {
    using T = Elem<R>;
    return c.x * R(T(0.299)) + c.y * R(T(0.587)) + c.z * R(T(0.114));
}
// The colours of N<R> pixels of three planes.
template <class R>
AA_INLINE vec3<R> colourAt(const float* const c[3], long o) {
    return {load<R>(c[0] + o), load<R>(c[1] + o), load<R>(c[2] + o)};
}

}  // namespace AA_ARCH
