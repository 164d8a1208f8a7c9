// gpaa: geometric post-process anti-aliasing. Every edge of the geometry is drawn over the finished picture as a line
// of one pixel, and blends each pixel that it crosses with the neighbour beyond it.
//
//  1. gpaa_draw.comp: which segment each pixel follows
//  2. s = distance from the pixel centre to the segment, along y for a mostly horizontal one and along x otherwise
//  3. result = colour at the centre + sign(s) (0.5 - |s|) on that axis; s = 0 blends toward +
//
// Source: [Persson 2011] (docs/sources.md). Colours: linear BT.709, in and out.
//
//   binding                      format           holds
//   0  colourImage     texture   RGBA 16F / 32F   centre samples
//   1  Segments        buffer    {float x0, y0, z0, x1, y1, z1}   px in the un-jittered picture, y down; view z
//   2  winnerImage     texture   R 32UI           of gpaa_draw.comp
//   3  resultImage     image     RGBA 16F / 32F   the blend
//
//   constant            default
//   12 KEEP_NEAREST     false    how winnerImage counts
//
//   push constants: size, px; jitter, px, y down
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/edge_segment.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D colourImage;
layout(std430, binding = 1) readonly buffer Segments { EdgeSegment segments[]; };
layout(binding = 2) uniform usampler2D winnerImage;
layout(binding = 3) uniform writeonly image2D resultImage;
layout(constant_id = 12) const bool KEEP_NEAREST = false;
layout(push_constant) uniform Frame {
    ivec2 size;
    vec2 jitter;
} frame;

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const uint winner = texel(winnerImage, p);
    vec2 shift = vec2(0.0);
    if (winner != 0u) {
        const Line line = lineOf(segments[KEEP_NEAREST ? ~winner : winner - 1u], frame.jitter, p.y);
        const float s = minorDistance(line, p.x), c = afterSide(s) ? covered(s) : -covered(s);
        shift = line.horizontal ? vec2(0.0, c) : vec2(c, 0.0);
    }
    imageStore(resultImage, p, vec4(texelAt(colourImage, p, shift).rgb, 1.0));
}
