// raptor: the full TAA of the Vulkan book, whose engine is called Raptor; every option of its text.
//
//  1. motion of the nearest pixel in 3x3   2. history by Catmull-Rom   3. 3x3 bounds, moments, filtered current colour
//  4. outside: the filtered current colour   5. YCoCg: chroma range from the luma range
//  6. constraint: clamp, clip, variance clip, or clamp then variance clip
//  7. weights 0.1 / 0.9   8. temporal filtering: more history where contrast is high
//  9. luminance of compressed colours c / (1 + max c)   10. luminance difference, in place of 7 and 8
//  11. weights 1 / (1 + L)   12. blend
//  Afterwards raptor_sharpen.comp sharpens what is shown.
//
// Source: [Castorina 2023] (docs/sources.md).
// Colours: linear BT.709, >= 0, in and out.
// Bindings 0 to 6, push constants and constants 0 to 4: common/temporal.glsl, and
//
//   binding               format   holds
//   7  CurrentFilter      buffer   weights of the 3x3 current samples about this frame's jitter, row-major; their sum
//                                  may be 0: then the centre alone
//
//   constant                  default
//   10 CONSTRAINT             4        0 none, 1 clamp, 2 clip, 3 variance clip, 4 clamp then variance clip
//   11 LUMINANCE_DIFFERENCE   1        step 10: 0 off, 1 corrected, 2 as printed (history and current exchanged)
//   12 TEMPORAL_FILTERING     1        step 8
//   13 YCOCG                  0
//   14 LUMINANCE_WEIGHTS      1        step 11
//   15 CLAMP_CURRENT          1        the filtered current colour is held within the window's bounds
//   16 SIGNED_DIVISOR         0        step 8 divides by the colour as it is; 0: by at least 1e-4
//   17 GAMMA                  1        half width of the variance box in sigma
//   18 K_MIN                  0.88     step 10: weight of the history where its luminance differs most, 0..1
//   19 K_MAX                  0.97     and where it is the current colour's
//   DILATION 0, HISTORY_FILTER 1
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/temporal.glsl"
#include "../common/clip.glsl"
#include "../common/feedback.glsl"

layout(binding = 7, std430) readonly buffer CurrentFilter { float currentFilter[9]; };
layout(constant_id = 10) const int CONSTRAINT = 4;
layout(constant_id = 11) const int LUMINANCE_DIFFERENCE = 1;
layout(constant_id = 12) const bool TEMPORAL_FILTERING = true;
layout(constant_id = 13) const bool YCOCG = false;
layout(constant_id = 14) const bool LUMINANCE_WEIGHTS = true;
layout(constant_id = 15) const bool CLAMP_CURRENT = true;
layout(constant_id = 16) const bool SIGNED_DIVISOR = false;
layout(constant_id = 17) const float GAMMA = 1.0;
layout(constant_id = 18) const float K_MIN = 0.88;
layout(constant_id = 19) const float K_MAX = 0.97;

const int CONSTRAINT_NONE = 0, CONSTRAINT_CLAMP = 1, CONSTRAINT_CLIP = 2, CONSTRAINT_VARIANCE_CLIP = 3;
const int LUMINANCE_DIFFERENCE_OFF = 0, LUMINANCE_DIFFERENCE_CORRECTED = 1;

vec3 toBoxSpace(vec3 c) { return YCOCG ? toYcocg(c) : c; }
vec3 fromBoxSpace(vec3 c) { return max(YCOCG ? fromYcocg(c) : c, vec3(0.0)); }
float lumaOf(vec3 c) { return YCOCG ? c.x : luma709(c); }
vec3 compressed(vec3 c) { return c * (1.0 / (1.0 + max(0.0, maxComponent(c)))); }

