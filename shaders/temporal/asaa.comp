// asaa: amortized supersampling.
//
// Four sub-pixel buffers hold the image at the quadrant offsets (-+.25, -+.25); each frame updates the buffer of its
// jitter's quadrant.
//  1. s = the current sample   2. the surface point is followed into the frame of each buffer: by the two cameras, plus
//     the object's own motion (motion less camera motion) times the buffer's age   3. tent-weighted sums over the four
//     nearest samples of every buffer: b~ (radius half the footprint) and f~ (twice that), radii from 0.125 to 1 px
//  4. rejection per buffer: border, depth, magnification   5. alpha = 1 / (N + 1), N limited to 4 in motion, or alpha
//     bounded by eq 3.31
//  6. buffer = alpha s + (1 - alpha) b~, frame = alpha/4 s + (1 - alpha/4) f~   7. N + 1, or eq 3.29
// N counts earlier samples. Where every buffer is rejected N = 0; the first frame after a reset rejects nothing: N = 1.
//
// Sources: [Yang 2009]; [Stejmar n.d., 3.8 and 4.4.1] (docs/sources.md).
// Colours: displayed (encoded) values in [0, 1], in and out.
// Bindings 0 to 6, push constants and constants 0 to 4: common/temporal.glsl (historyImage and nextImage: any), and
//
//   binding                        format           holds
//   7  buffersImage      texture   RGBA 16F / 32F   five layers: the four buffers and a spare one
//   8  depthsImage       texture   R 32F            five layers: view depth of the frame that wrote each
//   9  nextBufferImage   image     RGBA 16F / 32F   the same images; this frame writes layer `nextLayer`, the spare one,
//   10 nextDepthImage    image     R 32F            which then stands for its quadrant
//   11 countImage        texture   R 32F            what `nextCountImage` was a frame ago
//   12 nextCountImage    image     R 32F            N
//   13 Followed          buffer    of this frame: see there
//
//   constant               default
//   10 EQ_331              0       steps 5 and 7 by eq 3.31 and 3.29
//   11 FOUR_IN_MOTION      0       N = 4 in motion; 0: at most 4
//   12 COUNT_AT_PIXEL      1       N is read at the pixel itself; 0: where its surface was
//   13 DEPTH_TOLERANCE     0.08    share of the expected depth
//   14 MAGNIFICATION       1       share of the footprint (rejection.glsl); 0: not tested
//   15 BOTH_SIDES          0       nearer surfaces are rejected, too
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/temporal.glsl"
#include "../common/feedback.glsl"
#include "../common/layers.glsl"
#include "../common/rejection.glsl"

// Clip position of the static surface point that the pixel at p samples at depth z, in another camera jittered as this
// frame, as three rows x, y, w: z (perDepth.xyz . (p, 1)) + constant.xyz . (p, 1). Jittered, for the sample lies at
// p + jitter: less p the position is how far the point moved.
struct CameraPath {
    vec4 perDepth[3], constant[3];
};
struct Quadrant {
    CameraPath path;                           // to the frame that wrote the buffer
    vec4 expectedPerDepth, expectedConstant;   // as Frame::perDepth and constant, to that frame
    vec2 phi;                                  // quadrant offset, px
    float age;                                 // frames since it was written
    int layer;                                 // -1: not written since the reset
    uint pathMoves;                            // 0: the same camera, no displacement
    uint depthKnown;                           // as Frame::depthKnown
};

