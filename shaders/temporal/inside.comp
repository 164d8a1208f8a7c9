// inside: temporal reprojection of INSIDE.
//
//  1. current colour at the pixel centre, the jitter taken back (bilinear)   2. motion of the nearest pixel in 3x3
//  3. colour box: mean of the 3x3 and the plus-shaped bounds; or four bilinear taps on the diagonals, at 0.5 px under
//     motion and up to 0.6666 px where nothing moves
//  4. YCoCg: chroma range from the luma range   5. history clipped into the box
//  6. weight of the history by luminance difference   7. blend -> history
//  8. motion blur: what is shown, not the history, is the mean of seven taps along the motion where that exceeds 2 px
//
// Source: [Pedersen 2016] (docs/sources.md).
// Colours: displayed (encoded) values in [0, 1], in and out.
// Bindings 0 to 6, push constants and constants 0 to 4: common/temporal.glsl. No other images.
// Step 8 draws its noise by `frameNumber`.
//
//   constant                  default
//   10 K_MIN                  0.88     weight of the history where its luminance differs most, 0..1
//   11 K_MAX                  0.97     and where it is the current colour's
//   12 NEIGHBOURHOOD          0        of the box: 0 rounded, 1 3x3, 2 plus, 3 four taps
//   13 CLIP_TARGET            0        clipped toward 0 the box centre, 1 the mean, 2 the current colour; 3 clamped
//   14 UNJITTER_COLOUR        1        step 1; 0: the sample as it is
//   15 UNJITTER_NEIGHBOURHOOD 0        the box's colours, too
//   16 UNJITTER_REPROJECTION  0        the motion, too; only without dilation
//   17 YCOCG                  0
//   18 LUMINANCE              1        of step 6, without YCOCG (colour.glsl)
//   19 MOTION_BLUR            0        length of the blur in frame intervals; 0: off
//   DILATION 0, HISTORY_FILTER 0, CLAMP_OUTSIDE 0 (the game: 1)
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/temporal.glsl"
#include "../common/clip.glsl"
#include "../common/feedback.glsl"
#include "../common/noise.glsl"

layout(constant_id = 10) const float K_MIN = 0.88;
layout(constant_id = 11) const float K_MAX = 0.97;
layout(constant_id = 12) const int NEIGHBOURHOOD = 0;
layout(constant_id = 13) const int CLIP_TARGET = 0;
layout(constant_id = 14) const bool UNJITTER_COLOUR = true;
layout(constant_id = 15) const bool UNJITTER_NEIGHBOURHOOD = false;
layout(constant_id = 16) const bool UNJITTER_REPROJECTION = false;
layout(constant_id = 17) const bool YCOCG = false;
layout(constant_id = 18) const int LUMINANCE = 1;
layout(constant_id = 19) const float MOTION_BLUR = 0.0;

const int NEIGHBOURHOOD_FOUR_TAP_VARYING = 3;

vec3 fetchCurrent(ivec2 p, bool unjitter) {
    return texelAt(currentImage, p, unjitter ? -frame.jitter : vec2(0.0)).rgb;
}
vec3 toBoxSpace(vec3 c) { return YCOCG ? toYcocg(c) : c; }
float lumaOf(vec3 c) { return YCOCG ? c.x : luminance(c, LUMINANCE); }

// The current colours at p + offset px, bilinear, held to the picture.
vec3 colourAlong(ivec2 p, vec2 offset) {
    return fetchBilinear(currentImage, p, displacedWithinReach(p, offset, frame.size, isFinite(offset.x) && isFinite(offset.y))).rgb;
}
// Four bilinear taps at (+-s, +-s).
vec3 diagonalTap(ivec2 p, vec3 window[9], int i, int j, float s) {
    if (UNJITTER_NEIGHBOURHOOD) return toBoxSpace(colourAlong(p, vec2(i, j) * s - frame.jitter));
    const vec3 near = lerpExact(window[4], window[4 + i], s);
    const vec3 far = lerpExact(window[4 + 3 * j], window[4 + 3 * j + i], s);
    return lerpExact(near, far, s);
}
Box fourTapBox(ivec2 p, vec3 window[9], float s, out vec3 mean) {
    const vec3 a = diagonalTap(p, window, -1, -1, s), b = diagonalTap(p, window, 1, -1, s),
               d = diagonalTap(p, window, -1, 1, s), e = diagonalTap(p, window, 1, 1, s);
    mean = a + ((b - a) + (d - a) + (e - a)) * 0.25;
    return Box(min(min(a, b), min(d, e)), max(max(a, b), max(d, e)));
}

