// master, pass 1 (step S): how much of an edge each texel of the jittered frame is, from three pictures at once.
//
//  1. |G| by the Sobel operator of albedo luminance, lit luminance and depth
//  2. g = clamp(WEIGHT_ALBEDO |G albedo| + WEIGHT_LIT |G lit| + |G depth|, 0, 1), and sqrt(g^2 (3 - 2 g))
//
// Source: [Oliveros 2018, 4.3.3, eqs 3.4 to 3.6 with factor 1, 4.9, 4.10] (docs/sources.md).
// Colours: display-encoded, [0, 1].
//
//   binding              format           holds
//   0  currentImage tex  RGBA 16F / 32F   the jittered frame
//   1  albedoImage  tex  RGBA 16F / 32F   its albedo
//   2  depthImage   tex  R 32F            planar view z > 0, background 1e10
//   3  sobelImage   img  R 32F            the Sobel value, [0, 1]
//
//   constant            default
//   10 WEIGHT_ALBEDO    0.3
//   11 WEIGHT_LIT       0.7
//   12 DEPTH_UNIT       normalised        (depth_unit.glsl)
//   13 LUMINANCE        quarter           (colour.glsl)
//   push constants: size, px; farDepth, scene units
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/colour.glsl"
#include "../common/depth_unit.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D currentImage;
layout(binding = 1) uniform sampler2D albedoImage;
layout(binding = 2) uniform sampler2D depthImage;
layout(binding = 3) uniform writeonly image2D sobelImage;
layout(constant_id = 10) const float WEIGHT_ALBEDO = 0.3;
layout(constant_id = 11) const float WEIGHT_LIT = 0.7;
layout(constant_id = 12) const int DEPTH_UNIT = DEPTH_NORMALISED;
layout(constant_id = 13) const int LUMINANCE = LUMINANCE_QUARTER;
layout(push_constant) uniform Frame {
    ivec2 size;
    float farDepth;
} frame;

const int SIDE = 10;             // the workgroup's texels and one more on each side
shared vec3 tile[SIDE * SIDE];  // albedo luminance, lit luminance, depth

// |G| of each of the three; c is the middle of the window.
vec3 sobelMagnitude(int c) {
    const vec3 nw = tile[c - SIDE - 1], n = tile[c - SIDE], ne = tile[c - SIDE + 1], w = tile[c - 1], e = tile[c + 1],
               sw = tile[c + SIDE - 1], s = tile[c + SIDE], se = tile[c + SIDE + 1];
    const vec3 gx = (ne - nw) + (se - sw) + ((e - w) + (e - w));
    const vec3 gy = (nw - sw) + (ne - se) + ((n - s) + (n - s));
    return sqrt(gx * gx + gy * gy);
}
// A sum that is no number counts as aliased.
float sobelCurve(float weightedSum) {
    const float g = isFinite(weightedSum) ? clamp(weightedSum, 0.0, 1.0) : 1.0;
    return sqrt(g * g * (3.0 - (g + g)));
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy), first = ivec2(gl_WorkGroupID.xy) * 8 - 1;
    for (int k = int(gl_LocalInvocationIndex); k < SIDE * SIDE; k += 64) {
        const ivec2 q = clampTexel(first + ivec2(k % SIDE, k / SIDE), frame.size);
        tile[k] = vec3(luminance(texelFetch(albedoImage, q, 0).rgb, LUMINANCE),
                       luminance(texelFetch(currentImage, q, 0).rgb, LUMINANCE),
                       inDepthUnit(texelFetch(depthImage, q, 0).r, frame.farDepth, DEPTH_UNIT));
    }
    barrier();
    if (any(greaterThanEqual(p, frame.size))) return;
    const vec3 g = sobelMagnitude((int(gl_LocalInvocationID.y) + 1) * SIDE + int(gl_LocalInvocationID.x) + 1);
    imageStore(sobelImage, p, vec4(sobelCurve(g.x * WEIGHT_ALBEDO + g.y * WEIGHT_LIT + g.z), 0.0, 0.0, 0.0));
}
