// The temporal part of SMAA T2x and 4x ([Jimenez 2012], reference shader v2.8, SMAAResolvePS).
//
//  1. the frame before at the reprojected pixel, nearest
//  2. its weight: a half, less where the surface there moved at another speed, which means that it is another surface:
//     1/2 max(0, 1 - K sqrt |speed - speed before|); 0 outside the previous frame or with a motion that is no number
//  3. blend. What is kept for the next frame is the anti-aliased frame, not this result
//
// Colours: those of the blend before it (spatial/smaa_blend.comp).
//
//   binding                                format           holds
//   0  currentImage           texture      RGBA 16F / 32F   this frame, anti-aliased
//   1  previousImage          texture      RGBA 16F / 32F   the frame before, anti-aliased (as nextImage with UNJITTER)
//   2  velocityImage          texture      RG 16F / 32F     px, y down: motion, anti-aliased as the colour
//   3  previousVelocityImage  texture      RG 16F / 32F     the same of the frame before
//   4  motionImage            texture      RG 16F / 32F     px, y down: current - previous position of the pixel itself
//   5  nextImage              image        RGBA 16F / 32F   this frame at readOffset (UNJITTER, otherwise any image)
//   6  resultImage            image        RGBA 16F / 32F
//
//   constant                  default
//   10 REPROJECT              true         false: the frame before at the same pixel, half and half
//   11 REJECTION              30           K
//   12 UNJITTER               false        the current frame is read at p + readOffset, bilinear
//
//   push constants            unit
//   size                      px
//   scale                     per px       px -> the unit of the speeds: 1 / size, or 1 / 1080
//   readOffset                px, y down   -jitter
//   firstFrame                0 or 1       1: there is no frame before
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/reproject.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D currentImage;
layout(binding = 1) uniform sampler2D previousImage;
layout(binding = 2) uniform sampler2D velocityImage;
layout(binding = 3) uniform sampler2D previousVelocityImage;
layout(binding = 4) uniform sampler2D motionImage;
layout(binding = 5) uniform writeonly image2D nextImage;
layout(binding = 6) uniform writeonly image2D resultImage;
layout(constant_id = 10) const bool REPROJECT = true;
layout(constant_id = 11) const float REJECTION = 30.0;
layout(constant_id = 12) const bool UNJITTER = false;
layout(push_constant) uniform Frame {
    ivec2 size;
    vec2 scale;
    vec2 readOffset;
    uint firstFrame;
} frame;

float speed(vec2 v) {
    precise const float x = v.x * frame.scale.x, y = v.y * frame.scale.y, squares = x * x + y * y;
    return sqrt(squares);
}
// By the difference of the velocities' squares: nothing is lost where they are nearly equal, which its root would show.
// `precise`: the two products must cancel as they are written.
float speedDifference(vec2 v, vec2 w) {
    precise const vec2 products = (v - w) * (v + w) * (frame.scale * frame.scale);
    precise const float squares = products.x + products.y;
    const float sum = speed(v) + speed(w);
    return sum == 0.0 ? 0.0 : abs(squares) / sum;
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const vec4 current = UNJITTER ? texelAt(currentImage, p, frame.readOffset) : texel(currentImage, p);
    if (UNJITTER) imageStore(nextImage, p, current);
    if (frame.firstFrame != 0u) {
        imageStore(resultImage, p, current);
        return;
    }

    // 1. and 2.
    float weight = 0.5;
    ivec2 at = p;
    if (REPROJECT) {
        const Reprojection q = reproject(p, texel(motionImage, p).rg, frame.size, false);
        at = nearestTexel(p, q);
        const float d = speedDifference(texel(velocityImage, p).rg, texel(previousVelocityImage, at).rg);
        weight = q.inside ? 0.5 * greater(0.0, 1.0 - REJECTION * sqrt(d)) : 0.0;
    }
    const vec4 previous = texel(previousImage, at);
    if (!isFinite(previous.rgb)) weight = 0.0;  // what is no number must not outlive its frame

    // 3.
    imageStore(resultImage, p, weight > 0.0 ? current + (previous - current) * weight : current);
}
