// accumReject: running mean along the motion, forgotten where the surface was not visible before; no colour constraint.
// A reference among the temporal methods: what identity (depth, object ids) alone can do.
//
//  1. q = p - motion   2. rejected where q is outside, where the previous frame shows only nearer surfaces around q, or
//  no pixel of this object   3. N = N(q) + 1, capped at 1e5 at rest and 16 in motion; out = h + (c - h) / N
// The mean is a compensated pair of floats, so that 1e5 frames lose nothing. With depth test 0 a pixel at rest accepts
// any pixel of the previous 3x3 (accum_reject_farthest.comp) that is as far as it: the jitter alone moves a silhouette.
//
// Sources: after [Nehab 2007] and [Stejmar n.d., 3.6.2] (docs/sources.md).
// Colours: linear BT.709, >= 0, in and out.
// Bindings 0 to 6, push constants and constants 0 to 4: common/temporal.glsl, and
//
//   binding                           format       holds
//   7  previousDepthImage   texture   R 32F        what `nextDepthImage` was a frame ago
//   8  nextDepthImage       image     R 32F        view depth of this frame as it was read
//   9  residualImage        texture   RGBA 32F     what `nextResidualImage` was a frame ago
//   10 nextResidualImage    image     RGBA 32F     what the mean in `nextImage` lacks; alpha: N
//   11 farthestImage        texture   R 32F        3x3 maximum of the previous depth (depth test 0; otherwise any)
//   12 objectImage          texture   R 32UI       object ids (OBJECT_IDS; otherwise any)
//   13 previousObjectImage  texture   R 32UI       of the previous frame
//
//   constant             default
//   10 DEPTH_TEST        0         0 window at rest, else the interpolated point; 1 the point alone; 2 none
//   11 DEPTH_TOLERANCE   0.08      share of the expected depth
//   12 MAGNIFICATION     0         share of the footprint (rejection.glsl); 0: not tested
//   13 BOTH_SIDES        0         nearer surfaces are rejected, too
//   14 OBJECT_IDS        1
//   15 N_MAX_STATIC      100000    most frames in the mean of a pixel at rest
//   16 N_MAX_MOVING      16        and of a moving one
//   17 HALF_HISTORY      0         histories are RGBA 16F: the residual holds what that rounds off
//   DILATION 0, HISTORY_FILTER 0
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/temporal.glsl"
#include "../common/feedback.glsl"
#include "../common/rejection.glsl"

layout(binding = 7) uniform sampler2D previousDepthImage;
layout(binding = 8) uniform writeonly image2D nextDepthImage;
layout(binding = 9) uniform sampler2D residualImage;
layout(binding = 10) uniform writeonly image2D nextResidualImage;
layout(binding = 11) uniform sampler2D farthestImage;
layout(binding = 12) uniform usampler2D objectImage;
layout(binding = 13) uniform usampler2D previousObjectImage;
layout(constant_id = 10) const int DEPTH_TEST = 0;
layout(constant_id = 11) const float DEPTH_TOLERANCE = 0.08;
layout(constant_id = 12) const float MAGNIFICATION = 0.0;
layout(constant_id = 13) const bool BOTH_SIDES = false;
layout(constant_id = 14) const bool OBJECT_IDS = true;
layout(constant_id = 15) const float N_MAX_STATIC = 100000.0;
layout(constant_id = 16) const float N_MAX_MOVING = 16.0;
layout(constant_id = 17) const bool HALF_HISTORY = false;

const int DEPTH_TEST_WINDOW = 0, DEPTH_TEST_OFF = 2;

float asStored(float mean) { return HALF_HISTORY ? unpackHalf2x16(packHalf2x16(vec2(mean, 0.0))).x : mean; }
// mean + residual, updated by (c - mean) / n without loss: Knuth's two-sum keeps what the mean's format cannot hold.
void compensatedStep(float c, float n, inout float mean, inout float residual) {
    precise float change = residual + (c - mean - residual) / n;
    precise float exact = mean + change;
    precise float sum = asStored(exact);
    precise float taken = sum - mean;
    precise float lost = (mean - (sum - taken)) + (change - taken);
    residual = lost;
    mean = sum;
}

void store(ivec2 p, vec3 mean, float depth, vec3 residual, float count, float reason) {
    storeBlend(p, mean, 1.0, mean);
    imageStore(nextDepthImage, p, vec4(depth, 0.0, 0.0, 0.0));
    imageStore(nextResidualImage, p, vec4(residual, count));
    storeRejection(p, reason);
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const vec3 current = colourAt(p);
    const float depth = depthAt(p);
    if (frame.firstFrame != 0u) {
        store(p, sanitised(current, current, vec3(0.0)), depth, vec3(0.0), 1.0, REJECTED_FIRST_FRAME);
        return;
    }

    // reproject
    const vec2 motion = dilatedMotion(p);
    const Reprojection q = reproject(p, motion);
    const ivec2 nearest = nearestTexel(p, q);
    const vec3 history = fetchHistory(p, q);
    vec3 residual = fetchBilinear(residualImage, p, q).rgb;

    // validate
    const bool still = motion == vec2(0.0);
    float reason = q.inside ? REJECTED_NOT : REJECTED_OUTSIDE;
    if (DEPTH_TEST != DEPTH_TEST_OFF && reason == REJECTED_NOT) {
        const float expected = expectedPreviousDepth(depth, p);
        bool hidden = disoccluded(expected, fetchDepth(previousDepthImage, p, q), DEPTH_TOLERANCE, BOTH_SIDES);
        // Behind a moving silhouette the window would pass what it uncovers.
        if (DEPTH_TEST == DEPTH_TEST_WINDOW && still)
            hidden = hidden && disoccluded(expected, texel(farthestImage, nearest).r, DEPTH_TOLERANCE, false);
        if (hidden) reason = REJECTED_DISOCCLUDED;
    }
    if (MAGNIFICATION > 0.0 && reason == REJECTED_NOT && magnified(q, footprint(motionSlope(p), 1.0), MAGNIFICATION))
        reason = REJECTED_MAGNIFIED;
    if (OBJECT_IDS && reason == REJECTED_NOT &&
        idLost(previousObjectImage, texel(objectImage, p + frame.texelOffset), nearest))
        reason = REJECTED_OTHER_OBJECT;
    const bool valid = reason == REJECTED_NOT;

    // accumulate
    const float count = valid ? min(texel(residualImage, nearest).a + 1.0, still ? N_MAX_STATIC : N_MAX_MOVING) : 1.0;
    vec3 mean = history;
    for (int c = 0; c < 3; c++) compensatedStep(current[c], count, mean[c], residual[c]);
    const bool ok = valid && isFinite(mean) && isFinite(residual);
    store(p, sanitised(valid ? mean : current, current, history), depth, ok ? residual : vec3(0.0), count, reason);
}
