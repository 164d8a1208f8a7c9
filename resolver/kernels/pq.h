// The perceptual quantiser, SMPTE ST 2084: linear light in [0, 10000] nominal units <-> [0, 1]. Include from
// *.kernel.cpp only. Its exponent of 79 and the ratio near 1 under it cost float all digits when computed as written
// (4e-5 of a round trip); both directions therefore work with the difference from 1 (2e-6).
#pragma once
#include "kernels/math.h"
#include "kernels/pq_tables.h"
#include "kernels/texels.h"

namespace AA_ARCH {

// log2(a / b) from t = (a - b) / (a + b), |t| <= 0.172.
template <class R>
AA_INLINE R log2OfRatio(R t) {
    using T = Elem<R>;
    constexpr int kLast = std::is_same_v<T, double> ? 21 : 9;
    return t * artanhRatio<R, kLast>(t * t) * R(T(2.8853900817779268));  // 2 / ln 2
}
// e^u - 1 for |u| <= 1/2 by its power series, exact to the last bits near 0.
template <class R>
AA_INLINE R expm1Small(R u) {
    using T = Elem<R>;
    constexpr int kLast = std::is_same_v<T, double> ? 15 : 8;
    R c[kLast];
    double factorial = 1;
    for (int k = 1; k <= kLast; factorial *= ++k) c[k - 1] = R(T(1 / factorial));
    return polynomial(u, c) * u;
}

// ((c1 + c2 lm) / (1 + c3 lm))^m2 with lm = (linear / 10000)^m1; c1 + c2 - c3 = 1.
template <class R>
AA_INLINE R pqEncode(R linear) {
    using T = Elem<R>;
    const R one(T(1)), lm = powPositive(max(linear, R(T(0))) * R(T(1e-4)), R(T(0.1593017578125)));
    const R numerator = R(T(0.8359375)) + lm * R(T(18.8515625)), denominator = one + lm * R(T(18.6875));
    // Their difference is 0.1640625 (lm - 1), exactly.
    const R t = R(T(0.1640625)) * (lm - one) / (numerator + denominator);
    return exp2Clamped(log2OfRatio(t) * R(T(78.84375)));
}
// With encoded^(1/m2) = 1 + u: lm = (0.1640625 + u) / (0.1640625 - 18.6875 u).
template <class R>
AA_INLINE R pqDecode(R encoded) {
    using T = Elem<R>;
    const R e = min(max(encoded, R(T(1e-8))), R(T(1)));
    const R u = expm1Small(log2Positive(e) * R(T(0.69314718055994531 / 78.84375)));  // ln 2 / m2
    const R lm = max(u + R(T(0.1640625)), R(T(0))) / (R(T(0.1640625)) - u * R(T(18.6875)));
    return powPositive(lm, R(T(1.0 / 0.1593017578125))) * R(T(1e4));
}

// ---- the same by table ----------------------------------------------------------------------------------------------
// What float uses: five times faster, and within the rounding of float of the exact curve (1e-8 of an encoded value,
// relative of a linear one). The fit is made in double, once.

// A cubic in x - start through four Chebyshev nodes of [start, start + width].
template <class Fn>
AA_INLINE void fitCubic(const Fn& f, double start, double width, float* coefficients) {
    double x[4], d[4];
    for (int i = 0; i < 4; i++) {
        constexpr double kNodes[] = {0.03806023374435663, 0.30865828381745514, 0.69134171618254486,
                                     0.96193976625564337};
        x[i] = width * kNodes[i], d[i] = f(start + x[i]);
    }
    for (int k = 1; k < 4; k++)  // divided differences, then Newton's form multiplied out
        for (int i = 3; i >= k; i--) d[i] = (d[i] - d[i - 1]) / (x[i] - x[i - k]);
    double c[4] = {d[3], 0, 0, 0};
    for (int k = 2; k >= 0; k--) {
        for (int i = 3 - k; i > 0; i--) c[i] = c[i - 1] - c[i] * x[k];
        c[0] = d[k] - c[0] * x[k];
    }
    for (int i = 0; i < 4; i++) coefficients[i] = float(c[i]);
}
// Part k of a table covers floats from part_start on: `parts` per octave, the first octave from 2^first on.
template <int first, int parts, class Fn>
AA_INLINE void fillTable(const Fn& f, int octaves, float* table) {
    for (int octave = 0; octave < octaves; octave++) {
        const double low = powerOfTwo(double(first + octave));
        for (int k = 0; k < parts; k++)
            fitCubic([&](double x) { return f(low * x); }, 1.0 + double(k) / parts, 1.0 / parts,
                     table + 4 * (octave * parts + k));
    }
}
// The cubic of x's part at x; 2^first <= x < 2^(first + octaves).
template <int first, int parts>
AA_INLINE float fromTable(const float* table, float x) {
    constexpr int kShift = 23 - __builtin_ctz(parts);
    int32_t bits;
    std::memcpy(&bits, &x, 4);
    const float* c = table + 4 * ((bits >> kShift) - ((first + 127) * parts));
    bits = (bits & ((1 << kShift) - 1)) | 0x3f800000;
    float t;
    std::memcpy(&t, &bits, 4);
    t = t - 1.0f;
    return c[0] + t * (c[1] + t * (c[2] + t * c[3]));
}
template <int first, int parts, int W>
AA_INLINE Lanes<float, W> fromTable(const float* table, Lanes<float, W> x) {
    using R = Lanes<float, W>;
    using I = typename IntsOf<W>::type;
    constexpr int kShift = 23 - __builtin_ctz(parts);
    const I bits = (I)x.v, part = (bits >> kShift) - ((first + 127) * parts);
    alignas(64) int k[W];
    *(I*)k = part;
    const Texel<R> c = fetchRgba<R>(table, k);
    const R t = R((typename R::V)((bits & ((1 << kShift) - 1)) | 0x3f800000)) - R(1.0f);
    return c.rgb.x + t * (c.rgb.y + t * (c.rgb.z + t * c.a));
}

AA_INLINE void fillTables(aa::PqTables& t) {
    using P = aa::PqTables;
    fillTable<P::kEncodeFirst, P::kEncodeParts>([](double x) { return pqEncode(x); }, P::kEncodeOctaves, t.encode);
    fillTable<P::kDecodeFirst, P::kDecodeParts>([](double x) { return pqDecode(x); }, P::kDecodeOctaves, t.decode);
    t.black = float(pqEncode(0.0));
}
template <class R>
AA_INLINE R pqEncode(const aa::PqTables& t, R linear) {
    using P = aa::PqTables;
    if constexpr (std::is_same_v<Elem<R>, double>)
        return pqEncode(min(max(R(Elem<R>(0)), linear), R(Elem<R>(1e4))));  // NaN: black, as below
    else {
        const R darkest(5.4210108624275222e-20f);             // 2^-64
        const R inside = min(max(darkest, linear), R(1e4f));  // NaN: darkest
        return select(linear > darkest, fromTable<P::kEncodeFirst, P::kEncodeParts>(t.encode, inside), R(t.black));
    }
}
template <class R>
AA_INLINE R pqDecode(const aa::PqTables& t, R encoded) {
    using P = aa::PqTables;
    if constexpr (std::is_same_v<Elem<R>, double>)
        return pqDecode(encoded);
    else {
        const R inside = min(max(R(4.76837158203125e-7f), encoded), R(1.0f));  // 2^-21
        return select(encoded > R(t.black), max(R(0.0f), fromTable<P::kDecodeFirst, P::kDecodeParts>(t.decode, inside)),
                      R(0.0f));
    }
}

}  // namespace AA_ARCH