layout(binding = 7) uniform sampler2DArray buffersImage;
layout(binding = 8) uniform sampler2DArray depthsImage;
layout(binding = 9) uniform writeonly image2DArray nextBufferImage;
layout(binding = 10) uniform writeonly image2DArray nextDepthImage;
layout(binding = 11) uniform sampler2D countImage;
layout(binding = 12) uniform writeonly image2D nextCountImage;
layout(binding = 13, std430) readonly buffer Followed {
    Quadrant quadrants[4];
    CameraPath lastFrame;
    vec2 phi;  // of this frame's quadrant, px
    int nextLayer;
    uint lastFrameMoves;
} followed;
layout(constant_id = 10) const bool EQ_331 = false;
layout(constant_id = 11) const bool FOUR_IN_MOTION = false;
layout(constant_id = 12) const bool COUNT_AT_PIXEL = true;
layout(constant_id = 13) const float DEPTH_TOLERANCE = 0.08;
layout(constant_id = 14) const float MAGNIFICATION = 1.0;
layout(constant_id = 15) const bool BOTH_SIDES = false;

const float MOST_COUNT = 16777215.0;  // the last whole step of float

// Displacement in px of the pixel's surface, were it static, into another camera; NaN behind it. Without fused
// multiply-adds: a small difference of large numbers.
vec2 cameraDisplacement(CameraPath path, bool moves, float depth, ivec2 p) {
    if (!moves) return vec2(0.0);
    const vec2 c = vec2(p) + 0.5;
    precise float clip[3];
    for (int r = 0; r < 3; r++) {
        const vec4 d = path.perDepth[r], k = path.constant[r];
        clip[r] = depth * (c.x * d.x + c.y * d.y + d.z) + (c.x * k.x + c.y * k.y + k.z);
    }
    const float scale = clip[2] > 1e-12 ? 1.0 / clip[2] : uintBitsToFloat(0x7fc00000u);
    precise vec2 displacement = vec2((clip[0] * scale * 0.5 + 0.5) * float(frame.size.x) - c.x,
                                     (0.5 - clip[1] * scale * 0.5) * float(frame.size.y) - c.y);
    return displacement;
}
float expectedPreviousDepth(Quadrant b, float depth, ivec2 p) {
    if (b.depthKnown == 0u || depth >= 1e9) return depth;
    const vec2 c = vec2(p) + 0.5;
    const float perDepth = c.x * b.expectedPerDepth.x + c.y * b.expectedPerDepth.y + b.expectedPerDepth.z;
    const float constant = c.x * b.expectedConstant.x + c.y * b.expectedConstant.y + b.expectedConstant.z;
    return depth * perDepth + constant;
}
float fetchDepth(int layer, ivec2 p, Reprojection q) {
    const ivec2 o = p + q.whole;
    return depthBetween(texel(depthsImage, o, layer).r, texel(depthsImage, o + ivec2(1, 0), layer).r,
                        texel(depthsImage, o + ivec2(0, 1), layer).r, texel(depthsImage, o + ivec2(1, 1), layer).r,
                        q.part);
}

struct TentSum {
    vec3 colour;
    float weight;
};
// The four samples around p + displacement in a buffer, weighted by a tent of this radius, px.
void addTent(int layer, ivec2 p, vec2 displacement, vec2 radius, inout TentSum sum) {
    const vec2 whole = floor(displacement), part = displacement - whole, i = 1.0 / radius;
    const vec2 first = clamp(1.0 - part * i, 0.0, 1.0), second = clamp(1.0 - (1.0 - part) * i, 0.0, 1.0);
    for (int k = 0; k < 4; k++) {
        const bvec2 far = bvec2(k & 1, k >> 1);
        const float w = (far.x ? second.x : first.x) * (far.y ? second.y : first.y);
        if (w == 0.0) continue;
        sum.colour = sum.colour + texel(buffersImage, p + ivec2(whole) + ivec2(far), layer).rgb * w;
        sum.weight = sum.weight + w;
    }
}

