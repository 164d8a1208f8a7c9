// dlaa, second pass: directionally localised anti-aliasing, after spatial/dlaa_edges.comp.
//
//  1. short edges: blur along the direction in which the other direction's high-pass is strong
//  2. long edges, where the strength over 16 px in one direction dominates: shift across the edge so that the luma
//     matches the blur along it
//  3. pixels in the midst of strong edges stay as they are (PRESERVE_HIGHLIGHTS)
//
// Source: [Andreev 2011], public ports (docs/sources.md). Bilinear taps at half pixels are written as the pixels that
// they average. Where a decision of the method jumps without a visible cause, it fades over what 8 bits cannot tell.
// Colours: encoded. Bindings 0 and 1 and push constants: common/spatial.glsl.
//
//   binding                format    holds
//   2  edgeImage  texture  RG 32F    strength of edges in [0, 1], luma
//
//   constant                 default   means
//   10 LAMBDA                3         gain of the short-edge masks
//   11 EPSILON               0.1       contrast below which short edges are left alone
//   12 LONG_THRESHOLD        0.2       by how much one direction must dominate a long edge
//   13 PRESERVE_HIGHLIGHTS   0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/colour.glsl"
#include "../common/spatial.glsl"

layout(binding = 2) uniform sampler2D edgeImage;
layout(constant_id = 10) const float LAMBDA = 3.0;
layout(constant_id = 11) const float EPSILON = 0.1;
layout(constant_id = 12) const float LONG_THRESHOLD = 0.2;
layout(constant_id = 13) const bool PRESERVE_HIGHLIGHTS = false;

const int REACH_PX = 8;                 // that the blur along a long edge reads to either side
const float EQUAL_LUMAS = 0.5 / 255.0;  // half a code: the ratio of a shift goes to 1, its value at 0
const float FADE = 1.0 / 255.0;         // of a mask or of the shares of a shift
const ivec2 ALONG_X = ivec2(1, 0), ALONG_Y = ivec2(0, 1);

float saturate(float x) { return clamp(x, 0.0, 1.0); }
vec2 edgeAt(ivec2 p) { return texel(edgeImage, p).rg; }
float strengthAt(ivec2 p) { return edgeAt(p).x; }

// ---- short edges ----------------------------------------------------------------------------------------------------
// Twice the sum of two bilinear taps at -+1.5 px is the sum of the four pixels at -+1 and -+2; here minus 4 times the
// centre, which keeps constants exact.
vec3 wideDifference(ivec2 p, ivec2 d, vec3 c) {
    return ((colourAt(p - d) - c) + (colourAt(p + d) - c)) + ((colourAt(p - 2 * d) - c) + (colourAt(p + 2 * d) - c));
}
// How strongly an edge that runs the other way calls for this blur.
float shortStrength(vec3 difference) { return LAMBDA * luma709(abs(difference) * 0.25) - EPSILON; }
float shortMaskOf(float strength, vec3 blur) {
    const float level = luma709(blur);
    if (!(level > 0.0)) return strength > 0.0 ? 1.0 : 0.0;
    return saturate(strength / max(1e-12, level));
}

// ---- long edges -----------------------------------------------------------------------------------------------------
// Means of strength and luma at the taps at -+1.5, -+3.5, -+5.5, -+7.5 px: of 16 pixels.
vec2 meanOf16(ivec2 p, ivec2 d) {
    vec2 sum = vec2(0.0);
    for (int i = 1; i <= REACH_PX; i++) sum = sum + (edgeAt(p - i * d) + edgeAt(p + i * d));
    return sum * (1.0 / 16.0);
}
// The share of the pixel's own colour in its mix with a neighbour that gives it the luma of the blur: 1 + (blur - own)
// / (own - neighbour). Where both have one luma that is 1, no shift; nearly equal lumas have no meaningful ratio and go
// there continuously.
float shareOfOwn(float blurMinusOwn, float ownMinusNeighbour) {
    return saturate(1.0 + blurMinusOwn * ownMinusNeighbour /
                              max(ownMinusNeighbour * ownMinusNeighbour, EQUAL_LUMAS * EQUAL_LUMAS));
}
// The shift across a long edge whose luma matches the blur along it, from the neighbours before and behind.
vec3 shiftedBy(float missing, vec3 before, vec3 c, vec3 behind, inout float sum) {
    const float near = shareOfOwn(missing, luma709(c - before)), far = shareOfOwn(missing, luma709(c - behind));
    sum = sum + near + far;
    const vec3 mixed = before + (c - before) * near;
    return behind + (mixed - behind) * far;
}
vec3 longEdges(ivec2 p, vec3 centre, vec3 c, float maskH, float maskV, float missingH, float missingV) {
    float sum = 0.0;
    const vec3 vertical = shiftedBy(missingV, colourAt(p - ALONG_X), centre, colourAt(p + ALONG_X), sum);
    const vec3 horizontal = shiftedBy(missingH, colourAt(p - ALONG_Y), centre, colourAt(p + ALONG_Y), sum);
    const float shifts = saturate(sum * (1.0 / FADE));  // all four zero: no shift
    c = c + (centre + (vertical - centre) * shifts - c) * maskV;
    return c + (centre + (horizontal - centre) * shifts - c) * maskH;
}

// ---- highlights -----------------------------------------------------------------------------------------------------
float bilinearCorner(ivec2 p, int across, int down) {  // tap at (-+1.5, -+1.5), fourfold
    return (strengthAt(p + ivec2(across, down)) + strengthAt(p + ivec2(2 * across, down))) +
           (strengthAt(p + ivec2(across, 2 * down)) + strengthAt(p + ivec2(2 * across, 2 * down)));
}
float highlightMask(ivec2 p) {
    const float corners =
        bilinearCorner(p, 1, 1) + bilinearCorner(p, 1, -1) + bilinearCorner(p, -1, 1) + bilinearCorner(p, -1, -1);
    float cross = strengthAt(p);
    for (int i = 1; i <= 2; i++)
        cross = cross + (strengthAt(p - i * ALONG_X) + strengthAt(p + i * ALONG_X)) +
                (strengthAt(p - i * ALONG_Y) + strengthAt(p + i * ALONG_Y));
    return saturate((corners + cross) * (3.0 / 25.0) - 1.5);
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (!insidePicture(p)) return;
    const vec3 centre = colourAt(p);

    // 1. short edges
    const vec3 wideH = wideDifference(p, ALONG_X, centre), wideV = wideDifference(p, ALONG_Y, centre);
    const vec3 blurH = centre + wideH * (1.0 / 6.0), blurV = centre + wideV * (1.0 / 6.0);
    const float maskH = shortMaskOf(shortStrength(wideH), blurV), maskV = shortMaskOf(shortStrength(wideV), blurH);
    vec3 c = centre + (blurH - centre) * maskV;
    c = c + (blurV - c) * (maskH * 0.5);  // half: the two passes would over-blur

    // 2. long edges
    const vec2 meanH = meanOf16(p, ALONG_X), meanV = meanOf16(p, ALONG_Y);
    const float longH = saturate(meanH.x * 2.0 - 1.0), longV = saturate(meanV.x * 2.0 - 1.0);
    const float dominance = saturate((abs(longH - longV) - LONG_THRESHOLD) * (1.0 / FADE));
    if (dominance > 0.0) {
        const float own = edgeAt(p).y;
        c = longEdges(p, centre, c, longH * dominance, longV * dominance, meanH.y - own, meanV.y - own);
    }

    // 3. highlights
    if (PRESERVE_HIGHLIGHTS) c = c + (centre - c) * highlightMask(p);
    storeResult(p, c);
}
