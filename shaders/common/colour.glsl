// Colour spaces: linear is scene-referred BT.709, >= 0; encoded is what is displayed, in [0, 1].
#ifndef AA_COLOUR
#define AA_COLOUR
#include "image.glsl"

float luma709(vec3 c) { return c.x * 0.2126 + c.y * 0.7152 + c.z * 0.0722; }
float luma601(vec3 c) { return c.x * 0.299 + c.y * 0.587 + c.z * 0.114; }

// Weights under the luminance feedback, by number: 1/4 1/2 1/4, BT.709, BT.601, 0.22 0.707 0.071.
const int LUMINANCE_QUARTER = 0, LUMINANCE_BT709 = 1, LUMINANCE_BT601 = 2, LUMINANCE_INSIDE = 3;
float luminance(vec3 c, int kind) {
    if (kind == LUMINANCE_QUARTER) return c.x * 0.25 + c.y * 0.5 + c.z * 0.25;
    if (kind == LUMINANCE_INSIDE) return c.x * 0.22 + c.y * 0.707 + c.z * 0.071;
    return kind == LUMINANCE_BT601 ? luma601(c) : luma709(c);
}

// Y, Co, Cg. The inverse does not clamp.
vec3 toYcocg(vec3 c) {
    const float rb = (c.x + c.z) * 0.25;
    return vec3(rb + c.y * 0.5, (c.x - c.z) * 0.5, c.y * 0.5 - rb);
}
vec3 fromYcocg(vec3 c) {
    const float t = c.x - c.z;
    return vec3(t + c.y, c.x + c.z, t - c.y);
}

// x^(1/3) and x^(1/5) for x > 0 to the last bits: Newton's steps for the reciprocal root from a guess at the exponent,
// then one for the root. pow() of many drivers is off by 1e-5.
float rootSeed(float x, float power, float offset) {
    return intBitsToFloat(int(float(floatBitsToInt(x)) * power + offset));
}
float cbrtPositive(float x) {
    float r = rootSeed(x, -1.0 / 3.0, 1419967600.0);
    for (int i = 0; i < 2; i++) r = r * (4.0 / 3.0 - x * (r * r) * r * (1.0 / 3.0));
    const float r2 = r * r, y = x * r2;
    return y - (y * y * y - x) * r2 * (1.0 / 3.0);
}
float fifthRootPositive(float x) {
    float r = rootSeed(x, -1.0 / 5.0, 1277929000.0);
    for (int i = 0; i < 2; i++) {
        const float r2 = r * r;
        r = r * (6.0 / 5.0 - x * (r2 * r2) * r * (1.0 / 5.0));
    }
    const float r2 = r * r, r4 = r2 * r2, y = x * r4, y2 = y * y;
    return y - (y2 * y2 * y - x) * r4 * (1.0 / 5.0);
}
// IEC 61966-2-1.
float srgbEncode(float c) {
    const float s = sqrt(max(c, 1e-12));  // c^(1/2.4) = sqrt(s) cbrt(s)
    const float curved = 1.055 * (sqrt(s) * cbrtPositive(s)) - 0.055;
    return min(c <= 0.0031308 ? c * 12.92 : curved, 1.0);
}
float srgbDecode(float e) {
    const float b = max((e + 0.055) / 1.055, 1e-12), f = fifthRootPositive(b);  // b^2.4 = b^2 (b^(1/5))^2
    return e <= 0.04045 ? e / 12.92 : b * b * (f * f);
}
vec3 srgbEncode(vec3 c) { return vec3(srgbEncode(c.x), srgbEncode(c.y), srgbEncode(c.z)); }
vec3 srgbDecode(vec3 c) { return vec3(srgbDecode(c.x), srgbDecode(c.y), srgbDecode(c.z)); }

// The display chain: linear * scale (2^exposure) -> tone map -> clamp -> transfer. NaN gives 0.
const int TONE_NONE = 0, TONE_REINHARD = 1, TONE_ACES = 2;
float toneMapped(float x, int kind) {
    if (kind == TONE_REINHARD) return x / (1.0 + x);
    if (kind == TONE_ACES)  // [Narkowicz 2016]
        return (x * (x * 2.51 + 0.03)) / (x * (x * 2.43 + 0.59) + 0.14);
    return x;
}
float display(float c, float scale, int toneMap, bool srgb) {
    const float x = min(greater(0.0, c * scale), 1e15);  // a finite ceiling: Inf / Inf would be NaN
    const float shown = clamp(toneMapped(x, toneMap), 0.0, 1.0);
    return srgb ? srgbEncode(shown) : shown;
}
vec3 display(vec3 c, float scale, int toneMap, bool srgb) {
    return vec3(display(c.x, scale, toneMap, srgb), display(c.y, scale, toneMap, srgb),
                display(c.z, scale, toneMap, srgb));
}

#endif
