// deaa, first pass: the box resolve, and the pixels whose samples are not all of one colour. Then spatial/deaa.comp.
//
// Source: [Iourcha 2009], reconstructed (docs/sources.md).
// Colours: linear, >= 0.
//
//   binding                    format           holds
//   0  sampleImages  textures  RGBA 16F / 32F   the sub-samples, one layer each
//   1  resultImage   image     RGBA 16F / 32F   their mean
//   2  edgeImage     image     R 32UI           1 where they differ
//
//   constant          default   means
//   10 SAMPLES        8
//   11 SAME_COLOUR    0.01      samples within this difference are one surface
//
//   push constants    unit
//   size              px
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2DArray sampleImages;
layout(binding = 1) uniform writeonly image2D resultImage;
layout(binding = 2) uniform writeonly uimage2D edgeImage;
layout(constant_id = 10) const int SAMPLES = 8;
layout(constant_id = 11) const float SAME_COLOUR = 0.01;
layout(push_constant) uniform Frame {
    ivec2 size;
} frame;

vec3 sampleAt(ivec2 p, int k) { return texelFetch(sampleImages, ivec3(p, k), 0).rgb; }

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    // As deviations from the first: a constant stays exactly itself.
    const vec3 first = sampleAt(p, 0);
    vec3 sum = vec3(0.0), lowest = first, highest = first;
    for (int k = 1; k < SAMPLES; k++) {
        const vec3 c = sampleAt(p, k);
        sum = sum + (c - first);
        lowest = lesser(lowest, c);
        highest = greater(highest, c);
    }
    imageStore(resultImage, p, vec4(first + sum * (1.0 / float(SAMPLES)), 1.0));
    imageStore(edgeImage, p, uvec4(maxComponent(highest - lowest) > SAME_COLOUR ? 1u : 0u));
}