// What the screen shows: seven taps along the motion, offset by chance, instead of the result where motion is fast
// (2 px: none of it, 15 px: all).
vec3 blurredByMotion(ivec2 p, vec2 motion, vec3 result) {
    const float speed = sqrt(motion.x * motion.x + motion.y * motion.y);
    const float share = clamp(speed - 2.0, 0.0, 13.0) * (1.0 / 13.0);
    // A motion of more than two pictures is no motion.
    const bool known = abs(motion.x) <= float(2 * frame.size.x) && abs(motion.y) <= float(2 * frame.size.y);
    if (!known || !(share > 0.0)) return result;
    const float stepLength = MOTION_BLUR * 0.5 / 3.0;
    const float chance = noise(noiseSeed(NOISE_MOTION_BLUR, frame.frameNumber, uint(p.y)), uint(p.x)) - 0.5;
    const vec2 own = UNJITTER_COLOUR ? -frame.jitter : vec2(0.0);
    vec3 sum = vec3(0.0);
    for (int tap = -3; tap <= 3; tap++) {
        const float at = (float(tap) + chance) * stepLength;
        sum = sum + (colourAlong(p, own + motion * at) - result);
    }
    const vec3 blurred = result + sum * (share * (1.0 / 7.0));
    return isFinite(blurred) ? blurred : result;
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const vec3 raw = fetchCurrent(p, false);
    if (frame.firstFrame != 0u) {
        const vec3 current = fetchCurrent(p, UNJITTER_COLOUR), first = sanitised(current, current, vec3(0.0));
        storeBlend(p, first, 1.0, first);
        storeRejection(p, REJECTED_FIRST_FRAME);
        return;
    }

    // 1
    const vec3 currentRgb = fetchCurrent(p, UNJITTER_COLOUR), current = toBoxSpace(currentRgb);

    // 2
    const vec2 motion = UNJITTER_REPROJECTION ? texelAt(motionImage, p, -frame.jitter).rg : dilatedMotion(p);
    const Reprojection q = reproject(p, motion);
    const vec3 past = fetchHistory(p, q), history = toBoxSpace(past);

    // 3
    vec3 window[9];
    for (int k = 0; k < 9; k++)
        window[k] = toBoxSpace(fetchCurrent(p + ivec2(k % 3 - 1, k / 3 - 1), UNJITTER_NEIGHBOURHOOD));
    Box box;
    vec3 mean;
    if (NEIGHBOURHOOD == NEIGHBOURHOOD_FOUR_TAP_VARYING) {
        const float speed = sqrt(motion.x * motion.x + motion.y * motion.y);
        // By the motion of 2 times the depth: 0 * 1e10 is 0, and a far surface at any speed counts as moving.
        const float still = clamp(0.5 / max(speed * dilatedDepth(p), 1e-6), 0.0, 1.0);
        box = fourTapBox(p, window, 0.5 + still * 0.1666, mean);
    } else {
        const Neighbours around = neighbours(window);
        box = boxOf(around, NEIGHBOURHOOD);
        mean = meanOf(around, NEIGHBOURHOOD);
    }

    // 4
    if (YCOCG) {
        const float chroma = (box.high.x - box.low.x) * 0.125;
        box.low = vec3(box.low.x, current.yz - chroma);
        box.high = vec3(box.high.x, current.yz + chroma);
        mean = vec3(mean.x, current.yz);
    }

    // 5, 6, 7
    const vec3 held = constrain(box, CLIP_TARGET, mean, current, history);
    const float k = min(luminanceFeedback(lumaOf(current), lumaOf(held), K_MIN, K_MAX), frame.feedbackCeiling);
    const vec3 mixed = blend(current, held, k);
    const vec3 rgb = YCOCG ? clamp(fromYcocg(mixed), 0.0, 1.0) : mixed;
    const vec3 result = sanitised(q.inside ? rgb : currentRgb, raw, past);

    // 8
    storeBlend(p, result, 1.0, MOTION_BLUR > 0.0 ? blurredByMotion(p, motion, result) : result);
    storeRejection(p, q.inside);
}
