// SMAA, pass 1 of 3: edge bits of every pixel's left and top border ([Jimenez 2012], reference shader v2.8).
//
//  1. difference to the left and to the upper neighbour: of luma, of the colour's largest channel, or relative of depth
//  2. threshold, raised where an auxiliary pass has no edge (predication)
//  3. local contrast: an edge goes where a neighbouring edge is LOCAL_CONTRAST times as strong (not for depth)
//
// Colours: encoded, [0, 1]. Outside the picture lies its edge, repeated.
//
//   binding                       format           holds
//   0  colourImage    texture     RGBA 16F / 32F   encoded colour (unused with KIND 2: any texture)
//   1  depthImage     texture     R 32F            planar view z > 0 (KIND 2 or PREDICATION 1, otherwise any texture)
//   2  objectIdImage  texture     R 32UI           (PREDICATION 2, otherwise any texture of unsigned integers)
//   3  edgesImage     image       R 32UI           bit 0: left border, bit 1: top border
//
//   constant                  default   means
//   10 KIND                   0         0 luma BT.709, 1 colour, 2 depth
//   11 PREDICATION            0         0 off, 1 depth, 2 object ids
//   12 CONSISTENT             false     colour: the second neighbour is compared with the first, as for luma, not with
//                                       the centre
//   13 THRESHOLD              0.1       encoded units; LOW 0.15, MEDIUM and HIGH 0.1, ULTRA 0.05; of depth relative
//   14 LOCAL_CONTRAST         2         factor
//   15 PREDICATION_THRESHOLD  0.01      relative difference of depth that is an edge of that pass
//   16 PREDICATION_SCALE      2         factor on THRESHOLD
//   17 PREDICATION_STRENGTH   0.4       share taken off again at edges of that pass
//
//   push constants            unit
//   size                      px
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/image.glsl"
#include "../common/luma.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D colourImage;
layout(binding = 1) uniform sampler2D depthImage;
layout(binding = 2) uniform usampler2D objectIdImage;
layout(binding = 3) uniform writeonly uimage2D edgesImage;
layout(constant_id = 10) const int KIND = 0;
layout(constant_id = 11) const int PREDICATION = 0;
layout(constant_id = 12) const bool CONSISTENT = false;
layout(constant_id = 13) const float THRESHOLD = 0.1;
layout(constant_id = 14) const float LOCAL_CONTRAST = 2.0;
layout(constant_id = 15) const float PREDICATION_THRESHOLD = 0.01;
layout(constant_id = 16) const float PREDICATION_SCALE = 2.0;
layout(constant_id = 17) const float PREDICATION_STRENGTH = 0.4;
layout(push_constant) uniform Frame {
    ivec2 size;
} frame;

const int KIND_LUMA = 0, KIND_COLOUR = 1, KIND_DEPTH = 2;
const int PREDICATION_OFF = 0, PREDICATION_DEPTH = 1, PREDICATION_OBJECT = 2;
const uint LEFT = 1u, TOP = 2u;

// What the test compares: luma and depth stand in x.
vec3 comparedAt(ivec2 p) {
    if (KIND == KIND_DEPTH) return vec3(texel(depthImage, p).r, 0.0, 0.0);
    const vec3 c = texel(colourImage, p).rgb;
    return KIND == KIND_COLOUR ? c : vec3(lumaOf(c, LUMA_REC709), 0.0, 0.0);
}
float relativeDifference(float u, float v) { return abs(u - v) / max(1e-12, min(u, v)); }
float difference(vec3 u, vec3 v) {
    if (KIND == KIND_COLOUR) return maxComponent(abs(u - v));
    return KIND == KIND_DEPTH ? relativeDifference(u.x, v.x) : abs(u.x - v.x);
}
// Threshold of one direction: doubled, and lowered again where the auxiliary plane has an edge.
float predicated(ivec2 p, ivec2 q) {
    if (PREDICATION == PREDICATION_OFF) return THRESHOLD;
    const float high = PREDICATION_SCALE * THRESHOLD, low = high * (1.0 - PREDICATION_STRENGTH);
    if (PREDICATION == PREDICATION_OBJECT) return texel(objectIdImage, p) != texel(objectIdImage, q) ? low : high;
    const float relative = relativeDifference(texel(depthImage, p).r, texel(depthImage, q).r);
    return relative >= PREDICATION_THRESHOLD ? low : high;
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const ivec2 west = ivec2(-1, 0), north = ivec2(0, -1);

    // 1. and 2.
    const vec3 own = comparedAt(p), ownLeft = comparedAt(p + west), ownTop = comparedAt(p + north);
    const float left = difference(own, ownLeft), top = difference(own, ownTop);
    bool isLeft = left >= predicated(p, p + west), isTop = top >= predicated(p, p + north);

    // 3.
    if (KIND != KIND_DEPTH && (isLeft || isTop)) {
        const bool fromCentre = KIND == KIND_COLOUR && !CONSISTENT;
        const float right = difference(own, comparedAt(p - west)), bottom = difference(own, comparedAt(p - north));
        const float leftLeft = difference(fromCentre ? own : ownLeft, comparedAt(p + 2 * west));
        const float topTop = difference(fromCentre ? own : ownTop, comparedAt(p + 2 * north));
        const float strongest = max(max(max(left, top), max(right, bottom)), max(leftLeft, topTop));
        isLeft = isLeft && LOCAL_CONTRAST * left >= strongest;
        isTop = isTop && LOCAL_CONTRAST * top >= strongest;
    }
    imageStore(edgesImage, p, uvec4((isLeft ? LEFT : 0u) | (isTop ? TOP : 0u), 0u, 0u, 0u));
}
