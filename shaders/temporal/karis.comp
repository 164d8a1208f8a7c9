// karis, salvi, falcor, donut: one skeleton in linear HDR, four published sets of choices.
//
//  1. current colour: 3x3 samples weighted by their distance to the pixel centre (exp(-2.29 d^2)) and by 1 / (1 + Y)
//  2. colour box in YCoCg or RGB: min/max, mean -+ gamma sigma, or both
//  3. history clipped into it, toward the filtered centre (karis) or the mean (salvi), or clamped (falcor, donut)
//  4. weight of the current colour, with an anti-flicker rule; 5. blend with weights 1 / (1 + Y)
//
// Sources: [Karis 2014], [Salvi 2016], [Falcor 2022], [Donut 2021] (docs/sources.md).
// Colours: linear BT.709, >= 0, in and out. Donut's box and history hold PQ values.
// Bindings 0 to 6, push constants and constants 0 to 5: common/temporal.glsl.
//
//   7  weights          buffer   9 float    of the 3x3 samples by distance, row-major: exp(-2.29 d^2), d = |offset + jitter|
//                                           in px; once a frame on the host, as the engine does (read where FILTERED)
//
//   constant             karis  salvi  falcor  donut
//   10 ALPHA             0.04   0.1    0.1     0.1      weight of the current colour
//   11 FILTERED          1      1      0       0        step 1
//   12 TONE_WEIGHTED     1      1      0       0        weights 1 / (1 + Y) within it
//   13 TONE_HDR4         0      0      0       0        4 / (4 + Y) instead
//   14 YCOCG             1      0      1       0
//   15 BOX               0      1      1       1        0 min/max, 1 variance, 2 both
//   16 GAMMA             1      1      1       1        half width of the variance box in sigma
//   17 NEIGHBOURHOOD     0      -      -       -        of the min/max box: 0 rounded, 1 3x3, 2 plus
//   18 CONSTRAINT        0      1      2       2        0 clip to the filtered centre, 1 to the mean, 2 clamp
//   19 ANTI_FLICKER      1      0      2       0        1 karis, 2 falcor
//   20 INVERSE_LUMINANCE 1      1      0       0        step 5
//   21 PQ                0      0      0       1
//   DILATION             1      0      2       2        HISTORY_FILTER: 0 0 2 2
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/temporal.glsl"
#include "../common/clip.glsl"
#include "../common/feedback.glsl"
#include "../common/math.glsl"

layout(std430, binding = 7) readonly buffer Weights { float weights[9]; };
layout(constant_id = 10) const float ALPHA = 0.04;
layout(constant_id = 11) const bool FILTERED = true;
layout(constant_id = 12) const bool TONE_WEIGHTED = true;
layout(constant_id = 13) const bool TONE_HDR4 = false;
layout(constant_id = 14) const bool YCOCG = true;
layout(constant_id = 15) const int BOX = 0;
layout(constant_id = 16) const float GAMMA = 1.0;
layout(constant_id = 17) const int NEIGHBOURHOOD = 0;
layout(constant_id = 18) const int CONSTRAINT = 0;
layout(constant_id = 19) const int ANTI_FLICKER = 1;
layout(constant_id = 20) const bool INVERSE_LUMINANCE = true;
layout(constant_id = 21) const bool PQ = false;

const int BOX_MINMAX = 0, BOX_VARIANCE = 1, BOX_INTERSECTION = 2;
const int CONSTRAINT_CLIP_FILTERED = 0, CONSTRAINT_CLIP_MEAN = 1, CONSTRAINT_CLAMP = 2;
const int ANTI_FLICKER_KARIS = 1, ANTI_FLICKER_FALCOR = 2;

vec3 ownColour(ivec2 p) {
    const vec3 c = colourAt(p);
    return PQ ? pqEncode(c) : c;
}
vec3 toBoxSpace(vec3 c) { return YCOCG ? toYcocg(c) : c; }
vec3 fromBoxSpace(vec3 c) { return max(YCOCG ? fromYcocg(c) : c, vec3(0.0)); }
float lumaOf(vec3 c) { return YCOCG ? c.x : luma709(c); }

