// fxaaconsole: FXAA 3.11 Console.
//
//  1. the luma of the pixel's four corners; pixels where its range is high enough, the others stay as they are
//  2. direction of the edge from the corners
//  3. two taps near the pixel along it, and two farther ones, the farther the nearer the edge is to an axis
//  4. the mean of all four, or of the near ones where its luma lies outside the corners'
//
// Source: [Lottes 2011], console path (docs/sources.md).
// Colours: encoded. Bindings 0 and 1 and push constants: common/spatial.glsl.
//
//   constant                default   means
//   10 REACH_PX             0.5       distance of the near taps
//   11 SHARPNESS            8         how soon the far taps reach 4 px
//   12 EDGE_THRESHOLD       0.125     relative to the brightest corner
//   13 EDGE_THRESHOLD_MIN   0.05
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/luma.glsl"
#include "../common/spatial.glsl"

layout(constant_id = 10) const float REACH_PX = 0.5;
layout(constant_id = 11) const float SHARPNESS = 8.0;
layout(constant_id = 12) const float EDGE_THRESHOLD = 0.125;
layout(constant_id = 13) const float EDGE_THRESHOLD_MIN = 0.05;

float lumaAt(ivec2 p) { return lumaOf(colourAt(p), LUMA_REC601); }
vec3 bilinear(ivec2 p, vec2 offsetPx) { return texelAt(colourImage, p, offsetPx).rgb; }
float longer(float d, float smallest) {
    if (d == 0.0) return 0.0;
    return smallest > 0.0 ? clamp(d / smallest, -2.0, 2.0) : d > 0.0 ? 2.0 : -2.0;
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (!insidePicture(p)) return;
    const vec3 centre = colourAt(p);

    // 1. corners, minus the pixel's own luma
    const float m = lumaOf(centre, LUMA_REC601);
    const float n = lumaAt(p + ivec2(0, -1)) - m, s = lumaAt(p + ivec2(0, 1)) - m, w = lumaAt(p + ivec2(-1, 0)) - m,
                e = lumaAt(p + ivec2(1, 0)) - m;
    const float nw = (lumaAt(p + ivec2(-1, -1)) - m + w + n) * 0.25, sw = (lumaAt(p + ivec2(-1, 1)) - m + w + s) * 0.25,
                se = (lumaAt(p + ivec2(1, 1)) - m + e + s) * 0.25;
    // The bias keeps the direction of a saddle from vanishing.
    const float ne = (lumaAt(p + ivec2(1, -1)) - m + e + n) * 0.25 + 1.0 / 384.0;
    const float highest = max(max(nw, ne), max(sw, se)), lowest = min(min(nw, ne), min(sw, se));
    if (max(highest, 0.0) - min(lowest, 0.0) < max(EDGE_THRESHOLD_MIN, (highest + m) * EDGE_THRESHOLD)) {
        storeResult(p, centre);
        return;
    }

    // 2. direction
    vec2 d = vec2((sw - ne) + (se - nw), (sw - ne) - (se - nw));
    const float length = sqrt(d.x * d.x + d.y * d.y);
    if (!(length > 0.0)) {
        storeResult(p, centre);
        return;
    }
    d /= length;

    // 3. taps
    const float smallest = min(abs(d.x), abs(d.y)) * SHARPNESS;
    const vec2 near = d * REACH_PX, far = 2.0 * vec2(longer(d.x, smallest), longer(d.y, smallest));
    const vec3 narrow = (bilinear(p, -near) + bilinear(p, near)) * 0.5;
    const vec3 wide = narrow * 0.5 + (bilinear(p, -far) + bilinear(p, far)) * 0.25;

    // 4. which of them
    const float wideLuma = lumaOf(wide, LUMA_REC601) - m;
    storeResult(p, wideLuma < lowest || wideLuma > highest ? narrow : wide);
}
