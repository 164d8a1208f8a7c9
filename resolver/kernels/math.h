// Logarithm, exponential and power for lanes: own polynomials, because libm differs between machines. Only exactly
// rounded operations, so float lanes and scalar float give the same bits; error a few units in the last place of R.
#pragma once
#include "kernels/lanes.h"

namespace AA_ARCH {

// x = m 2^e with m in [sqrt(1/2), sqrt(2)) for normal x > 0.
template <class R>
struct Split {
    R mantissa, exponent;
};
AA_INLINE Split<float> splitExponent(float x) {
    int32_t i;
    std::memcpy(&i, &x, 4);
    const int32_t e = (i - 0x3f3504f3) >> 23;  // bits of sqrt(1/2)
    i -= e << 23;
    Split<float> s;
    std::memcpy(&s.mantissa, &i, 4);
    s.exponent = float(e);
    return s;
}
AA_INLINE Split<double> splitExponent(double x) {
    int64_t i;
    std::memcpy(&i, &x, 8);
    const int64_t e = (i - 0x3fe6a09e667f3bcd) >> 52;  // bits of sqrt(1/2)
    i -= e << 52;
    Split<double> s;
    std::memcpy(&s.mantissa, &i, 8);
    s.exponent = double(e);
    return s;
}
template <class T, int W>
AA_INLINE Split<Lanes<T, W>> splitExponent(Lanes<T, W> x) {
    using V = typename Lanes<T, W>::V;
    if constexpr (std::is_same_v<T, float>) {
        using I = typename IntsOf<W>::type;
        const I i = (I)x.v, e = (i - 0x3f3504f3) >> 23;
        return {(V)(i - (e << 23)), __builtin_convertvector(e, V)};
    } else {
        Split<Lanes<T, W>> s;
        for (int k = 0; k < W; k++) {
            const auto one = splitExponent(x.v[k]);
            s.mantissa.v[k] = one.mantissa, s.exponent.v[k] = one.exponent;
        }
        return s;
    }
}
// 2^n for a whole n in [-126, 127].
AA_INLINE float powerOfTwo(float n) {
    const int32_t i = (int32_t(n) + 127) << 23;
    float p;
    std::memcpy(&p, &i, 4);
    return p;
}
AA_INLINE double powerOfTwo(double n) {
    const int64_t i = (int64_t(n) + 1023) << 52;
    double p;
    std::memcpy(&p, &i, 8);
    return p;
}
template <class T, int W>
AA_INLINE Lanes<T, W> powerOfTwo(Lanes<T, W> n) {
    if constexpr (std::is_same_v<T, float>) {
        using I = typename IntsOf<W>::type;
        return (typename Lanes<T, W>::V)((__builtin_convertvector(n.v, I) + 127) << 23);
    } else {
        Lanes<T, W> p;
        for (int k = 0; k < W; k++) p.v[k] = powerOfTwo(n.v[k]);
        return p;
    }
}

// sum of c[k] x^k by pairs (Estrin): the steps of Horner's form wait for each other, these do not.
template <class R, int n>
AA_INLINE R polynomial(R x, const R (&c)[n]) {
    if constexpr (n == 1)
        return c[0];
    else {
        R pairs[(n + 1) / 2];
        for (int i = 0; i < n / 2; i++) pairs[i] = c[2 * i] + c[2 * i + 1] * x;
        if constexpr (n % 2) pairs[n / 2] = c[n - 1];
        return polynomial(x * x, pairs);
    }
}
// The power series of artanh(s) / s in s^2, with terms up to s^last.
template <class R, int last>
AA_INLINE R artanhRatio(R s2) {
    R c[(last + 1) / 2];
    for (int k = 1; k <= last; k += 2) c[k / 2] = R(Elem<R>(1.0 / k));
    return polynomial(s2, c);
}

// log2 of a normal x > 0: log(m) = 2 artanh(s), s = (m - 1) / (m + 1), |s| < 0.172, by its power series.
template <class R>
AA_INLINE R log2Positive(R x) {
    using T = Elem<R>;
    constexpr int kLast = std::is_same_v<T, double> ? 21 : 9;  // s^(kLast + 2) is below the precision
    const Split<R> f = splitExponent(x);
    const R s = (f.mantissa - R(T(1))) / (f.mantissa + R(T(1))), s2 = s * s;
    return f.exponent + s * artanhRatio<R, kLast>(s2) * R(T(2.8853900817779268));  // 2 / ln 2
}
// 2^x for x in [-126, 127] (clamped): whole part by the exponent's bits, the rest, |f| <= 1/2, by exp's power series.
template <class R>
AA_INLINE R exp2Clamped(R x) {
    using T = Elem<R>;
    constexpr int kLast = std::is_same_v<T, double> ? 13 : 7;
    const R held = clamp(x, R(T(-126)), R(T(127))), n = min(floor(held + R(T(0.5))), R(T(127)));
    const R f = (held - n) * R(T(0.69314718055994531));  // ln 2
    R c[kLast + 1];
    double factorial = 1;
    for (int k = 0; k <= kLast; k++, factorial *= k) c[k] = R(T(1 / factorial));
    return polynomial(f, c) * powerOfTwo(n);
}
// x^y for 0 <= x; 0 for x below 1e-30 (0^0 too).
template <class R>
AA_INLINE R powPositive(R x, R y) {
    using T = Elem<R>;
    const R tiny(T(1e-30));
    return select(x < tiny, R(T(0)), exp2Clamped(y * log2Positive(max(x, tiny))));
}

}  // namespace AA_ARCH
