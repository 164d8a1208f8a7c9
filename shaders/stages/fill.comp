// +fill: where a temporal method did not use its history, the output of a spatial or geometry-aware method on the same
// frame; every other pixel keeps its bits.
//
// Source: the hybrid of [Stejmar n.d., 6.3.1] (docs/sources.md).
// Colours: the temporal method's output space; the fill is converted to it by the display chain or by its inverse.
//
//   binding                 format           holds
//   0  methodImage     tex  RGBA 16F / 32F   the temporal method's output
//   1  fillImage       tex  RGBA 16F / 32F   the other method's
//   2  rejectionImage  tex  R 32F            not 0: the history was not used
//   3  resultImage     img  RGBA 16F / 32F   what is shown
//
//   constant                default
//   10 CONVERSION           0   of the fill: 0 none, 1 linear to encoded, 2 encoded to linear
//   push constants: size, px; the display chain: scale (2^exposure), toneMap (colour.glsl), srgb 0 or 1
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/colour.glsl"

const int CONVERSION_ENCODE = 1, CONVERSION_DECODE = 2;

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D methodImage;
layout(binding = 1) uniform sampler2D fillImage;
layout(binding = 2) uniform sampler2D rejectionImage;
layout(binding = 3) uniform writeonly image2D resultImage;
layout(constant_id = 10) const int CONVERSION = 0;
layout(push_constant) uniform Frame {
    ivec2 size;
    float scale;
    int toneMap;
    uint srgb;
} frame;

vec3 converted(vec3 c) {
    if (CONVERSION == CONVERSION_ENCODE) return display(c, frame.scale, frame.toneMap, frame.srgb != 0u);
    if (CONVERSION == CONVERSION_DECODE) {
        const vec3 shown = clamp(c, 0.0, 1.0);
        return frame.srgb != 0u ? srgbDecode(shown) : shown;
    }
    return c;
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const bool rejected = texelFetch(rejectionImage, p, 0).r != 0.0;
    const vec3 c = rejected ? converted(texelFetch(fillImage, p, 0).rgb) : texelFetch(methodImage, p, 0).rgb;
    imageStore(resultImage, p, vec4(c, 1.0));
}
