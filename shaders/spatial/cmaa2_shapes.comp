// CMAA2, pass 2 of 3: every pixel's four edges, and the line that steps there (version 2.3 [Strugar 2018]).
//
//  1. right and lower edges of the pixel and of its left and upper neighbours -> its four edges
//  2. pixels with two adjacent edges are candidates: a Z shape is scored by the edges around it
//  3. both arms of the line are traced; they must be about equally long
//
//   binding                  format   holds
//   0  edgesImage  texture   R 32UI   pass 1: bit 0 right border, bit 1 lower border
//   1  shapesImage image     R 32UI   common/cmaa2.glsl
//
//   constant                 default  unit
//   10 LONGEST               86       px, of an arm
//
//   push constants           unit
//   size                     px
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/cmaa2.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform usampler2D edgesImage;
layout(binding = 1) uniform writeonly uimage2D shapesImage;
layout(constant_id = 10) const int LONGEST = 86;
layout(push_constant) uniform Frame {
    ivec2 size;
} frame;

uint storedEdges(ivec2 p) {
    if (any(lessThan(p, ivec2(0))) || any(greaterThanEqual(p, frame.size))) return 0u;
    return texelFetch(edgesImage, p, 0).r;
}
uint edgesAt(ivec2 p) {
    return storedEdges(p) | (storedEdges(p - ivec2(1, 0)) & RIGHT) << 2 | (storedEdges(p - ivec2(0, 1)) & BOTTOM) << 2;
}
bool edgeAt(ivec2 p, uint side) {
    if (side == LEFT) return (storedEdges(p - ivec2(1, 0)) & RIGHT) != 0u;
    if (side == TOP) return (storedEdges(p - ivec2(0, 1)) & BOTTOM) != 0u;
    return (storedEdges(p) & side) != 0u;
}
// By 90 degrees so that what pointed up points right: a vertical line becomes a horizontal one.
uint turned(uint edges) { return (edges << 1 | edges >> 3) & EDGES; }

// The edges of a pixel as numbers.
struct EdgesOf {
    int right, bottom, left, top;
};
EdgesOf edgesOf(uint e) { return EdgesOf(int(e & 1u), int(e >> 1 & 1u), int(e >> 2 & 1u), int(e >> 3 & 1u)); }

// Scores in tenths, which are exact.
struct ZScore {
    int inverted, normal;
};
// `own` is the pixel left of the step; m1, p1 and p2 lie -1, +1 and +2 px along the line.
ZScore zScore(uint ownBits, uint m1Bits, uint p1Bits, uint p2Bits) {
    const EdgesOf own = edgesOf(ownBits), m1 = edgesOf(m1Bits), p1 = edgesOf(p1Bits), p2 = edgesOf(p2Bits);
    return ZScore(own.right * own.bottom * p1.top *
                      (20 + 10 * (m1.bottom + p2.top) - 10 * (own.top + p1.bottom) -
                       7 * (p2.bottom + m1.top + own.left + p1.right)),
                  own.right * own.top * p1.bottom *
                      (20 + 10 * (m1.top + p2.bottom) - 10 * (own.bottom + p1.top) -
                       7 * (p2.top + m1.bottom + own.left + p1.right)));
}
ZShape zShape(ivec2 p, uint edges) {
    ZShape z = ZShape(false, true, false, 0, 1, 1);
    int best = 0;
    if ((edges & RIGHT) != 0u) {
        const ZScore s =
            zScore(edges, edgesAt(p - ivec2(1, 0)), edgesAt(p + ivec2(1, 0)), edgesAt(p + ivec2(2, 0)));
        best = max(s.inverted, s.normal);
        z.inverted = s.inverted > s.normal;
    }
    if ((edges & TOP) != 0u) {
        const ZScore s = zScore(turned(edges), turned(edgesAt(p + ivec2(0, 1))), turned(edgesAt(p - ivec2(0, 1))),
                                turned(edgesAt(p - ivec2(0, 2))));
        const int vertical = max(s.inverted, s.normal);
        if (vertical > best) {
            best = vertical;
            z.horizontal = false;
            z.inverted = s.inverted > s.normal;
        }
    }
    if (best <= 0) return z;
    z.quality = min((40 - best) / 10, 3);
    const ivec2 along = alongLine(z.horizontal);
    const uint upper = z.horizontal ? TOP : LEFT, lower = z.horizontal ? BOTTOM : RIGHT;
    const uint traceLeft = z.inverted ? lower : upper, traceRight = z.inverted ? upper : lower;
    bool goLeft = true, goRight = true;
    while (goLeft || goRight) {
        goLeft = goLeft && edgeAt(p - along * z.left, traceLeft);
        goRight = goRight && edgeAt(p + along * (z.right + 1), traceRight);
        z.left += int(goLeft);
        z.right += int(goRight);
        const int longer = max(z.left, z.right), shorter = min(z.left, z.right);
        // The arms must be about equally long: the search ends at 1.25 * shorter - 0.25.
        if (longer >= LONGEST || 4 * longer >= 5 * shorter - 1) break;
    }
    z.left -= z.quality;
    z.right -= z.quality;
    z.found = z.left + z.right >= 5;
    return z;
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const uint edges = edgesAt(p);
    imageStore(shapesImage, p, uvec4(hasCorner(edges) ? packed(edges, zShape(p, edges)) : edges, 0u, 0u, 0u));
}
