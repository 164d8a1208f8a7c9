// fxaa1: the FXAA of the white paper.
//
//  1. pixels whose local luma contrast is high enough; the others stay as they are
//  2. orientation and steeper side
//  3. both ends of the edge, ACCELERATION pixels per read
//  4. shift across the edge by (0.5 - nearer end / both ends) px
//  5. a low-pass is mixed in where the pixel stands out of its neighbours, against sub-pixel aliasing
//
// Source: [Lottes 2009] (docs/sources.md).
// Colours: encoded. Bindings 0 to 2 and push constants: common/spatial.glsl, common/fxaa.glsl; the luma is
// green * 0.587 / 0.299 + red.
//
//   constant                preset 3   0      1      2      4, 5     means
//   10 STEPS                16         2      4      8      24, 32   reads to either side
//   11 ACCELERATION         1          4      3      2      1        px per read
//   12 EDGE_THRESHOLD       1/8        1/4    1/8    1/8    1/8      relative to the local maximum
//   13 EDGE_THRESHOLD_MIN   1/24       1/12   1/16   1/24   1/24
//   14 SUBPIX_CAP           3/4        2/3    3/4    3/4    3/4      largest weight of the low-pass
//   15 SUBPIX_TRIM          1/4        1/4    1/4    1/4    1/4      contrast below which there is none
//   16 CROSS_LOW_PASS       0          1      0      0      0        mean of 5 taps instead of 9
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/fxaa.glsl"

layout(constant_id = 10) const int STEPS = 16;
layout(constant_id = 11) const int ACCELERATION = 1;
layout(constant_id = 12) const float EDGE_THRESHOLD = 1.0 / 8.0;
layout(constant_id = 13) const float EDGE_THRESHOLD_MIN = 1.0 / 24.0;
layout(constant_id = 14) const float SUBPIX_CAP = 3.0 / 4.0;
layout(constant_id = 15) const float SUBPIX_TRIM = 1.0 / 4.0;
layout(constant_id = 16) const bool CROSS_LOW_PASS = false;

// Over `length` pixels that start `from` pixels along the line; those outside the picture are its last pixel.
float meanDifferenceOn(EdgeLine line, int from, int length) {
    const int at = line.along.x != 0 ? line.p.x : line.p.y;
    const int first = -at, last = (line.along.x != 0 ? frame.size.x : frame.size.y) - 1 - at;
    float sum = 0.0;
    for (int i = from; i < from + length; i++) sum += pairDifference(line, clamp(i, first, last));
    return sum / float(2 * length);
}
// One way along the line, `step` = -1 or 1. An unfinished search ends one step past its last read.
void search(EdgeLine line, int step, out int endHalfPx, out bool below) {
    for (int k = 0; k < STEPS; k++) {
        const int from = step > 0 ? 1 + k * ACCELERATION : -(k + 1) * ACCELERATION;
        const float change = meanDifferenceOn(line, from, ACCELERATION);
        endHalfPx = ACCELERATION + 1 + 2 * ACCELERATION * k;
        below = change < 0.0;
        if (endsLine(line, change)) return;
    }
    endHalfPx = ACCELERATION + 1 + 2 * ACCELERATION * STEPS;
}
LineEnds findEndsAccelerated(EdgeLine line) {
    LineEnds ends;
    search(line, -1, ends.negativeHalfPx, ends.negativeBelow);
    search(line, 1, ends.positiveHalfPx, ends.positiveBelow);
    return ends;
}
vec3 lowPass(ivec2 p) {
    const vec3 plus = colourAt(p) + colourAt(p + ivec2(-1, 0)) + colourAt(p + ivec2(1, 0)) +
                      colourAt(p + ivec2(0, -1)) + colourAt(p + ivec2(0, 1));
    if (CROSS_LOW_PASS) return plus * (1.0 / 5.0);
    return (plus + colourAt(p + ivec2(-1, -1)) + colourAt(p + ivec2(1, -1)) + colourAt(p + ivec2(-1, 1)) +
            colourAt(p + ivec2(1, 1))) * (1.0 / 9.0);
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (!insidePicture(p)) return;

    // 1. edge
    Neighbourhood l = crossOf(p);
    if (!isEdge(l, EDGE_THRESHOLD, EDGE_THRESHOLD_MIN)) {
        storeResult(p, colourAt(p));
        return;
    }

    // 2. orientation and side
    addDiagonals(p, l);
    const bool horizontal = runsHorizontally(l);
    const float negativeStep = abs((horizontal ? l.n : l.w) - l.m), positiveStep = abs((horizontal ? l.s : l.e) - l.m);
    const EdgeLine line = lineBeside(p, l, horizontal, !(negativeStep >= positiveStep));

    // 3. ends, 4. shift
    const LineEnds ends = findEndsAccelerated(line);
    const vec3 shifted = shiftedColour(p, line.across, edgeShift(ends, line.own < line.side));

    // 5. low-pass
    const float around = (l.n - l.m) + (l.s - l.m) + (l.w - l.m) + (l.e - l.m);
    const float contrast = abs(around * 0.25) / rangeOf(l);
    const float share = min(SUBPIX_CAP, max(0.0, contrast - SUBPIX_TRIM) / (1.0 - SUBPIX_TRIM));
    storeResult(p, shifted + (lowPass(p) - shifted) * share);
}
