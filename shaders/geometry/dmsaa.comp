// dmsaa: deferred MSAA filter. The colour is fetched beside the pixel centre, toward the sub-samples whose depth
// differs.
//
//  1. shift = sum of the offsets of the differing sub-samples, scaled (VECTOR), at most 1 px on each axis
//  2. result = colour at the centre + shift
//
// Source: [Pettineo 2010] as told in [Reshetov 2012, slide 16] (docs/sources.md). Colours: linear BT.709, in and out.
// Bindings 0 to 9, push constants and SAMPLES: common/subsamples.glsl; of them colour, depth and the sub-samples' depth
// are read.
//
//   constant             default   unit
//   10 VECTOR            0                           shift by the sum: 0 per sample, 1 per differing sample, 2 as
//                                                    long as their share
//   11 DEPTH_THRESHOLD   0.02      of the nearer's   least depth difference
//   12 GAIN              1                           factor on the shift
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/subsamples.glsl"

layout(constant_id = 10) const int VECTOR = 0;
layout(constant_id = 11) const float DEPTH_THRESHOLD = 0.02;
layout(constant_id = 12) const float GAIN = 1.0;

const int VECTOR_PER_SAMPLE = 0, VECTOR_PER_DIFFERING = 1, VECTOR_IDEAL = 2;

// Equal depths, the background's too, never differ.
bool differs(ivec2 p, int k) {
    const float z = depthOf(p, k), centre = depthOf(p, CENTRE);
    precise float least = DEPTH_THRESHOLD * lesser(z, centre);
    return abs(z - centre) > least;
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    vec2 sum = vec2(0.0);
    float count = 0.0;
    for (int k = 0; k < SAMPLES; k++) {
        if (!differs(p, k)) continue;
        sum = sum + offsetsPx[k];
        count = count + 1.0;
    }
    const float sumLength = sqrt(sum.x * sum.x + sum.y * sum.y);
    float scale = 0.0;
    if (sumLength > 1e-6) {
        if (VECTOR == VECTOR_PER_SAMPLE) scale = 1.0 / float(SAMPLES);
        if (VECTOR == VECTOR_PER_DIFFERING) scale = 1.0 / count;
        if (VECTOR == VECTOR_IDEAL) scale = count / float(SAMPLES) / sumLength;
    }
    const vec2 shift = clamp(sum * scale * GAIN, vec2(-1.0), vec2(1.0));
    imageStore(resultImage, p, vec4(texelAt(colourImage, p, shift).rgb, 1.0));
}
