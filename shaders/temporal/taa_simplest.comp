// taaSimplest: the current colour blended with its reprojected history, nothing else.
//
//  1. the history at p - motion, the pixel's own motion
//  2. blend with a constant weight; where the position lies outside the picture, the current colour
//
// Source: [Castorina 2023, "The simplest TAA implementation"] (docs/sources.md).
// Colours: linear BT.709, >= 0, in and out.
// Bindings 0 to 6, push constants and constants 0 to 4: common/temporal.glsl (DILATION and depth are not read).
//
//   constant    default
//   10 FEEDBACK 0.9      weight of the history
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/temporal.glsl"
#include "../common/feedback.glsl"

layout(constant_id = 10) const float FEEDBACK = 0.9;

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const vec3 current = colourAt(p);
    if (frame.firstFrame != 0u) {
        const vec3 first = sanitised(current, current, vec3(0.0));
        storeBlend(p, first, 1.0, first);
        storeRejection(p, REJECTED_FIRST_FRAME);
        return;
    }
    const Reprojection q = reproject(p, motionAt(p));
    const vec3 history = fetchHistory(p, q);
    const vec3 mixed = q.inside ? blend(current, history, min(FEEDBACK, frame.feedbackCeiling)) : current;
    const vec3 result = sanitised(mixed, current, history);
    storeBlend(p, result, 1.0, result);
    storeRejection(p, q.inside);
}
