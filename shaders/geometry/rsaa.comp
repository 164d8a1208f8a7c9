// rsaa: resampling anti-aliasing. One shade per pixel, several geometry samples; the pixel's colour is fetched beside
// its centre, at an offset learned for the pattern of sub-samples that lie on another surface.
//
//  1. measure: dissimilarity of every sub-sample to the centre sample (common/dissimilarity.glsl)
//  2. cluster: similar or different, by one k-means iteration from the centroids 0 and the largest dissimilarity; all
//     similar below an absolute floor: such a pixel keeps its colour. Or the mask is read (MASK_PASS)
//  3. tune: a different sub-sample whose surface no neighbouring pixel on its side shows is dropped
//  4. resample: result = colour at the centre + the learned offset of the mask
//
// Source: [Reshetov 2012] (docs/sources.md). Colours: linear BT.709, in and out.
// Bindings 0 to 9, push constants and SAMPLES (at most 16): common/subsamples.glsl; the sub-samples' colours are not
// read, geometry not where the mask is and tuning is off.
//
//   binding                     format    holds
//   10 maskImage    texture     R 32UI    MASK_PASS: bit k = 1: sub-sample k is on the centre sample's surface
//   11 Shifts       buffer      {float u, v}   the learned offset of each of the 2^SAMPLES masks, px, y down
//                                         (resolver/methods/geometry/rsaa_lut_data.cpp)
//   12 Neighbours   buffer      {int x1, y1, x2, y2, x3, y3, count}   of each sub-sample: the pixels, from its own,
//                                         that may show its surface
//
//   constant             default
//   10 MEASURE           0         DISSIMILARITY_...
//   11 LEAST             0.2       the floor: below it everything is one surface
//   12 ADAPTIVE          true      k-means; otherwise different is what reaches the floor
//   13 TUNING            true      step 3
//   14 TUNE_ADAPTIVE     false     nearer than half of the own dissimilarity counts as shown
//   15 IDS               true      sub-samples on another object are different whatever their geometry
//   16 MASK_PASS         false
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/subsamples.glsl"

struct NeighbourList {
    int at[6];
    int count;
};
layout(binding = 10) uniform usampler2D maskImage;
layout(std430, binding = 11) readonly buffer Shifts { vec2 shiftsPx[]; };
layout(std430, binding = 12) readonly buffer Neighbours { NeighbourList neighbours[]; };
layout(constant_id = 10) const int MEASURE = DISSIMILARITY_SADP;
layout(constant_id = 11) const float LEAST = 0.2;
layout(constant_id = 12) const bool ADAPTIVE = true;
layout(constant_id = 13) const bool TUNING = true;
layout(constant_id = 14) const bool TUNE_ADAPTIVE = false;
layout(constant_id = 15) const bool IDS = true;
layout(constant_id = 16) const bool MASK_PASS = false;

const uint FULL = (1u << SAMPLES) - 1u;

SurfacePoint pointOf(ivec2 p, int k) {
    return MEASURE == DISSIMILARITY_DEPTH ? SurfacePoint(depthOf(p, k), vec3(0.0)) : surfacePoint(p, k);
}
// ---- measure and cluster --------------------------------------------------------------------------------------------
bool otherObject(ivec2 p, int k) { return IDS && !sameObject(p, CENTRE, k); }
float fromCentre(ivec2 p, int k) {
    return otherObject(p, k) ? FARTHEST
                             : dissimilarity(pointOf(p, CENTRE), pointOf(p, k), separation(p, CENTRE, k), MEASURE);
}
// Whether some sub-sample may be another surface: without a root or a division, and false for most pixels.
bool suspect(ivec2 p) {
    for (int k = 0; k < SAMPLES; k++)
        if (otherObject(p, k) ||
            surfacesMayDiffer(pointOf(p, CENTRE), pointOf(p, k), separation(p, CENTRE, k), LEAST, MEASURE))
            return true;
    return false;
}
// Bit k is 1 where sub-sample k is similar to the centre.
uint cluster(ivec2 p) {
    float d[SAMPLES], farthest = 0.0;
    for (int k = 0; k < SAMPLES; k++) {
        d[k] = fromCentre(p, k);
        farthest = greater(farthest, d[k]);
    }
    if (farthest < LEAST) return FULL;
    uint mask = 0u;
    if (ADAPTIVE) {
        // Initial centroids 0 and the farthest; the centre itself counts with dissimilarity 0.
        float nearSum = 0.0, farSum = 0.0, nearCount = 1.0, farCount = 0.0;
        for (int k = 0; k < SAMPLES; k++)
            if (d[k] <= farthest * 0.5) {
                nearSum = nearSum + d[k];
                nearCount = nearCount + 1.0;
            } else {
                farSum = farSum + d[k];
                farCount = farCount + 1.0;
            }
        const float nearMean = nearSum / nearCount, farMean = farSum / max(farCount, 1.0);
        for (int k = 0; k < SAMPLES; k++)
            if (abs(d[k] - nearMean) <= abs(d[k] - farMean)) mask |= 1u << k;
    } else {
        for (int k = 0; k < SAMPLES; k++)
            if (d[k] < LEAST) mask |= 1u << k;
    }
    return mask;
}

// ---- tune -----------------------------------------------------------------------------------------------------------
// Keeps a different sub-sample only when a neighbouring pixel shows its surface: else resampling toward it would fetch
// a third surface.
bool shownByNeighbour(ivec2 p, int k) {
    float limit = LEAST;
    if (TUNE_ADAPTIVE) limit = greater(limit, fromCentre(p, k) * 0.5);
    const SurfacePoint own = pointOf(p, k);
    for (int i = 0; i < neighbours[k].count; i++) {
        const ivec2 q = clampTexel(p + ivec2(neighbours[k].at[2 * i], neighbours[k].at[2 * i + 1]), frame.size);
        if (IDS && texel(objectImage, q) != objectOf(p, k)) continue;
        const SurfacePoint other = pointOf(q, CENTRE);
        const Separation way = separation(q, vec2(0.0), offsetsPx[k] - vec2(q - p));
        if (!surfacesMayDiffer(other, own, way, limit, MEASURE) || dissimilarity(other, own, way, MEASURE) < limit)
            return true;
    }
    return false;
}
uint tuned(ivec2 p, uint mask) {
    for (int k = 0; k < SAMPLES; k++)
        if ((mask >> k & 1u) == 0u && !shownByNeighbour(p, k)) mask |= 1u << k;
    return mask;
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    uint mask = FULL;
    if (MASK_PASS)
        mask = texel(maskImage, p) & FULL;
    else if (suspect(p))
        mask = cluster(p);
    if (TUNING && mask != FULL) mask = tuned(p, mask);
    const vec2 shift = mask == FULL ? vec2(0.0) : shiftsPx[mask];
    imageStore(resultImage, p, vec4(texelAt(colourImage, p, shift).rgb, 1.0));
}
