// CMAA2, pass 1 of 3: edges between every pixel and its right and lower neighbour (version 2.3 [Strugar 2018]).
//
//  1. difference of luma, sqrt-encoded
//  2. less a share of the strongest edge that meets it at its ends; what is above the threshold remains
//
// Colours: linear BT.709, clamped to [0, 1]. Outside the picture lies its edge, repeated.
//
//   binding                  format           holds
//   0  colourImage texture   RGBA 16F / 32F   linear colour
//   1  edgesImage  image     R 32UI           bit 0: right border, bit 1: lower border
//
//   constant                 default  means
//   10 THRESHOLD             0.07     LOW 0.15, MEDIUM 0.10, HIGH 0.07, ULTRA 0.05
//   11 LOCAL_CONTRAST        0.10     share of the meeting edges; sharp 0.15
//   12 LUMA                  5        common/luma.glsl: BT.601 of square roots; 0 BT.601 where linear colours are
//                                     displayed as they are
//
//   push constants           unit
//   size                     px
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/image.glsl"
#include "../common/luma.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D colourImage;
layout(binding = 1) uniform writeonly uimage2D edgesImage;
layout(constant_id = 10) const float THRESHOLD = 0.07;
layout(constant_id = 11) const float LOCAL_CONTRAST = 0.10;
layout(constant_id = 12) const int LUMA = LUMA_LINEAR_OF_SQRT;
layout(push_constant) uniform Frame {
    ivec2 size;
} frame;

const uint RIGHT = 1u, BOTTOM = 2u;
// The tile's lumas and a pixel around it, in shared memory.
const int SIDE = 10;
shared float tile[SIDE * SIDE];
void loadTile() {
    const ivec2 first = ivec2(gl_WorkGroupID.xy) * 8 - 1;
    for (int k = int(gl_LocalInvocationIndex); k < SIDE * SIDE; k += 64)
        tile[k] = lumaOf(texel(colourImage, first + ivec2(k % SIDE, k / SIDE)).rgb, LUMA);
    barrier();
}
float lumaAt(int i, int j) {
    return tile[(int(gl_LocalInvocationID.y) + 1 + j) * SIDE + int(gl_LocalInvocationID.x) + 1 + i];
}
// Differences across the right and the lower border of the pixel (i, j) from the own one.
float rightStep(int i, int j) { return abs(lumaAt(i, j) - lumaAt(i + 1, j)); }
float bottomStep(int i, int j) { return abs(lumaAt(i, j) - lumaAt(i, j + 1)); }
bool isEdge(float step, float beside) {
    precise const float left = step - LOCAL_CONTRAST * beside;
    return left > THRESHOLD;
}

void main() {
    loadTile();
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    // The four edges that meet it at its ends.
    const float right = rightStep(0, 0), bottom = bottomStep(0, 0);
    const float besideRight = max(max(bottomStep(0, -1), bottom), max(bottomStep(1, -1), bottomStep(1, 0)));
    const float besideBottom = max(max(rightStep(-1, 0), right), max(rightStep(-1, 1), rightStep(0, 1)));
    const uint edges = (isEdge(right, besideRight) ? RIGHT : 0u) | (isEdge(bottom, besideBottom) ? BOTTOM : 0u);
    imageStore(edgesImage, p, uvec4(edges, 0u, 0u, 0u));
}
