// What every shader that filters a single picture binds. A shader that includes this adds its own images from binding 2
// on and its own constants from 10 on.
//
//   binding                   format           holds
//   0  colourImage  texture   RGBA 16F / 32F   the picture, in the method's space
//   1  resultImage  image     RGBA 16F / 32F   what is shown, or what a later pass reads
//
//   push constants            unit
//   size                      px
#ifndef AA_SPATIAL
#define AA_SPATIAL
#include "image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D colourImage;
layout(binding = 1) uniform writeonly image2D resultImage;
layout(push_constant) uniform Frame {
    ivec2 size;
} frame;

bool insidePicture(ivec2 p) { return all(greaterThanEqual(p, ivec2(0))) && all(lessThan(p, frame.size)); }
vec3 colourAt(ivec2 p) { return texel(colourImage, p).rgb; }
void storeResult(ivec2 p, vec3 c) { imageStore(resultImage, p, vec4(c, 1.0)); }

#endif
