// One scalar per pixel for edge decisions: the lumas of the spatial methods.
#ifndef AA_LUMA
#define AA_LUMA
#include "image.glsl"

// By number, of encoded colour unless said: BT.601, BT.709, green, FXAA 1's [Lottes 2009], sqrt(BT.601) of linear
// colour [Lottes 2011], BT.601 of the square roots of linear colour [Strugar 2018], log2(1 + 15 Y) / 4 of linear colour
// [Stanard n.d.], NFAA's.
const int LUMA_REC601 = 0, LUMA_REC709 = 1, LUMA_GREEN = 2, LUMA_RED_GREEN = 3, LUMA_SQRT_LINEAR = 4,
          LUMA_LINEAR_OF_SQRT = 5, LUMA_LOG2_LINEAR = 6, LUMA_NFAA = 7;

// `precise`: equal colours have equal lumas whatever the compiler fuses, and thresholds fall where they do on the CPU.
float weighted(vec3 c, float r, float g, float b) {
    precise const float y = c.x * r + c.y * g + c.z * b;
    return y;
}
vec3 displayRange(vec3 c) { return lesser(vec3(1.0), greater(vec3(0.0), c)); }  // NaN gives 0
// log2(x) for 1 <= x <= 16: the exponent by halving, then log2(m) = 2 / ln 2 artanh((m - 1) / (m + 1)).
float log2From1To16(float x) {
    float exponent = 0.0;
    for (int k = 3; k >= 1; k--) {
        const float power = float(1 << k);
        if (x >= power * 0.70710678118654752) exponent += float(k), x *= 1.0 / power;
    }
    const float s = (x - 1.0) / (x + 1.0), q = s * s;
    float series = 1.0 / 11.0;
    for (int k = 9; k >= 1; k -= 2) series = series * q + 1.0 / float(k);
    return exponent + 2.8853900817779268 * s * series;
}
float lumaOf(vec3 c, int kind) {
    switch (kind) {
        case LUMA_REC601:
            return weighted(c, 0.299, 0.587, 0.114);
        case LUMA_REC709:
            return weighted(c, 0.2126, 0.7152, 0.0722);
        case LUMA_GREEN:
            return c.y;
        case LUMA_RED_GREEN: {
            precise const float y = c.y * (0.587 / 0.299) + c.x;
            return y;
        }
        case LUMA_SQRT_LINEAR:
            return sqrt(weighted(displayRange(c), 0.299, 0.587, 0.114));
        case LUMA_LINEAR_OF_SQRT:
            return weighted(sqrt(displayRange(c)), 0.299, 0.587, 0.114);
        case LUMA_LOG2_LINEAR:
            return log2From1To16(1.0 + 15.0 * min(1.0, weighted(displayRange(c), 0.212671, 0.715160, 0.072169))) * 0.25;
        case LUMA_NFAA:
            return weighted(c, 0.212, 0.716, 0.072);
    }
    return c.y;
}

#endif
