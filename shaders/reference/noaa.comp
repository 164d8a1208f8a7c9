// noaa: no anti-aliasing, the lower baseline. The colour samples as they are.
//
//   binding                      format           holds
//   0  colourImage     texture   RGBA 16F / 32F   linear BT.709
//   1  resultImage     image     RGBA 16F / 32F   the same
//
//   push constants: size, px
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D colourImage;
layout(binding = 1) uniform writeonly image2D resultImage;
layout(push_constant) uniform Frame {
    ivec2 size;
} frame;

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    imageStore(resultImage, p, vec4(texel(colourImage, p).rgb, 1.0));
}
