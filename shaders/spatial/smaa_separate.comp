// One sub-sample of a picture as a picture of its own, for SMAA S2x and 4x ([Jimenez 2012], SMAASeparatePS).
//
//   binding                  format           holds
//   0  samplesImage texture  RGBA 16F / 32F   an array, one layer per sub-sample
//   1  resultImage  image    RGBA 16F / 32F
//
//   push constants           unit
//   size                     px
//   layer
#version 460
#extension GL_GOOGLE_include_directive : require

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2DArray samplesImage;
layout(binding = 1) uniform writeonly image2D resultImage;
layout(push_constant) uniform Frame {
    ivec2 size;
    int layer;
} frame;

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    imageStore(resultImage, p, texelFetch(samplesImage, ivec3(p, frame.layer), 0));
}
