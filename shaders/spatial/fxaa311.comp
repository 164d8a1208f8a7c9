// fxaa311: FXAA 3.11 Quality.
//
//  1. pixels whose local luma contrast is high enough; the others stay as they are
//  2. does the edge run along the row or the column, and on which side is the gradient steeper?
//  3. both ends of the edge: walk along the boundary until the luma of the pair changes
//  4. shift across the boundary: (0.5 - nearer end / both ends) px, or further where the pixel stands out of its 3x3
//
// Source: [Lottes 2011] (docs/sources.md).
// Colours: encoded, or linear (blended in that space); the luma decides alone. Bindings 0 to 2 and push constants:
// common/spatial.glsl, common/fxaa.glsl. Constants 10 to 22: common/fxaa_search.glsl.
//
//   constant                default   means
//   23 EDGE_THRESHOLD       0.166     contrast that makes an edge, relative to the local maximum
//   24 EDGE_THRESHOLD_MIN   0.0833    least luma contrast that makes an edge
//   25 SUBPIX               0.75      removal of sub-pixel aliasing, 0 off
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/fxaa_search.glsl"

layout(constant_id = 23) const float EDGE_THRESHOLD = 0.166;
layout(constant_id = 24) const float EDGE_THRESHOLD_MIN = 0.0833;
layout(constant_id = 25) const float SUBPIX = 0.75;

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

    // 3. ends
    const LineEnds ends = findEnds(line);

    // 4. shift
    const float subShift = smoothed(contrastOf(l));
    const float shiftPx = max(edgeShift(ends, line.own < line.side), subShift * subShift * SUBPIX);
    storeResult(p, shiftedColour(p, line.across, shiftPx));
}
