// ssaa: supersampling, the mean of the shaded sub-samples of every pixel (a box filter one pixel wide).
//
// A sample with a NaN or an Inf in any channel is left out and the sum divided by the rest; a pixel without a finite
// sample is 0.
//
// Sources: [Leler 1980]; [Oliveros 2018, 3.5.1] (docs/sources.md).
// Colours: linear BT.709, >= 0, in; out linear, or displayed values (ENCODED: every sample goes through the display
// chain first).
//
//   binding                      format           holds
//   0  sampleImage     texture   RGBA 16F / 32F   linear colours, one layer per sub-sample
//   1  resultImage     image     RGBA 16F / 32F   their mean
//
//   constant          default
//   10 ENCODED        false      mean of displayed values
//
//   push constants    unit
//   size              px
//   samples                      per pixel
//   displayScale                 2^exposure
//   toneMap                      common/colour.glsl, TONE_...
//   srgb              0 or 1     1: sRGB's transfer; 0: none
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/colour.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2DArray sampleImage;
layout(binding = 1) uniform writeonly image2D resultImage;
layout(constant_id = 10) const bool ENCODED = false;
layout(push_constant) uniform Frame {
    ivec2 size;
    int samples;
    float displayScale;
    int toneMap;
    uint srgb;
} frame;

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    vec3 first = vec3(0.0), sum = vec3(0.0);  // about the first colour: a constant stays exactly itself
    float count = 0.0;
    for (int k = 0; k < frame.samples; k++) {
        vec3 c = texelFetch(sampleImage, ivec3(p, k), 0).rgb;
        if (!isFinite(c)) continue;
        if (ENCODED) c = display(c, frame.displayScale, frame.toneMap, frame.srgb != 0u);
        if (count == 0.0) first = c;
        sum = sum + (c - first);
        count = count + 1.0;
    }
    imageStore(resultImage, p, vec4(first + sum / max(1.0, count), 1.0));
}
