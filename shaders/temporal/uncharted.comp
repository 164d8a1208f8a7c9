// uncharted, unchartedNorm, unchartedNoSharpen: the "Uncharted TAA" baseline, which differ in their sharpening alone.
//
//  0. the current frame is un-jittered: colours read at p - jitter
//  1. motion of the nearest pixel in 3x3; history read there
//  2. colour box: mean of the 3x3 and the plus-shaped bounds; history is clipped into it toward its centre
//  3. feedback by the luminance difference, 0.925 .. 0.979; blend -> history
//  4. the blend sharpened, never fed back: sharpen_history.comp, a second pass
//
// Source: [Oliveros 2018, 3.6], after [Xu 2016] and [Pedersen 2016] (docs/sources.md).
// Colours: display-encoded, [0, 1], in and out.
// Bindings 0 to 6, push constants and constants 0 to 4: common/temporal.glsl. No other images.
//
//   constant         default
//   10 K_MIN         0.925    weight of the history where its luminance differs most
//   11 K_MAX         0.979    and where it is the current one's
//   12 NEIGHBOURHOOD rounded  window of the box (neighbourhood.glsl)
//   13 CLIP_TARGET   centre   toward what history is clipped (clip.glsl)
//   14 LUMINANCE     quarter  of the feedback (colour.glsl)
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/temporal.glsl"
#include "../common/clip.glsl"
#include "../common/colour_tile.glsl"
#include "../common/feedback.glsl"

layout(constant_id = 10) const float K_MIN = 0.925;
layout(constant_id = 11) const float K_MAX = 0.979;
layout(constant_id = 12) const int NEIGHBOURHOOD = NEIGHBOURHOOD_ROUNDED;
layout(constant_id = 13) const int CLIP_TARGET = CLIP_AABB_CENTRE;
layout(constant_id = 14) const int LUMINANCE = LUMINANCE_QUARTER;

void storeResult(ivec2 p, vec3 result) { storeBlend(p, result, 1.0, result); }

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    loadColourTile();
    if (any(greaterThanEqual(p, frame.size))) return;
    vec3 window[9];
    tileWindow(window);
    const vec3 current = window[4];
    if (frame.firstFrame != 0u) {
        storeResult(p, sanitised(current, current, vec3(0.0)));
        storeRejection(p, REJECTED_FIRST_FRAME);
        return;
    }

    // 1. reproject
    const Reprojection q = reproject(p, dilatedMotion(p));
    const vec3 history = fetchHistory(p, q);

    // 2. rectify
    const Neighbours n = neighbours(window);
    const vec3 clipped = constrain(boxOf(n, NEIGHBOURHOOD), CLIP_TARGET, meanOf(n, NEIGHBOURHOOD), current, history);

    // 3. blend
    const float k = min(luminanceFeedback(luminance(current, LUMINANCE), luminance(clipped, LUMINANCE), K_MIN, K_MAX),
                        frame.feedbackCeiling);
    const vec3 mixed = q.inside ? blend(current, clipped, k) : current;
    storeResult(p, sanitised(mixed, current, history));
    storeRejection(p, q.inside);
}
