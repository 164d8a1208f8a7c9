// Weights of the history, blends, and what keeps a broken value from living in the history for ever.
#ifndef AA_FEEDBACK
#define AA_FEEDBACK
#include "image.glsl"

// From the relative difference of luminance ([Pedersen 2016], after T. Lottes).
float luminanceFeedback(float current, float history, float kMin, float kMax) {
    const float d = min(abs(current - history) / max(max(current, history), 0.2), 1.0), u = 1.0 - d;
    return kMin + (kMax - kMin) * (u * u);
}
// k = 0 and k = 1 are exact.
vec3 blend(vec3 current, vec3 history, float k) {
    return k == 0.0 ? current : k == 1.0 ? history : history + (current - history) * (1.0 - k);
}
// Each colour weighted by 1 / (1 + luminance), against fireflies [Karis 2014].
vec3 inverseLuminanceBlend(vec3 current, float luminanceCurrent, vec3 history, float luminanceHistory, float k) {
    const float wc = (1.0 - k) * (1.0 + max(0.0, luminanceHistory)), wh = k * (1.0 + max(0.0, luminanceCurrent));
    return blend(current, history, wh / (wc + wh));
}
// A blend that is no number becomes the current colour, that of a broken current pixel its history.
vec3 sanitised(vec3 blended, vec3 current, vec3 history) {
    if (isFinite(blended)) return blended;
    return isFinite(current) ? current : isFinite(history) ? history : vec3(0.0);
}

#endif