vec3 constrained(Box bounds, Box variance, vec3 h) {
    if (CONSTRAINT == CONSTRAINT_NONE) return h;
    if (CONSTRAINT == CONSTRAINT_CLAMP) return clamp(h, bounds.low, bounds.high);
    if (CONSTRAINT == CONSTRAINT_CLIP) return clipToCentre(bounds, h);
    if (CONSTRAINT == CONSTRAINT_VARIANCE_CLIP) return clipToCentre(variance, h);
    return clipToCentre(variance, clamp(h, bounds.low, bounds.high));
}
// Weight of the history with weights 1 / (1 + L): k / (1 + Lh) against (1 - k) / (1 + Lc), both times (1 + Lc) (1 + Lh).
float weighted(float weight, float lumaCurrent, float lumaHistory) {
    const float w = min(weight, frame.feedbackCeiling), wh = w * (1.0 + lumaCurrent);
    return LUMINANCE_WEIGHTS ? wh / ((1.0 - w) * (1.0 + lumaHistory) + wh) : w;
}
void storeResult(ivec2 p, vec3 result) { storeBlend(p, result, 1.0, result); }

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const vec3 raw = colourAt(p);
    if (frame.firstFrame != 0u) {
        storeResult(p, sanitised(raw, raw, vec3(0.0)));
        storeRejection(p, REJECTED_FIRST_FRAME);
        return;
    }

    // 1, 2
    const Reprojection q = reproject(p, dilatedMotion(p));
    const vec3 past = fetchHistory(p, q), history = toBoxSpace(past);

    // 3. all about the centre: a constant stays exactly itself
    vec3 window[9];
    for (int k = 0; k < 9; k++) window[k] = toBoxSpace(k == 4 ? raw : colourAt(p + ivec2(k % 3 - 1, k / 3 - 1)));
    const vec3 centre = window[4];
    Box bounds = Box(centre, centre);
    vec3 filtered = vec3(0.0);
    float weights = currentFilter[4];
    for (int k = 0; k < 9; k++) {
        if (k == 4) continue;
        bounds.low = min(bounds.low, window[k]), bounds.high = max(bounds.high, window[k]);
        filtered = filtered + (window[k] - centre) * currentFilter[k];
        weights = weights + currentFilter[k];
    }
    vec3 current = centre;
    if (weights > 1e-6) {
        current = centre + filtered * (1.0 / weights);
        if (CLAMP_CURRENT) current = clamp(current, bounds.low, bounds.high);
    }

    // 5, 6
    if (YCOCG) {
        const float chroma = (bounds.high.x - bounds.low.x) * 0.125;
        bounds.low = vec3(bounds.low.x, current.yz - chroma);
        bounds.high = vec3(bounds.high.x, current.yz + chroma);
    }
    const vec3 held = constrained(bounds, varianceBox(moments(window), GAMMA), history);

    // 9
    const float lumaCurrent = max(0.0, lumaOf(compressed(current))), lumaHistory = max(0.0, lumaOf(compressed(held)));
    vec3 mixed;
    if (LUMINANCE_DIFFERENCE == LUMINANCE_DIFFERENCE_OFF) {
        // 7, 8: weight of the history per channel
        vec3 k = vec3(0.9);
        if (TEMPORAL_FILTERING) {
            const vec3 divisor = SIGNED_DIVISOR ? current : max(current, vec3(1e-4));
            // 0 / 0 as printed is no number: no contrast
            const vec3 contrast = lesser(greater(vec3(0.0), abs(bounds.high - bounds.low) / divisor), vec3(1.0));
            k = vec3(0.25) + contrast * 0.6;
        }
        for (int c = 0; c < 3; c++) {
            const float w = weighted(k[c], lumaCurrent, lumaHistory);
            mixed[c] = blend(current, held, w)[c];
        }
    } else {  // 10 replaces both
        const float k = LUMINANCE_DIFFERENCE == LUMINANCE_DIFFERENCE_CORRECTED
                            ? luminanceFeedback(lumaCurrent, lumaHistory, K_MIN, K_MAX)
                            : 1.0 - luminanceFeedback(lumaCurrent, lumaHistory, 0.0, 1.0);
        mixed = blend(current, held, weighted(k, lumaCurrent, lumaHistory));  // 11, 12
    }

    const vec3 result = q.inside ? fromBoxSpace(mixed) : fromBoxSpace(current);  // 4
    storeResult(p, sanitised(result, raw, past));
    storeRejection(p, q.inside);
}
