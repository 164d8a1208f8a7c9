// Squared error: sums over pixels and channels of (T - R)^2 and of R^2, one pair per workgroup. The host adds them in
// double, in order, and divides by 3 width height: MSE, and with it PSNR and SNR.
//
// Source: conventions 13.1. Colours: display-encoded, in [0, 1].
// Workgroups of 16 x 16.
//
//   binding                 format     holds
//   0  testImage       tex  RGBA 32F   T
//   1  referenceImage  tex  RGBA 32F   R
//   2  Sums            buf  vec2       of each workgroup, row by row: sum of (T - R)^2, of R^2
//
//   push constants: size, px
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/group_sum.glsl"
#include "../common/image.glsl"

const int GROUP = 16;
layout(local_size_x = GROUP, local_size_y = GROUP) in;
layout(binding = 0) uniform sampler2D testImage;
layout(binding = 1) uniform sampler2D referenceImage;
layout(binding = 2, std430) writeonly buffer Sums { vec2 sums[]; };
layout(push_constant) uniform Frame { ivec2 size; } frame;

float squares(vec3 v) { return v.x * v.x + v.y * v.y + v.z * v.z; }

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    float error = 0.0, power = 0.0;
    if (all(lessThan(p, frame.size))) {
        const vec3 reference = texel(referenceImage, p).rgb;
        error = squares(texel(testImage, p).rgb - reference);
        power = squares(reference);
    }
    const float errorSum = groupSum(error), powerSum = groupSum(power);
    if (gl_LocalInvocationIndex == 0u) sums[groupNumber(frame.size.x, GROUP)] = vec2(errorSum, powerSum);
}
