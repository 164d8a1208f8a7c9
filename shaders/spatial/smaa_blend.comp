// SMAA, pass 3 of 3: every pixel is blended with its two neighbours across the stronger of its axes ([Jimenez 2012],
// reference shader v2.8). Of two sub-samples of a frame the second averages with the first.
//
// Colours: any space; linear BT.709 by default. Outside the picture lies its edge, repeated.
//
//   binding                             format           holds
//   0  colourImage         texture      RGBA 16F / 32F
//   1  weightsImage        texture      RGBA             pass 2: top edge own, opposite, left edge own, opposite
//   2  motionImage         texture      RG 16F / 32F     px, y down (VELOCITY, otherwise any texture)
//   3  firstImage          texture      RGBA 16F / 32F   the first sub-sample's result (average, otherwise any texture)
//   4  firstVelocityImage  texture      RG 16F / 32F     the same of motion (both, otherwise any texture)
//   5  resultImage         image        RGBA 16F / 32F
//   6  velocityImage       image        RG 16F / 32F     motion, blended as the colour (VELOCITY, otherwise any image)
//
//   constant               default
//   10 VELOCITY            false    motion is blended, too
//
//   push constants         unit
//   size                   px
//   average                0 or 1   1: half of the result is the first sub-sample's
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D colourImage;
layout(binding = 1) uniform sampler2D weightsImage;
layout(binding = 2) uniform sampler2D motionImage;
layout(binding = 3) uniform sampler2D firstImage;
layout(binding = 4) uniform sampler2D firstVelocityImage;
layout(binding = 5) uniform writeonly image2D resultImage;
layout(binding = 6) uniform writeonly image2D velocityImage;
layout(constant_id = 10) const bool VELOCITY = false;
layout(push_constant) uniform Frame {
    ivec2 size;
    uint average;
} frame;

struct Shares {  // of the neighbours at p + toward and p - toward
    ivec2 toward;
    float forward, backward;
};
// `precise`, for the velocities: where those of two frames are nearly equal, the last bits decide
// (temporal/smaa_resolve.comp).
vec4 blended(sampler2D image, ivec2 p, Shares s) {
    const vec4 own = texel(image, p);
    if (s.toward == ivec2(0)) return own;
    precise const vec4 mixed =
        own + s.forward * (texel(image, p + s.toward) - own) + s.backward * (texel(image, p - s.toward) - own);
    return mixed;
}
vec4 averaged(vec4 second, sampler2D firstResult, ivec2 p) {
    if (frame.average == 0u) return second;
    const vec4 first = texel(firstResult, p);
    precise const vec4 mean = first + (second - first) * 0.5;
    return mean;
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const vec4 own = texel(weightsImage, p);
    const float right = texel(weightsImage, p + ivec2(1, 0)).w, bottom = texel(weightsImage, p + ivec2(0, 1)).y;
    const float left = own.z, top = own.x;

    Shares s = Shares(ivec2(0), 0.0, 0.0);
    if (right + left + bottom + top >= 1e-5) {
        // Symmetric corners weigh both axes alike; they count as vertical in every precision, as equal 8-bit weights
        // do.
        const bool horizontal = max(right, left) > max(bottom, top) * (1.0 + 1e-5);
        const float forward = horizontal ? right : bottom, backward = horizontal ? left : top;
        const float total = forward + backward;
        s = Shares(horizontal ? ivec2(1, 0) : ivec2(0, 1), forward * forward / total, backward * backward / total);
    }
    imageStore(resultImage, p, averaged(blended(colourImage, p, s), firstImage, p));
    if (VELOCITY) imageStore(velocityImage, p, averaged(blended(motionImage, p, s), firstVelocityImage, p));
}
