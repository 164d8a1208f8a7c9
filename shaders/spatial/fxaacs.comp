// fxaacs: FXAA for compute shaders.
//
//  1. pixels whose range of log luma reaches a threshold; the others stay as they are
//  2. orientation and steeper side; equal gradients: the positive side
//  3. both ends of the edge
//  4. shift across it as far as the ends say or, rounded to 7 bits, as the pixel stands out of its 3x3; a mix with the
//     one neighbour across the edge
//
// Source: [Stanard n.d.] (docs/sources.md). Its queues of horizontal and vertical pixels hold every pixel once: one
// gather pass gives the same.
// Colours: linear, or encoded (blended in that space). Bindings 0 to 2 and push constants: common/spatial.glsl,
// common/fxaa.glsl; the luma is log2(1 + 15 Y) / 4. Constants 10 to 22: common/fxaa_search.glsl.
//
//   constant                default   means
//   23 CONTRAST_THRESHOLD   0.175     least range of log luma that makes an edge
//   24 SUBPIXEL_REMOVAL     0.5       removal of sub-pixel aliasing, 0 off
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/fxaa_search.glsl"

layout(constant_id = 23) const float CONTRAST_THRESHOLD = 0.175;
layout(constant_id = 24) const float SUBPIXEL_REMOVAL = 0.5;

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (!insidePicture(p)) return;

    // 1. edge
    Neighbourhood l = crossOf(p);
    if (!isEdge(l, 0.0, CONTRAST_THRESHOLD)) {
        storeResult(p, colourAt(p));
        return;
    }

    // 2. orientation and side
    addDiagonals(p, l);
    const bool horizontal = runsHorizontally(l);
    const float negativeStep = abs((horizontal ? l.n : l.w) - l.m), positiveStep = abs((horizontal ? l.s : l.e) - l.m);
    const EdgeLine line = lineBeside(p, l, horizontal, positiveStep >= negativeStep);

    // 3. ends
    const LineEnds ends = findEnds(line);

    // 4. shift
    const float contrast = smoothed(contrastOf(l));
    const int code = int(floor(254.0 * clamp(contrast * contrast * SUBPIXEL_REMOVAL * 2.0, 0.0, 1.0))) & ~1;
    const float shiftPx = max(float(code) * (0.5 / 254.0), edgeShift(ends, line.own < line.side));
    storeResult(p, shiftedColour(p, line.across, shiftPx > 0.01 ? shiftPx : 0.0));
}
