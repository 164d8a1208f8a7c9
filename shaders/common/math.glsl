// Logarithm, exponential, power and the perceptual quantiser to the last bits of float: drivers' own are off by 1e-5.
#ifndef AA_MATH
#define AA_MATH

float artanhRatio(float s2) {  // artanh(s) / s
    return 1.0 + s2 * (1.0 / 3.0 + s2 * (1.0 / 5.0 + s2 * (1.0 / 7.0 + s2 * (1.0 / 9.0))));
}
// Of a normal x > 0: x = m 2^e, log(m) = 2 artanh((m - 1) / (m + 1)).
float log2Positive(float x) {
    const int bits = floatBitsToInt(x), e = (bits - 0x3f3504f3) >> 23;
    const float m = intBitsToFloat(bits - (e << 23)), s = (m - 1.0) / (m + 1.0);
    return float(e) + s * artanhRatio(s * s) * 2.8853900817779268;
}
// 2^x for x held to [-126, 127].
float exp2Clamped(float x) {
    const float held = clamp(x, -126.0, 127.0), n = min(floor(held + 0.5), 127.0), f = (held - n) * 0.69314718055994531;
    const float series =
        1.0 + f * (1.0 + f * (1.0 / 2.0 + f * (1.0 / 6.0 + f * (1.0 / 24.0 + f * (1.0 / 120.0 + f * (1.0 / 720.0 +
        f * (1.0 / 5040.0)))))));
    return series * intBitsToFloat((int(n) + 127) << 23);
}
float powPositive(float x, float y) { return x < 1e-30 ? 0.0 : exp2Clamped(y * log2Positive(max(x, 1e-30))); }

// SMPTE ST 2084: linear light of [0, 10000] nominal units <-> [0, 1]. Both directions work with the difference from 1:
// as written, the exponent of 79 costs float all its digits.
float pqEncode(float linear) {
    const float lm = powPositive(max(linear, 0.0) * 1e-4, 0.1593017578125);
    const float numerator = 0.8359375 + lm * 18.8515625, denominator = 1.0 + lm * 18.6875;
    const float t = 0.1640625 * (lm - 1.0) / (numerator + denominator);
    return exp2Clamped(t * artanhRatio(t * t) * 2.8853900817779268 * 78.84375);
}
float pqDecode(float encoded) {
    const float e = clamp(encoded, 1e-8, 1.0), x = log2Positive(e) * (0.69314718055994531 / 78.84375);
    const float u = x * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 6.0 + x * (1.0 / 24.0 + x * (1.0 / 120.0 + x * (1.0 / 720.0 +
                    x * (1.0 / 5040.0 + x * (1.0 / 40320.0))))))));
    const float lm = max(u + 0.1640625, 0.0) / (0.1640625 - u * 18.6875);
    return powPositive(lm, 1.0 / 0.1593017578125) * 1e4;
}
vec3 pqEncode(vec3 c) { return vec3(pqEncode(c.x), pqEncode(c.y), pqEncode(c.z)); }
vec3 pqDecode(vec3 c) { return vec3(pqDecode(c.x), pqDecode(c.y), pqDecode(c.z)); }

#endif
