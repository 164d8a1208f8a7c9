// +sharpen: a method's output sharpened; never fed back.
//
//   xu, norm: c + gain (4 c - the four neighbours), gain 1 or 1/4
//   lumaPost: c L' / L, where L' = L + AMOUNT (L - mean L of 3x3)
//
// Sources: xu [Oliveros 2018, eq 3.1], norm [Oliveros 2018, eq 4.17], lumaPost [Castorina 2023] (docs/sources.md).
// Colours: the method's output space, display-encoded or linear BT.709. A linear result is held in the range of its 3x3
// window, so that a firefly cannot be multiplied by five.
//
//   binding              format           holds
//   0  methodImage  tex  RGBA 16F / 32F   the method's output
//   1  resultImage  img  RGBA 16F / 32F   what is shown
//
//   constant             default
//   10 FILTER            norm    0 xu, 1 norm, 2 lumaPost
//   11 RANGE             display what a result is held in: 0 [0, 1], 1 the range of its 3x3 window and >= 0, 2 >= 0
//   12 AMOUNT            1       of lumaPost
//   push constants: size, px
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/colour.glsl"

const int FILTER_XU = 0, FILTER_NORM = 1, FILTER_LUMA_POST = 2;
const int RANGE_DISPLAY = 0, RANGE_NEIGHBOURHOOD = 1;

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D methodImage;
layout(binding = 1) uniform writeonly image2D resultImage;
layout(constant_id = 10) const int FILTER = FILTER_NORM;
layout(constant_id = 11) const int RANGE = RANGE_DISPLAY;
layout(constant_id = 12) const float AMOUNT = 1.0;
layout(push_constant) uniform Frame { ivec2 size; } frame;

// window[(j + 1) * 3 + i + 1] is the colour of the neighbour (x + i, y + j).
vec3 crossSharpened(vec3 window[9]) {
    const vec3 c = window[4], excess = (c - window[1]) + (c - window[7]) + (c - window[3]) + (c - window[5]);
    return c + excess * (FILTER == FILTER_NORM ? 0.25 : 1.0);
}
vec3 lumaSharpened(vec3 window[9]) {
    const vec3 c = window[4];
    const float luma = luma709(c);
    float excess = 0.0;  // 9 (L - mean)
    for (int k = 0; k < 9; k++) excess = excess + (luma - luma709(window[k]));
    const float target = greater(0.0, luma + excess * (AMOUNT / 9.0));
    return luma >= 1e-6 ? c * (target / greater(1e-6, luma)) : c;
}
vec3 withinNeighbourhood(vec3 window[9], vec3 sharp) {
    vec3 lowest = window[4], highest = window[4];
    for (int k = 0; k < 9; k++) lowest = lesser(lowest, window[k]), highest = greater(highest, window[k]);
    return lesser(highest, greater(lowest, sharp));
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    vec3 window[9];
    for (int k = 0; k < 9; k++) window[k] = texel(methodImage, p + ivec2(k % 3 - 1, k / 3 - 1)).rgb;
    vec3 sharp = FILTER == FILTER_LUMA_POST ? lumaSharpened(window) : crossSharpened(window);
    if (RANGE == RANGE_NEIGHBOURHOOD) sharp = withinNeighbourhood(window, sharp);
    sharp = greater(vec3(0.0), sharp);
    if (RANGE == RANGE_DISPLAY) sharp = lesser(vec3(1.0), sharp);
    imageStore(resultImage, p, vec4(sharp, 1.0));
}
