// The perceptual quantiser, SMPTE ST 2084: linear light in [0, 10000] nominal units <-> [0, 1]. Include from
// *.kernel.cpp only. Its exponent of 79 and the ratio near 1 under it cost float all digits when computed as written
// (4e-5 of a round trip); both directions therefore work with the difference from 1 (2e-6).
#pragma once
#include "kernels/math.h"

namespace AA_ARCH {

// log2(a / b) from t = (a - b) / (a + b), |t| <= 0.172.
template <class R>
AA_INLINE R log2_of_ratio(R t) {
    using T = Elem<R>;
    constexpr int kLast = std::is_same_v<T, double> ? 21 : 9;
    return t * artanh_ratio<R, kLast>(t * t) * R(T(2.8853900817779268));  // 2 / ln 2
}
// e^u - 1 for |u| <= 1/2 by its power series, exact to the last bits near 0.
template <class R>
AA_INLINE R expm1_small(R u) {
    using T = Elem<R>;
    constexpr int kLast = std::is_same_v<T, double> ? 15 : 8;
    R c[kLast];
    double factorial = 1;
    for (int k = 1; k <= kLast; factorial *= ++k) c[k - 1] = R(T(1 / factorial));
    return polynomial(u, c) * u;
}

// ((c1 + c2 lm) / (1 + c3 lm))^m2 with lm = (linear / 10000)^m1; c1 + c2 - c3 = 1.
template <class R>
AA_INLINE R pq_encode(R linear) {
    using T = Elem<R>;
    const R one(T(1)), lm = pow_positive(max(linear, R(T(0))) * R(T(1e-4)), R(T(0.1593017578125)));
    const R numerator = R(T(0.8359375)) + lm * R(T(18.8515625)), denominator = one + lm * R(T(18.6875));
    // Their difference is 0.1640625 (lm - 1), exactly.
    const R t = R(T(0.1640625)) * (lm - one) / (numerator + denominator);
    return exp2_clamped(log2_of_ratio(t) * R(T(78.84375)));
}
// With encoded^(1/m2) = 1 + u: lm = (0.1640625 + u) / (0.1640625 - 18.6875 u).
template <class R>
AA_INLINE R pq_decode(R encoded) {
    using T = Elem<R>;
    const R e = min(max(encoded, R(T(1e-8))), R(T(1)));
    const R u = expm1_small(log2_positive(e) * R(T(0.69314718055994531 / 78.84375)));  // ln 2 / m2
    const R lm = max(u + R(T(0.1640625)), R(T(0))) / (R(T(0.1640625)) - u * R(T(18.6875)));
    return pow_positive(lm, R(T(1.0 / 0.1593017578125))) * R(T(1e4));
}

}  // namespace AA_ARCH
