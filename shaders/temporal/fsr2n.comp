// fsr2n: a temporal upscaler's accumulation at native resolution, after AMD's FSR 2; results are "FSR2-like", not FSR 2.
//
//  1. depth clip: where the surfaces that fsr2n_scatter.comp has splatted hold something nearer, the pixel was hidden;
//     by how much is graded by the separation that the depth's resolution can tell
//  2. one-pixel ridges of luma are locked: their history survives the colour box while the window's luma stays
//  3. current colour: Lanczos-2 over 3x3 around the jittered samples, deringed. Colour box: Gaussian mean and deviation
//     in YCoCg, cut with the window's bounds
//  4. blend in the tone-mapped space x / (1 + max), history read by Lanczos-2
//
// Source: [AMD 2022] (docs/sources.md).
// Colours: linear BT.709, >= 0, in and out. The history's alpha is the lifetime of the pixel's lock, 0..1.
// Bindings 0 to 6, push constants and constants 0 to 4: common/temporal.glsl, and
//
//   binding                       format   holds
//   7  nearestImage     texture   R 32UI   what fsr2n_scatter.comp has written
//   8  usualLumaImage   texture   R 32F    what `nextLumaImage` was a frame ago
//   9  nextLumaImage    image     R 32F    3x3 mean of luma that is usual along the motion
//   10 Weights          buffer    of this frame's jitter and camera: see there
//
//   constant         default
//   10 WEIGHT        0.1      of the current colour against an accumulated weight of 1
//   11 BOX_SCALE     1        half width of the colour box at rest, in sigma; 1 in motion
//   12 LOCKS         1        step 2
//   13 LOCK_DECAY    1 / 16   per frame: 1 / period of the jitter
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/temporal.glsl"
#include "../common/feedback.glsl"
#include "../common/math.glsl"
#include "../common/neighbourhood.glsl"

layout(binding = 7) uniform usampler2D nearestImage;
layout(binding = 8) uniform sampler2D usualLumaImage;
layout(binding = 9) uniform writeonly image2D nextLumaImage;
layout(binding = 10, std430) readonly buffer Weights {
    float lanczos[9];           // of the 3x3 current samples, row-major, sum 1
    float still[9], moving[9];  // of the colour box at rest and in motion, sum 1
    float separation;           // least depth difference that counts, share of the depth
    float power;                // of the graded difference
} weights;
layout(constant_id = 10) const float WEIGHT = 0.1;
layout(constant_id = 11) const float BOX_SCALE = 1.0;
layout(constant_id = 12) const bool LOCKS = true;
layout(constant_id = 13) const float LOCK_DECAY = 0.0625;

const float LEAST_SPLAT = 0.01;   // bilinear weights below it are no evidence (FSR 2)
const float SIMILAR_LUMA = 1.05;  // ratio up to which two pixels are of one ridge (FSR 2)
const float LOCKED_LUMA = 0.9;    // ratio down to which a lock's luma is unchanged (FSR 2)
const float FAST_PX = 20.0;       // speed at which box and weight are those of motion (FSR 2)

// 0: the surface was visible a frame ago. 1: something nearer stood before it.
float depthClip(ivec2 p, Reprojection q, float depth) {
    float visible = 0.0, sum = 0.0;
    for (int tap = 0; tap < 4; tap++) {
        const ivec2 d = ivec2(tap & 1, tap >> 1);
        const float found = uintBitsToFloat(texel(nearestImage, p + q.whole + d)), behind = depth - found;
        const float w = (d.x == 1 ? q.part.x : 1.0 - q.part.x) * (d.y == 1 ? q.part.y : 1.0 - q.part.y);
        if (!(behind > 0.0 && w > LEAST_SPLAT)) continue;
        const float share = min(max(depth, found) * weights.separation / behind, 1.0);
        // From 1080p on the power is 3: no logarithm.
        const float graded = weights.power == 3.0 ? share * share * share : powPositive(share, weights.power);
        visible = visible + w * graded;
        sum = sum + w;
    }
    return sum > 0.0 ? clamp(1.0 - visible / max(sum, 1e-6), 0.0, 1.0) : 0.0;
}

// A pixel brighter or darker than all that differ from it, and not part of a 2x2 block of its kind: a thin line's.
bool isRidge(vec3 window[9]) {
    const float y = window[4].x;
    float darkest = 1e30, brightest = -1e30;
    bool similar[9];
    for (int k = 0; k < 9; k++) {
        const float v = window[k].x, most = max(v, y);
        similar[k] = most < min(v, y) * SIMILAR_LUMA || most < 1e-6;
        if (similar[k]) continue;
        darkest = min(darkest, v);
        brightest = max(brightest, v);
    }
    const bool solid = (similar[0] && similar[1] && similar[3]) || (similar[1] && similar[2] && similar[5]) ||
                       (similar[3] && similar[6] && similar[7]) || (similar[5] && similar[7] && similar[8]);
    return (y > brightest || y < darkest) && !solid;
}

