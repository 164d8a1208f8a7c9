// accumReject, second pass: 3x3 maximum of the depth, for the next frame.
//
//   binding 0  depthImage     texture  R 32F   planar view z > 0, background 1e10
//   binding 1  farthestImage  image    R 32F
//   push constants: size, px; texelOffset, texels, as in common/temporal.glsl
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D depthImage;
layout(binding = 1) uniform writeonly image2D farthestImage;
layout(push_constant) uniform Frame {
    ivec2 size;
    ivec2 texelOffset;
} frame;

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    float farthest = 0.0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) farthest = max(farthest, texel(depthImage, p + frame.texelOffset + ivec2(i, j)).r);
    imageStore(farthestImage, p, vec4(farthest, 0.0, 0.0, 0.0));
}
