// The sharpening that uncharted and master show their blend with; the blend itself stays the history.
//
//   shown = clamp(c + GAIN (4 c - the four neighbours), 0, 1)
//
// Sources: GAIN 1 [Oliveros 2018, eq 3.1], after [Xu 2016]; GAIN 1/4 [Oliveros 2018, eq 4.17] (docs/sources.md).
// Colours: display-encoded, [0, 1], in and out.
//
//   binding              format           holds
//   0  blendImage   tex  RGBA 16F / 32F   the blend of this frame
//   1  resultImage  img  RGBA 16F / 32F   what is shown
//
//   constant 10 GAIN     0.25             of each of the four neighbours
//   push constants: size, px
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D blendImage;
layout(binding = 1) uniform writeonly image2D resultImage;
layout(constant_id = 10) const float GAIN = 0.25;
layout(push_constant) uniform Frame { ivec2 size; } frame;

const int SIDE = 10;  // the workgroup's pixels and one more on each side
shared vec3 tile[SIDE * SIDE];

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy), first = ivec2(gl_WorkGroupID.xy) * 8 - 1;
    for (int k = int(gl_LocalInvocationIndex); k < SIDE * SIDE; k += 64)
        tile[k] = texel(blendImage, first + ivec2(k % SIDE, k / SIDE)).rgb;
    barrier();
    if (any(greaterThanEqual(p, frame.size))) return;
    const int c = (int(gl_LocalInvocationID.y) + 1) * SIDE + int(gl_LocalInvocationID.x) + 1;
    const vec3 around = (tile[c - 1] + tile[c + 1]) + (tile[c - SIDE] + tile[c + SIDE]);
    const vec3 sharpened = tile[c] + (tile[c] * 4.0 - around) * GAIN;
    imageStore(resultImage, p, vec4(clamp(sharpened, 0.0, 1.0), 1.0));
}