// The mean of h and c in the space x / (1 + max(x)), taken back. As a step from h, so that equal colours stay exact and
// nothing cancels: with H = 1 + max(h), C = 1 + max(c), P = (1 - a) C and Q = a H the mean is
// (P h + Q c) / (P + Q + least over the channels of P (H - 1 - h) + Q (C - 1 - c)).
vec3 toneMappedMean(vec3 h, vec3 c, float a) {
    const float mh = maxComponent(h), mc = maxComponent(c);
    const float P = (1.0 - a) * (1.0 + mc), Q = a * (1.0 + mh);
    const float excess = minComponent((vec3(mh) - h) * P + (vec3(mc) - c) * Q);
    const vec3 mean = h + ((c - h) * Q - h * excess) * (1.0 / (P + Q + excess));
    return a == 1.0 ? c : a == 0.0 ? h : greater(mean, vec3(0.0));
}
vec3 toRgb(vec3 c) { return max(fromYcocg(c), vec3(0.0)); }

// As FSR 2 prepares them: what a half float holds. x / (1 + max) comes so near to 1 beyond that float cannot tell one from
// another. NaN stays.
vec3 preparedColour(ivec2 p) {
    const vec3 c = colourAt(p);
    return mix(c, vec3(65504.0), greaterThan(c, vec3(65504.0)));
}

void store(ivec2 p, vec3 result, float lock, float usual, float reason) {
    storeBlend(p, result, isFinite(lock) ? lock : 0.0, result);
    imageStore(nextLumaImage, p, vec4(isFinite(usual) ? usual : 0.0, 0.0, 0.0, 0.0));
    storeRejection(p, reason);
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const vec3 raw = preparedColour(p);
    if (frame.firstFrame != 0u) {
        store(p, sanitised(raw, raw, vec3(0.0)), 0.0, toYcocg(raw).x, REJECTED_FIRST_FRAME);
        return;
    }
    vec3 window[9];
    for (int k = 0; k < 9; k++) window[k] = toYcocg(k == 4 ? raw : preparedColour(p + ivec2(k % 3 - 1, k / 3 - 1)));

    // 1
    const Surface surface = closestSurface(p, false);
    const vec2 motion = surface.motion;
    const Reprojection q = reproject(p, motion);
    const float hidden = depthClip(p, q, surface.depth);
    const float speed = sqrt(motion.x * motion.x + motion.y * motion.y);
    const float fast = clamp(speed * (1.0 / FAST_PX), 0.0, 1.0);

    // 3. as deviations from the centre
    const vec3 centre = window[4];
    vec3 filtered = vec3(0.0), m1 = vec3(0.0), m2 = vec3(0.0);
    float around = 0.0;
    Box bounds = Box(centre, centre);
    for (int k = 0; k < 9; k++) {
        if (k == 4) continue;
        const vec3 d = window[k] - centre;
        const float w = weights.still[k] + (weights.moving[k] - weights.still[k]) * fast;
        filtered = filtered + d * weights.lanczos[k];
        bounds.low = min(bounds.low, window[k]), bounds.high = max(bounds.high, window[k]);
        m1 = m1 + d * w;
        m2 = m2 + d * d * w;
        around = around + d.x;
    }
    const vec3 current = clamp(centre + filtered, bounds.low, bounds.high);
    const vec3 mean = centre + m1, sigma = sqrt(max(m2 - m1 * m1, vec3(0.0)));
    const vec3 reach = sigma * (BOX_SCALE + (1.0 - BOX_SCALE) * max(hidden, fast));
    const Box box = Box(max(bounds.low, mean - reach), min(bounds.high, mean + reach));

    // 2
    const ivec2 nearest = nearestTexel(p, q);
    const float luma = centre.x + around * (1.0 / 9.0), usual = texel(usualLumaImage, nearest).r;
    const float brighter = max(luma, usual), darker = min(luma, usual);
    const bool kept = q.inside && (darker >= brighter * LOCKED_LUMA || brighter < 1e-6);
    float lock = kept ? max(texel(historyImage, nearest).a - LOCK_DECAY, 0.0) * (1.0 - hidden) : 0.0;
    if (LOCKS && isRidge(window)) lock = 1.0;
    const bool known = q.inside && hidden <= 0.5;
    const float nextUsual = known ? usual + (luma - usual) * LOCK_DECAY : luma;

    // 4
    const vec3 past =
        fetch4x4(historyImage, p, q, lanczosWeights(q.part.x), lanczosWeights(q.part.y), true, true, true);
    const vec3 history = toYcocg(past), boxed = clamp(history, box.low, box.high);
    const vec3 held = boxed + (history - boxed) * lock;
    float accumulated = 1.0 - hidden;
    accumulated = min(accumulated, accumulated + (WEIGHT * 10.0 - accumulated) * clamp(speed * 10.0, 0.0, 1.0));
    accumulated = min(accumulated, accumulated + (WEIGHT - accumulated) * fast);
    const float alpha = max(WEIGHT / (accumulated + WEIGHT), 1.0 - frame.feedbackCeiling);
    const vec3 mixed = toneMappedMean(toRgb(held), toRgb(current), alpha);
    const vec3 result = q.inside ? mixed : toRgb(current);
    store(p, sanitised(result, raw, past), lock, nextUsual,
          known ? REJECTED_NOT : q.inside ? REJECTED_DISOCCLUDED : REJECTED_OUTSIDE);
}
