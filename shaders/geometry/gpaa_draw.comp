// gpaa, first pass: every edge of the geometry is drawn as a line of one pixel, and each pixel keeps the number of the
// segment that it will follow (gpaa.comp). A renderer may draw the segments as lines instead.
//
// For a pixel that a segment touches:
//   axis     across the segment: y for a mostly horizontal one, x otherwise
//   s        distance along that axis from the pixel centre to the segment, px; touched where |s| < 0.5
//   test     a segment behind the surface that the pixel shows is hidden (DEPTH_TEST)
// Of several segments the last in the list wins (KEEP_NEAREST off), or the nearest to the centre, the first of equals:
// a first dispatch with MARK_NEAREST finds how near, a second one which. Atomic maxima: the order of the work does not
// matter.
//
// Source: [Persson 2011] (docs/sources.md).
//
//   binding                      format    holds
//   0  depthImage      texture   R 32F     planar view z > 0 (DEPTH_TEST; otherwise any texture)
//   1  Segments        buffer    {float x0, y0, z0, x1, y1, z1}   px in the un-jittered picture, y down; view z
//   2  winnerImage     image     R 32UI    number of the segment + 1, or with KEEP_NEAREST all its bits inverted; 0 at
//                                          first: none
//   3  nearestImage    image     R 32UI    bits of the largest 0.5 - |s|; 0 at first (KEEP_NEAREST; any otherwise)
//
//   constant            default
//   10 DEPTH_TEST       1        0 off, 1 hidden behind the pixel, 2 behind the pixel and its neighbour beyond the edge
//   11 DEPTH_LIMIT      1.001    hidden beyond this times the depth shown: an edge does not hide itself
//   12 KEEP_NEAREST     false
//   13 MARK_NEAREST     false    the first of its two dispatches
//
//   push constants      unit
//   size                px
//   jitter              px       of the frame, y down
//   count                        of segments
//   segmentsPerRow               of workgroups: a multiple of 8
//   perspective         0 or 1   1: 1 / depth is linear along a segment; 0: depth is
//
// Workgroups: segmentsPerRow / 8 x ceil(count / segmentsPerRow). Eight invocations, those of one x, share a segment.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/edge_segment.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D depthImage;
layout(std430, binding = 1) readonly buffer Segments { EdgeSegment segments[]; };
layout(binding = 2, r32ui) uniform uimage2D winnerImage;
layout(binding = 3, r32ui) uniform uimage2D nearestImage;
layout(constant_id = 10) const int DEPTH_TEST = 1;
layout(constant_id = 11) const float DEPTH_LIMIT = 1.001;
layout(constant_id = 12) const bool KEEP_NEAREST = false;
layout(constant_id = 13) const bool MARK_NEAREST = false;
layout(push_constant) uniform Frame {
    ivec2 size;
    vec2 jitter;
    uint count;
    uint segmentsPerRow;
    uint perspective;
} frame;

const int DEPTH_TEST_OFF = 0, DEPTH_TEST_PIXEL = 1, DEPTH_TEST_FARTHER = 2;

float depthAt(EdgeSegment s, float t) {
    const float u = clamp(t, 0.0, 1.0);
    precise float z = frame.perspective != 0u ? 1.0 / ((1.0 - u) / s.z0 + u / s.z1) : (1.0 - u) * s.z0 + u * s.z1;
    return z;
}
bool hidden(EdgeSegment segment, Line line, float t, bool after, ivec2 p) {
    if (DEPTH_TEST == DEPTH_TEST_OFF) return false;
    float shown = texel(depthImage, p).r;
    if (DEPTH_TEST == DEPTH_TEST_FARTHER) {
        const ivec2 axis = line.horizontal ? ivec2(0, 1) : ivec2(1, 0);
        shown = greater(shown, texel(depthImage, after ? p + axis : p - axis).r);
    }
    return !(depthAt(segment, t) <= shown * DEPTH_LIMIT);
}
void touch(EdgeSegment segment, uint number, ivec2 p) {
    const Line line = lineOf(segment, frame.jitter, p.y);
    const float s = minorDistance(line, p.x), c = covered(s), t = along(line, p.x);
    if (!(c > 0.0) || !reaches(line, t) || hidden(segment, line, t, afterSide(s), p)) return;
    if (MARK_NEAREST)
        imageAtomicMax(nearestImage, p, floatBitsToUint(c));
    else if (!KEEP_NEAREST)
        imageAtomicMax(winnerImage, p, number + 1u);
    else if (floatBitsToUint(c) == imageLoad(nearestImage, p).r)
        imageAtomicMax(winnerImage, p, ~number);
}

void main() {
    const uint number = gl_GlobalInvocationID.x + frame.segmentsPerRow * gl_WorkGroupID.y;
    if (gl_GlobalInvocationID.x >= frame.segmentsPerRow || number >= frame.count) return;
    const EdgeSegment s = segments[number];
    const vec2 a = vec2(s.x0, s.y0) - frame.jitter, b = vec2(s.x1, s.y1) - frame.jitter;
    if (a == b || !isFinite(a.x) || !isFinite(a.y) || !isFinite(b.x) || !isFinite(b.y)) return;

    // Along the major axis pixel by pixel, and a pixel beyond the ends; at each the nearest row or column and those
    // beside it. More of all that where coordinates are so large that they round.
    const bool horizontal = abs(s.x1 - s.x0) > abs(s.y1 - s.y0);
    const vec2 from = horizontal ? a : a.yx, to = horizontal ? b : b.yx;
    const vec2 size = vec2(horizontal ? frame.size : frame.size.yx);
    const float largest = max(max(abs(from.x), abs(from.y)), max(abs(to.x), abs(to.y)));
    const float margin = min(1.0 + floor(largest * 4.8e-7), size.x + size.y);
    const int first = int(clamp(floor(min(from.x, to.x)) - margin, 0.0, size.x));
    const int last = int(clamp(floor(max(from.x, to.x)) + margin, -1.0, size.x - 1.0));
    const float slope = (to.y - from.y) / (to.x - from.x);
    for (int major = first + int(gl_LocalInvocationID.y); major <= last; major += 8) {
        const float nearest = floor(from.y + (float(major) + 0.5 - from.x) * slope);
        const int low = int(clamp(nearest - margin, 0.0, size.y));
        const int high = int(clamp(nearest + margin, -1.0, size.y - 1.0));
        for (int minor = low; minor <= high; minor++)
            touch(s, number, horizontal ? ivec2(major, minor) : ivec2(minor, major));
    }
}
