// Where a pixel was a frame ago, and what the history holds there. Motion is current - previous position, in px, y down,
// without jitter: the history lies at p - motion.
//
// Displacements, never absolute positions: the fraction is then exact at any x, and whole motion an exact shift. NaN
// rejects history.
#ifndef AA_REPROJECT
#define AA_REPROJECT
#include "image.glsl"

struct Reprojection {
    ivec2 whole;  // texels from p
    vec2 part;    // and the rest, in [0, 1)
    bool inside;  // the picture, its edge included; otherwise the displacement is 0, so that reading is allowed
};
Reprojection displaced(vec2 d, bool inside) {
    if (!inside) d = vec2(0.0);
    const vec2 whole = floor(d);
    return Reprojection(ivec2(whole), d - whole, inside);
}
// At most a texel and a half beyond the picture: there and farther away every texel read is its edge.
Reprojection displacedWithinReach(ivec2 p, vec2 d, ivec2 size, bool known) {
    const vec2 low = -(vec2(p) + 2.0), high = low + vec2(size + 3);
    return displaced(known ? min(max(d, low), high) : d, known);
}
// `clampOutside`: a position outside is as good as one inside, unless nobody knows the motion: more than two pictures.
Reprojection reproject(ivec2 p, vec2 motion, ivec2 size, bool clampOutside) {
    const vec2 centre = vec2(p) + 0.5, low = -centre, high = vec2(size) - centre, d = -motion;
    if (clampOutside)
        return displacedWithinReach(p, d, size, abs(d.x) <= float(2 * size.x) && abs(d.y) <= float(2 * size.y));
    return displaced(d, d.x >= low.x && d.x <= high.x && d.y >= low.y && d.y <= high.y);
}
// The texel that contains the position: for depths, ids and counts, which must not be interpolated.
ivec2 nearestTexel(ivec2 p, Reprojection q) {
    return p + q.whole + ivec2(q.part.x >= 0.5 ? 1 : 0, q.part.y >= 0.5 ? 1 : 0);
}

vec4 fetchBilinear(sampler2D history, ivec2 p, Reprojection q) {
    return texelAt(history, p, vec2(q.whole) + q.part);
}
// By the texture unit (8 bits of fraction on most cards).
vec4 filterBilinear(sampler2D history, ivec2 p, Reprojection q) {
    return textureLod(history, (vec2(p + q.whole) + 0.5 + q.part) / vec2(textureSize(history, 0)), 0.0);
}

// Weights of the texels -1, 0, 1, 2 about a fraction f.
vec4 catmullRomWeights(float f) {
    return vec4(f * (-0.5 + f * (1.0 - 0.5 * f)), 1.0 + f * f * (-2.5 + 1.5 * f), f * (0.5 + f * (2.0 - 1.5 * f)),
                f * f * (-0.5 + 0.5 * f));
}
// The polynomial of FSR for Lanczos-2, by squared distance.
float lanczos2(float distanceSquared) {
    const float x2 = min(distanceSquared, 4.0), a = x2 * 0.4 - 1.0, b = x2 * 0.25 - 1.0;
    return (a * a * 1.5625 - 0.5625) * (b * b);
}
vec4 lanczosWeights(float f) {
    return vec4(lanczos2((1.0 + f) * (1.0 + f)), lanczos2(f * f), lanczos2((1.0 - f) * (1.0 - f)),
                lanczos2((2.0 - f) * (2.0 - f)));
}
// 4 x 4 texels of weight wx[i] wy[j]. `corners` false leaves out the four corners (the "5-tap" form). `normalise` divides
// by the sum of the weights. `clamped` holds the sum in the range of the four central texels, and >= 0.
vec3 fetch4x4(sampler2D history, ivec2 p, Reprojection q, vec4 wx, vec4 wy, bool corners, bool normalise, bool clamped) {
    const ivec2 o = p + q.whole;
    const vec3 own = texel(history, o).rgb;
    if (q.part == vec2(0.0)) return own;
    const float inner = wx.y + wx.z, all4 = corners ? inner + (wx.x + wx.w) : 1.0;
    vec3 sum = vec3(0.0), low = vec3(0.0), high = vec3(0.0);
    float norm = 0.0;
    for (int j = 0; j < 4; j++) {
        const bool outer = j == 0 || j == 3;
        const ivec2 r = o + ivec2(0, j - 1);
        const vec3 t1 = texel(history, r).rgb, t2 = texel(history, r + ivec2(1, 0)).rgb;
        vec3 line = t1 * wx.y + t2 * wx.z;
        if (corners || !outer)
            line = line + texel(history, r - ivec2(1, 0)).rgb * wx.x + texel(history, r + ivec2(2, 0)).rgb * wx.w;
        if (j == 1) low = min(t1, t2), high = max(t1, t2);
        if (j == 2) low = min(low, min(t1, t2)), high = max(high, max(t1, t2));
        sum = sum + line * wy[j];
        norm = norm + (!corners && outer ? wy[j] * inner : wy[j] * all4);
    }
    if (normalise) sum = sum * (1.0 / norm);
    return clamped ? max(clamp(sum, low, high), vec3(0.0)) : sum;
}
vec3 fetchCatmullRom(sampler2D history, ivec2 p, Reprojection q, bool corners, bool clamped) {
    return fetch4x4(history, p, q, catmullRomWeights(q.part.x), catmullRomWeights(q.part.y), corners, !corners, clamped);
}

// By number: 2 x 2; Catmull-Rom over 4 x 4, without corners; the same as published, without the clamp.
const int HISTORY_BILINEAR = 0, HISTORY_CATMULL_ROM = 1, HISTORY_CATMULL_ROM_5 = 2, HISTORY_CATMULL_ROM_FREE = 3,
          HISTORY_CATMULL_ROM_5_FREE = 4;
vec3 fetchHistory(sampler2D history, ivec2 p, Reprojection q, int kind, bool hardware) {
    if (kind == HISTORY_BILINEAR) return (hardware ? filterBilinear(history, p, q) : fetchBilinear(history, p, q)).rgb;
    return fetchCatmullRom(history, p, q, kind == HISTORY_CATMULL_ROM || kind == HISTORY_CATMULL_ROM_FREE,
                           kind == HISTORY_CATMULL_ROM || kind == HISTORY_CATMULL_ROM_5);
}

#endif
