// resolve: a reconstruction filter over the shaded sub-samples of the pixel and its neighbours. msaa and csaa end with
// it, where their samples are not simply averaged.
//
// out = sum w c / sum w over the filter's taps; colours are clamped to >= 0 before, the result after. The host makes
// the taps (resolver/methods/reference/resolve_filters.h, resolveTaps): box, tent, Gaussian, cubics, Blackman-Harris,
// sinc, Lanczos and quincunx differ in nothing else.
//
// Source: [Pettineo 2012] (docs/sources.md). Colours: linear BT.709, or displayed values (CLAMP_TO_DISPLAY).
//
//   binding                      format           holds
//   0  sampleImage     texture   RGBA 16F / 32F   colours, one layer per sub-sample
//   1  resultImage     image     RGBA 16F / 32F   the filtered colour
//   2  Taps            buffer    {int dx, dy, layer; float weight}   every sub-sample in the footprint, nearest first;
//                                                 dx, dy: its pixel, from the output's; weights sum to 1
//
//   constant               default
//   10 INVERSE_LUMINANCE   false   weights of the colours, too: 1 / (1 + luminance), BT.601
//   11 CLAMP_TO_DISPLAY    false   result at most 1: filters with negative weights leave the range of displayed values
//
//   push constants    unit
//   size              px
//   samples                      per pixel
//   tapCount
//   luminanceScale               2^exposure, applied to that luminance
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/colour.glsl"

struct Tap {
    ivec2 pixel;
    int layer;
    float weight;
};

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2DArray sampleImage;
layout(binding = 1) uniform writeonly image2D resultImage;
layout(std430, binding = 2) readonly buffer Taps { Tap taps[]; };
layout(constant_id = 10) const bool INVERSE_LUMINANCE = false;
layout(constant_id = 11) const bool CLAMP_TO_DISPLAY = false;
layout(push_constant) uniform Frame {
    ivec2 size;
    int samples;
    int tapCount;
    float luminanceScale;
} frame;

vec3 radiance(ivec2 p, int layer) {
    return greater(vec3(0.0), texelFetch(sampleImage, ivec3(clampTexel(p, frame.size), layer), 0).rgb);  // NaN: 0
}
// Mean of the pixel's own sub-samples.
vec3 boxMean(ivec2 p) {
    vec3 sum = vec3(0.0);
    for (int k = 0; k < frame.samples; k++) sum = sum + radiance(p, k);
    return sum / float(frame.samples);
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    // About the first tap, so that a constant stays constant whatever the weights round to.
    const vec3 base = radiance(p + taps[0].pixel, taps[0].layer);
    vec3 sum = vec3(0.0);
    float total = 0.0;
    for (int i = 0; i < frame.tapCount; i++) {
        const Tap tap = taps[i];
        const vec3 c = radiance(p + tap.pixel, tap.layer);
        float w = tap.weight;
        if (INVERSE_LUMINANCE) w = w / (1.0 + luma601(c) * frame.luminanceScale);
        sum = sum + (c - base) * w;
        total = total + w;
    }
    // Negative lobes may cancel the sum: then the box is left.
    vec3 result = greater(vec3(0.0), abs(total) >= 1e-5 ? base + sum / total : boxMean(p));
    if (CLAMP_TO_DISPLAY) result = min(result, vec3(1.0));
    imageStore(resultImage, p, vec4(result, 1.0));
}
