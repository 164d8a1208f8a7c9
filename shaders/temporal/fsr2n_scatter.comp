// fsr2n, first pass, from the second frame on: every surface is splatted to where it was a frame ago; the nearest one
// stays. fsr2n.comp compares with it what it sees.
//
// Bindings 0 to 6, push constants and constants 0 to 4: common/temporal.glsl (depth and motion alone are read), and
//
//   binding                      format   holds
//   7  nearestImage    image     R 32UI   bits of a view depth, cleared to those of 2^127 before. Positive floats are
//                                         ordered as integers, so the least is taken atomically, in whatever order
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/temporal.glsl"

layout(binding = 7, r32ui) uniform uimage2D nearestImage;

const float LEAST_SPLAT = 0.01;  // bilinear weights below it are no evidence (FSR 2)

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const Surface s = closestSurface(p, false);
    const Reprojection q = reproject(p, s.motion);
    if (!q.inside || !(s.depth > 0.0)) return;
    for (int tap = 0; tap < 4; tap++) {
        const ivec2 d = ivec2(tap & 1, tap >> 1), at = p + q.whole + d;
        const float w = (d.x == 1 ? q.part.x : 1.0 - q.part.x) * (d.y == 1 ? q.part.y : 1.0 - q.part.y);
        const bool within = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, frame.size));
        if (w > LEAST_SPLAT && within) imageAtomicMin(nearestImage, at, floatBitsToUint(s.depth));
    }
}
