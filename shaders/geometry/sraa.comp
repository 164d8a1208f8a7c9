// sraa: subpixel reconstruction anti-aliasing. The colour of every sub-sample is a cross-bilateral mean of the shaded
// pixels around it, weighted by how near they are in place and geometry; the pixel is the mean of its sub-samples.
//
// Weight of pixel q for sub-sample i:
//   product  exp(-|xq - xi|^2 / 2 sx^2) exp(-dz^2 / 2 sz^2) exp(-dn^2 / 2 sn^2), dz = distance of q's point from i's
//            tangent plane relative to i's depth (PLAIN_DEPTH: relative depth difference), dn = 1 - cosine of the
//            normals
//   max      exp(-T max(1 - cosine, dz))
// Surface and background share nothing; nor do objects, by IDS. Pixels outside the picture are left out; a sub-sample
// without any usable pixel takes the pixel's own colour.
//
// Source: [Chajdas 2011] (docs/sources.md). Colours: linear BT.709, in and out.
// Bindings 0 to 9, push constants and SAMPLES: common/subsamples.glsl; the sub-samples' colours are not read, objects
// only by IDS.
//
//   constant          default   unit
//   10 RADIUS         1         px                 pixels around: 1 = 3x3, 2 = 5x5
//   11 MAX_METRIC     false                        the max form of the weight
//   12 PLAIN_DEPTH    false
//   13 IDS            0                            other objects may share (0), share nothing where the relative depth
//                                                  differs by more than DEPTH_SIGMA, too (1), or share nothing (2)
//   14 SPATIAL        2.885     1/px^2             log2(e) / (2 sigma^2), sigma = 0.5 px
//   15 DEPTH          1803      1/relative^2       the same, sigma = 0.02
//   16 NORMAL         11.54     1/(1 - cosine)^2   the same, sigma = 0.25
//   17 SHARPNESS      72.13                        T log2(e), T = 50
//   18 DEPTH_SIGMA    0.02      relative
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/subsamples.glsl"
#include "../common/math.glsl"

layout(constant_id = 10) const int RADIUS = 1;
layout(constant_id = 11) const bool MAX_METRIC = false;
layout(constant_id = 12) const bool PLAIN_DEPTH = false;
layout(constant_id = 13) const int IDS = 0;
layout(constant_id = 14) const float SPATIAL = 2.8853900817779268;
layout(constant_id = 15) const float DEPTH = 1803.3688011112042;
layout(constant_id = 16) const float NORMAL = 11.541560327111707;
layout(constant_id = 17) const float SHARPNESS = 72.134752044448;
layout(constant_id = 18) const float DEPTH_SIGMA = 0.02;

const int IDS_OFF = 0, IDS_DEPTH = 1, IDS_ALWAYS = 2;
const float UNUSABLE = -1e9;  // the log of weight 0
const int MOST_TAPS = 25;

// Base-2 log of the weight of pixel p + d's colour for sub-sample k of pixel p, which lies at `own`.
float logWeight(SurfacePoint own, int k, ivec2 p, ivec2 d) {
    const ivec2 q = p + d;
    if (any(lessThan(q, ivec2(0))) || any(greaterThanEqual(q, frame.size))) return UNUSABLE;
    const vec2 offset = offsetsPx[k], stepPx = vec2(d) - offset;
    const SurfacePoint other = surfacePoint(q, CENTRE);
    const bool emptyOwn = isBackground(own.depth), emptyOther = isBackground(other.depth);
    if (emptyOwn != emptyOther) return UNUSABLE;
    precise float relative = abs(other.depth - own.depth) / lesser(other.depth, own.depth);
    if (IDS != IDS_OFF && texelFetch(sampleObjectImage, ivec3(p, k), 0).r != texel(objectImage, q) &&
        (IDS == IDS_ALWAYS || relative > DEPTH_SIGMA))
        return UNUSABLE;
    precise float geometry = 0.0;  // precise: differences of large logs are what weighs
    if (!emptyOwn) {
        precise float apart = relative;
        if (!PLAIN_DEPTH && hasNormal(own.normal)) {
            const vec3 v = between(separation(p, offset, stepPx), own.depth, other.depth);
            apart = abs(dotInOrder(own.normal, v)) / own.depth;
        }
        const float cosine = dotInOrder(validNormal(own.normal), validNormal(other.normal));
        precise float turned = 1.0 - clamp(cosine, 0.0, 1.0);
        geometry = MAX_METRIC ? greater(1.0 - cosine, apart) * SHARPNESS
                              : apart * apart * DEPTH + turned * turned * NORMAL;
    }
    precise float spatial = MAX_METRIC ? 0.0 : (stepPx.x * stepPx.x + stepPx.y * stepPx.y) * SPATIAL;
    precise float logOfWeight = -(spatial + geometry);
    return greater(UNUSABLE, logOfWeight);
}
// Colour of sub-sample k, from the pixel's own, by the shaded pixels around it. Logs are taken from the largest, so
// that the sum is at least 1 however unlike all pixels are; without any usable one the pixel's own colour stands.
vec3 reconstruct(int k, ivec2 p, vec3 centre) {
    const SurfacePoint own = surfacePoint(p, k);
    float logs[MOST_TAPS], largest = UNUSABLE;
    int tap = 0;
    for (int dy = -RADIUS; dy <= RADIUS; dy++)
        for (int dx = -RADIUS; dx <= RADIUS; dx++, tap++) {
            logs[tap] = logWeight(own, k, p, ivec2(dx, dy));
            largest = greater(largest, logs[tap]);
        }
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    tap = 0;
    for (int dy = -RADIUS; dy <= RADIUS; dy++)
        for (int dx = -RADIUS; dx <= RADIUS; dx++, tap++) {
            if (!(logs[tap] > UNUSABLE * 0.5)) continue;
            const float w = exp2Clamped(logs[tap] - largest);
            sum = sum + (texel(colourImage, p + ivec2(dx, dy)).rgb - centre) * w;
            weights = weights + w;
        }
    return sum / (weights > 0.0 ? weights : 1.0);
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const vec3 centre = texel(colourImage, p).rgb;
    vec3 sum = vec3(0.0);  // about the pixel's own colour: constants stay exact
    for (int k = 0; k < SAMPLES; k++) sum = sum + reconstruct(k, p, centre);
    imageStore(resultImage, p, vec4(max(centre + sum / float(SAMPLES), vec3(0.0)), 1.0));
}
