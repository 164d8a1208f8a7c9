// t2msaa: temporal 2x multisampling.
//
//  1. c = mean of the two sub-sample colours   2. q = p - motion of the pixel itself, history bilinear
//  3. rejection: border, mean depth (one-sided), magnification   4. rejected: c, N = 1
//  5. a = 1 / (N + 1), under motion at least 0.25 + blur term; blend with weights 1 / (1 + luma601); N grows only while
//     a is above that limit
// The geometry moves by (-d, +d) and (+d, -d) px in alternate frames. The buffer Samples says which two of the recorded
// sub-samples a frame takes.
//
// Source: [Stejmar n.d., 4.4.2, listing 4.19] (docs/sources.md).
// Colours: sub-samples linear BT.709, >= 0; blend and result displayed values in [0, 1] with ENCODED, else linear.
// Bindings 0 to 6, push constants and constants 0 to 4: common/temporal.glsl (currentImage and depthImage: any texture),
// and
//
//   binding                          format           holds
//   7  sampleColourImage   texture   RGBA 16F / 32F   colours of the sub-samples, one layer each
//   8  sampleDepthImage    texture   R 32F            their planar view z > 0, background 1e10
//   9  previousDepthImage  texture   R 32F            what `nextDepthImage` was a frame ago
//   10 nextDepthImage      image     R 32F            mean depth of this frame's two sub-samples
//   11 countImage          texture   R 32F            what `nextCountImage` was a frame ago
//   12 nextCountImage      image     R 32F            N
//   13 Samples             buffer    layers: of the two sub-samples; readOffset: px from p to where their colours are
//                                    read; the display chain of common/colour.glsl (displayScale, toneMap, srgb)
//
//   constant                default
//   10 ENCODED              1
//   11 FRACTIONAL_VELOCITY  0       velocity in the blur term: 0 in UV as listed, 1 the fraction of a pixel
//   12 COUNT_AT_PIXEL       1       N is read at the pixel itself; 0: where its surface was
//   13 DEPTH_TOLERANCE      0.08    share of the expected depth
//   14 MAGNIFICATION        1       share of the footprint (rejection.glsl); 0: not tested
//   15 BOTH_SIDES           0       nearer surfaces are rejected, too
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/temporal.glsl"
#include "../common/feedback.glsl"
#include "../common/layers.glsl"
#include "../common/rejection.glsl"

layout(binding = 7) uniform sampler2DArray sampleColourImage;
layout(binding = 8) uniform sampler2DArray sampleDepthImage;
layout(binding = 9) uniform sampler2D previousDepthImage;
layout(binding = 10) uniform writeonly image2D nextDepthImage;
layout(binding = 11) uniform sampler2D countImage;
layout(binding = 12) uniform writeonly image2D nextCountImage;
layout(binding = 13, std430) readonly buffer Samples {
    ivec2 layers;
    vec2 readOffset;
    float displayScale;
    int toneMap;
    uint srgb;
} samples;
layout(constant_id = 10) const bool ENCODED = true;
layout(constant_id = 11) const bool FRACTIONAL_VELOCITY = false;
layout(constant_id = 12) const bool COUNT_AT_PIXEL = true;
layout(constant_id = 13) const float DEPTH_TOLERANCE = 0.08;
layout(constant_id = 14) const float MAGNIFICATION = 1.0;
layout(constant_id = 15) const bool BOTH_SIDES = false;

const float MOST_COUNT = 16777215.0;  // the last whole step of float

// v (1 - v) of one component; v > 1 counts as 1.
float parabola(float v) {
    const float s = clamp(v, 0.0, 1.0);
    return s * (1.0 - s);
}
vec3 sampleColour(ivec2 p, int layer) {
    const vec3 c = texelAt(sampleColourImage, p, layer, samples.readOffset).rgb;
    return ENCODED ? display(c, samples.displayScale, samples.toneMap, samples.srgb != 0u) : c;
}
float sampleDepth(ivec2 p, int layer) { return texel(sampleDepthImage, p + frame.texelOffset, layer).r; }

void store(ivec2 p, vec3 colour, float depth, float count, float reason) {
    storeBlend(p, colour, 1.0, colour);
    imageStore(nextDepthImage, p, vec4(depth, 0.0, 0.0, 0.0));
    imageStore(nextCountImage, p, vec4(count, 0.0, 0.0, 0.0));
    storeRejection(p, reason);
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;

    // 1
    const vec3 first = sampleColour(p, samples.layers.x);
    const vec3 current = first + (sampleColour(p, samples.layers.y) - first) * 0.5;
    const float depth = (sampleDepth(p, samples.layers.x) + sampleDepth(p, samples.layers.y)) * 0.5;
    if (frame.firstFrame != 0u) {
        store(p, sanitised(current, current, vec3(0.0)), depth, 1.0, REJECTED_FIRST_FRAME);
        return;
    }

    // 2
    const vec2 motion = motionAt(p);
    const Reprojection q = reproject(p, motion);
    const vec3 history = fetchHistory(p, q);

    // 3
    float reason = q.inside ? REJECTED_NOT : REJECTED_OUTSIDE;
    if (reason == REJECTED_NOT && disoccluded(expectedPreviousDepth(depth, p), fetchDepth(previousDepthImage, p, q),
                                              DEPTH_TOLERANCE, BOTH_SIDES))
        reason = REJECTED_DISOCCLUDED;
    if (MAGNIFICATION > 0.0 && reason == REJECTED_NOT && magnified(q, footprint(motionSlope(p), 1.0), MAGNIFICATION))
        reason = REJECTED_MAGNIFIED;
    const bool hit = reason == REJECTED_NOT;

    // 4, 5
    const float count = texel(countImage, COUNT_AT_PIXEL ? p : nearestTexel(p, q)).r, mean = 1.0 / (count + 1.0);
    const vec2 velocity = FRACTIONAL_VELOCITY ? abs(motion) - floor(abs(motion))
                                              : abs(motion) * (vec2(1.0) / vec2(frame.size));
    const float blur = 0.25 + ((1.0 - mean) / mean) * ((parabola(velocity.x) + parabola(velocity.y)) * 0.5);
    const float least = motion == vec2(0.0) ? 0.0 : clamp(blur, 0.0, 1.0), alpha = max(mean, least);
    const vec3 mixed = inverseLuminanceBlend(current, luma601(current), history, luma601(history), 1.0 - alpha);
    const float grown = alpha > least ? min(count + 1.0, MOST_COUNT) : count;
    store(p, sanitised(hit ? mixed : current, current, history), depth, hit ? grown : 1.0, reason);
}
