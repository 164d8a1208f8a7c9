// accum: accumulation buffer, the mean of the jittered frames of a static scene.
//
//  1. sum += this frame's colour, until `samples` frames are in it
//  2. result = sum / frames
//
// Sources: [Haeberli 1990]; [Oliveros 2018, 3.7, appendix B] (docs/sources.md).
// Colours: linear BT.709, or displayed values. What each addition rounds off is summed beside it, so that 1e5 frames do
// not drift, as in double.
//
//   binding                      format           holds
//   0  colourImage     texture   RGBA 16F / 32F   the current frame, in the space that is averaged
//   1  sumImage        image     RGBA 32F         sum of the frames since the last reset; read and written
//   2  lostImage       image     RGBA 32F         what its roundings lost; read and written
//   3  resultImage     image     RGBA 16F / 32F   the mean
//
//   push constants    unit       of this frame
//   size              px
//   firstFrame        0 or 1     1: the sum starts anew
//   adds              0 or 1     0: `samples` frames are in the sum already
//   frames                       in the sum, this one included
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D colourImage;
layout(binding = 1, rgba32f) uniform image2D sumImage;
layout(binding = 2, rgba32f) uniform image2D lostImage;
layout(binding = 3) uniform writeonly image2D resultImage;
layout(push_constant) uniform Frame {
    ivec2 size;
    uint firstFrame;
    uint adds;
    float frames;
} frame;

// a + b as the rounded sum and what it lost, exactly (D. Knuth's TwoSum). precise: none of it may be simplified away.
void addExactly(float a, float b, out float sum, out float lost) {
    precise float s = a + b;
    precise float addedB = s - a;
    precise float error = (a - (s - addedB)) + (b - addedB);
    sum = s;
    lost = isFinite(s) ? error : 0.0;
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    vec3 sum = vec3(0.0), lost = vec3(0.0);
    if (frame.firstFrame == 0u) sum = imageLoad(sumImage, p).rgb, lost = imageLoad(lostImage, p).rgb;
    if (frame.adds != 0u) {
        const vec3 colour = texel(colourImage, p).rgb;
        for (int c = 0; c < 3; c++) {
            float now, less;
            addExactly(sum[c], colour[c], now, less);
            sum[c] = now;
            lost[c] = lost[c] + less;
        }
        imageStore(sumImage, p, vec4(sum, 0.0));
        imageStore(lostImage, p, vec4(lost, 0.0));
    }
    imageStore(resultImage, p, vec4((sum + lost) / frame.frames, 1.0));
}