float toneWeight(float y) {
    if (!TONE_WEIGHTED) return 1.0;
    return TONE_HDR4 ? 4.0 / (4.0 + max(0.0, y)) : 1.0 / (1.0 + max(0.0, y));
}
float filterWeight(int k, vec3 c) { return weights[k] * toneWeight(lumaOf(c)); }
// Public UE4: speed raises the current colour's weight to 0.2; nearly equal luminance takes the current colour.
float karisWeight(float alpha, vec2 motion, float current, float history) {
    const float speed = sqrt(motion.x * motion.x + motion.y * motion.y);
    const float moving = lerpExact(alpha, 0.2, clamp(speed * (1.0 / 40.0), 0.0, 1.0));
    return max(moving, clamp(history * 0.01 / max(abs(current - history), 1e-4), 0.0, 1.0));
}
// Falcor: less of the current colour where history lies near the end of a wide box.
float falcorWeight(float alpha, float low, float high, float history) {
    const float toClamp = min(abs(low - history), abs(high - history)), sum = toClamp + (high - low);
    return sum <= 1e-12 ? alpha : clamp(alpha * toClamp / sum, 0.0, 1.0);
}
void storeResult(ivec2 p, vec3 result) { storeBlend(p, result, 1.0, PQ ? pqDecode(result) : result); }

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const vec3 raw = ownColour(p);
    if (frame.firstFrame != 0u) {
        storeResult(p, sanitised(raw, raw, vec3(0.0)));
        storeRejection(p, REJECTED_FIRST_FRAME);
        return;
    }
    vec3 window[9];
    for (int k = 0; k < 9; k++) window[k] = toBoxSpace(k == 4 ? raw : ownColour(p + ivec2(k % 3 - 1, k / 3 - 1)));
    const vec3 centre = window[4];

    // 1. as deviations from the centre: a constant stays exactly itself
    vec3 current = centre;
    if (FILTERED) {
        vec3 sum = vec3(0.0);
        float total = 0.0;
        for (int k = 0; k < 9; k++) {
            if (k == 4) continue;
            const float w = filterWeight(k, window[k]);
            sum = sum + (window[k] - centre) * w;
            total = total + w;
        }
        current = centre + sum * (1.0 / max(total + filterWeight(4, centre), 1e-20));
    }

    // 2. box
    Moments m = Moments(centre, centre);
    Box box;
    if (BOX != BOX_MINMAX || CONSTRAINT == CONSTRAINT_CLIP_MEAN) m = moments(window);
    if (BOX != BOX_MINMAX) box = varianceBox(m, GAMMA);
    if (BOX != BOX_VARIANCE) {
        const Box bounds = boxOf(neighbours(window), NEIGHBOURHOOD);
        if (BOX == BOX_MINMAX)
            box = bounds;
        else
            box = Box(max(box.low, bounds.low), min(box.high, bounds.high));
    }
    box.low = min(box.low, box.high);

    // 3. history
    const vec2 motion = dilatedMotion(p);
    const Reprojection q = reproject(p, motion);
    const vec3 past = fetchHistory(p, q), history = toBoxSpace(past);
    const vec3 held = CONSTRAINT == CONSTRAINT_CLAMP
                          ? clamp(history, box.low, box.high)
                          : clipToward(box, CONSTRAINT == CONSTRAINT_CLIP_MEAN ? m.mean : current, history);

    // 4. weight of the current colour
    float alpha = ALPHA;
    if (ANTI_FLICKER == ANTI_FLICKER_KARIS) alpha = karisWeight(alpha, motion, lumaOf(current), lumaOf(held));
    if (ANTI_FLICKER == ANTI_FLICKER_FALCOR)
        alpha = falcorWeight(alpha, lumaOf(box.low), lumaOf(box.high), lumaOf(history));
    const float k = min(1.0 - alpha, frame.feedbackCeiling);

    // 5. blend
    const vec3 mixed = INVERSE_LUMINANCE ? inverseLuminanceBlend(current, lumaOf(current), held, lumaOf(held), k)
                                         : blend(current, held, k);
    vec3 result = fromBoxSpace(mixed);
    if (!q.inside) result = FILTERED ? fromBoxSpace(current) : raw;
    storeResult(p, sanitised(result, raw, past));
    storeRejection(p, q.inside);
}
