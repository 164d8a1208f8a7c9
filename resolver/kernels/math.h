// exp2, log2 and powers in lanes: own polynomials, because libm differs between machines. Include from *.kernel.cpp only.
#pragma once
#include "kernels/lanes.h"

namespace AA_ARCH {

// 2^n for whole n in the normal range of float.
AA_INLINE float exp2_whole(float n) {
    const int32_t bits = (int32_t(n) + 127) << 23;
    float r;
    std::memcpy(&r, &bits, 4);
    return r;
}
AA_INLINE double exp2_whole(double n) { return double(exp2_whole(float(n))); }
template <class T, int W>
AA_INLINE Lanes<T, W> exp2_whole(Lanes<T, W> n) {
    if constexpr (std::is_same_v<T, float>) {
        using I = typename ints_of<W>::type;
        const I bits = (__builtin_convertvector(n.v, I) + 127) << 23;
        return (typename Lanes<T, W>::V)bits;
    } else {
        Lanes<T, W> r;
        for (int i = 0; i < W; i++) r.v[i] = exp2_whole(n.v[i]);
        return r;
    }
}
// Exponent and mantissa in [1, 2) of a positive normal number.
AA_INLINE void split_float(float x, float& exponent, float& mantissa) {
    int32_t bits;
    std::memcpy(&bits, &x, 4);
    exponent = float((bits >> 23) - 127);
    bits = (bits & 0x007fffff) | 0x3f800000;
    std::memcpy(&mantissa, &bits, 4);
}
AA_INLINE void split_float(double x, double& exponent, double& mantissa) {
    int64_t bits;
    std::memcpy(&bits, &x, 8);
    exponent = double((bits >> 52) - 1023);
    bits = (bits & 0x000fffffffffffffll) | 0x3ff0000000000000ll;
    std::memcpy(&mantissa, &bits, 8);
}
template <class T, int W>
AA_INLINE void split_float(Lanes<T, W> x, Lanes<T, W>& exponent, Lanes<T, W>& mantissa) {
    if constexpr (std::is_same_v<T, float>) {
        using I = typename ints_of<W>::type;
        const I bits = (I)x.v;
        exponent = __builtin_convertvector((bits >> 23) - 127, typename Lanes<T, W>::V);
        mantissa = (typename Lanes<T, W>::V)((bits & 0x007fffff) | 0x3f800000);
    } else
        for (int i = 0; i < W; i++) {
            T e, m;
            split_float(x.v[i], e, m);
            exponent.v[i] = e, mantissa.v[i] = m;
        }
}

// 2^x for |x| <= 126: whole part by the exponent, fraction in [-1/2, 1/2] by the Taylor series of e^(x ln 2)
// (terms to x^7 for float: 2e-8; to x^13 for double: 1e-16).
template <class R>
AA_INLINE R exp2_lanes(R x) {
    using T = Elem<R>;
    const R limit(T(126)), clamped = min(max(x, -limit), limit);
    const R whole = floor(clamped + R(T(0.5))), u = (clamped - whole) * R(T(0.693147180559945309417));
    constexpr int terms = std::is_same_v<T, double> ? 14 : 8;
    R sum(T(1));
    for (int n = terms; n >= 1; n--) sum = sum * u * R(T(1) / T(n)) + R(T(1));
    return sum * exp2_whole(whole);
}
// log2(a / b) from t = (a - b) / (a + b), |t| <= 0.172: 2/ln 2 atanh(t).
template <class R>
AA_INLINE R log2_of_ratio(R t) {
    using T = Elem<R>;
    const R t2 = t * t;
    constexpr int terms = std::is_same_v<T, double> ? 10 : 4;
    R sum(T(0));
    for (int n = terms; n >= 0; n--) sum = sum * t2 + R(T(1) / T(2 * n + 1));
    return t * sum * R(T(2.88539008177792681472));
}
// log2 of a positive normal number: exponent + log2 of the mantissa m in [sqrt 1/2, sqrt 2].
template <class R>
AA_INLINE R log2_positive(R x) {
    using T = Elem<R>;
    const R one(T(1));
    R exponent, m;
    split_float(x, exponent, m);
    const auto high = m > R(T(1.41421356237309515));
    m = select(high, m * R(T(0.5)), m);
    exponent = select(high, exponent + one, exponent);
    return exponent + log2_of_ratio((m - one) / (m + one));
}
// x^y for positive normal x.
template <class R>
AA_INLINE R pow_positive(R x, R y) {
    return exp2_lanes(log2_positive(x) * y);
}

}  // namespace AA_ARCH