void store(ivec2 p, vec3 next, float depth, vec3 shown, float count, float reason) {
    imageStore(nextBufferImage, ivec3(p, followed.nextLayer), vec4(next, 1.0));
    imageStore(nextDepthImage, ivec3(p, followed.nextLayer), vec4(depth, 0.0, 0.0, 0.0));
    imageStore(resultImage, p, vec4(shown, 1.0));
    imageStore(nextCountImage, p, vec4(count, 0.0, 0.0, 0.0));
    storeRejection(p, reason);
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;

    // 1
    const vec3 current = colourAt(p);
    const float depth = depthAt(p);
    if (frame.firstFrame != 0u) {
        const vec3 first = sanitised(current, current, vec3(0.0));
        store(p, first, depth, first, 1.0, REJECTED_FIRST_FRAME);
        return;
    }
    const vec2 motion = motionAt(p);
    const MotionSlope slope = motionSlope(p);
    const vec2 camera = cameraDisplacement(followed.lastFrame, followed.lastFrameMoves != 0u, depth, p);
    const vec2 own = -motion - camera;  // of the object, px per frame

    // 2, 3, 4: both sums over the valid buffers
    TentSum b = TentSum(vec3(0.0), 0.0), f = TentSum(vec3(0.0), 0.0);
    bool anyValid = false;
    for (int k = 0; k < 4; k++) {
        const Quadrant quadrant = followed.quadrants[k];
        if (quadrant.layer < 0) continue;
        const float age = quadrant.age;
        const vec2 path = cameraDisplacement(quadrant.path, quadrant.pathMoves != 0u, depth, p);
        const Reprojection q = reproject(p, -(path + own * age));
        const vec2 foot = footprint(slope, age);
        bool valid = q.inside && !disoccluded(expectedPreviousDepth(quadrant, depth, p),
                                              fetchDepth(quadrant.layer, p, q), DEPTH_TOLERANCE, BOTH_SIDES);
        if (MAGNIFICATION > 0.0) valid = valid && !magnified(q, foot, MAGNIFICATION);
        if (!valid) continue;
        anyValid = true;
        // The four nearest samples serve radii up to 1 px.
        const vec2 radius = min(max(foot * 0.5, vec2(0.125)), vec2(1.0)), there = vec2(q.whole) + q.part;
        addTent(quadrant.layer, p, there + (followed.phi - quadrant.phi), radius, b);
        addTent(quadrant.layer, p, there - quadrant.phi, min(radius + radius, vec2(1.0)), f);
    }
    const bool hasB = b.weight > 1e-6, hasF = f.weight > 1e-6, hit = anyValid && (hasB || hasF);
    const vec3 previousB = hasB ? b.colour / b.weight : current, previousF = hasF ? f.colour / f.weight : current;

    // 5: weight of the current sample, 7: sample count
    const Reprojection q = reproject(p, motion);
    const float count = texel(countImage, COUNT_AT_PIXEL ? p : nearestTexel(p, q)).r;
    float alpha = 1.0, nextCount = 0.0;
    if (EQ_331) {
        const vec2 v = abs(motion) - floor(abs(motion)), spread = v * (1.0 - v);
        const float variance = spread.x + spread.y, bound = variance / (variance + 2.0 * 0.12);  // tau_b - sigma_G^2
        if (hit) alpha = max(1.0 / (count + 1.0), bound);
        nextCount = 1.0 / (alpha * alpha + (1.0 - alpha) * (1.0 - alpha) / max(count, 1.0));  // eq 3.29
    } else if (hit) {
        const float used = motion == vec2(0.0) ? count : FOUR_IN_MOTION ? 4.0 : min(count, 4.0);
        alpha = 1.0 / (used + 1.0);
        nextCount = used + 1.0;
    }

    // 6
    const vec3 updated = previousB + (current - previousB) * alpha;
    const vec3 shown = previousF + (current - previousF) * (alpha * 0.25);
    const vec3 next = sanitised(alpha == 1.0 ? current : updated, current, vec3(0.0));
    store(p, next, depth, sanitised(alpha == 1.0 ? current : shown, current, next), min(nextCount, MOST_COUNT),
          hit ? REJECTED_NOT : q.inside ? REJECTED_DISOCCLUDED : REJECTED_OUTSIDE);
}
