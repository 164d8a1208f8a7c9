// +motionBlur: samples along the motion vector; never fed back.
//
//   v = motion SCALE, held to half the picture; n = clamp(int |v|, 1, 32)
//   shown = (c(p) + sum over i = 1 .. n-1 of B(c, p + v (i / (n-1) - 1/2))) / n, positions held to the picture
//
// Source: [Chapman 2012] (docs/sources.md). A motion of more than two pictures, or that is not a number, blurs nothing.
// Colours: the method's output space, in and out.
//
//   binding              format           holds
//   0  methodImage  tex  RGBA 16F / 32F   the method's output
//   1  motionImage  tex  RG 16F / 32F     px, y down, current - previous position
//   2  resultImage  img  RGBA 16F / 32F   what is shown
//
//   constant 10 SCALE    0.5              length of the blur in frame intervals; 0.5 = half-open shutter
//   push constants: size, px
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/image.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D methodImage;
layout(binding = 1) uniform sampler2D motionImage;
layout(binding = 2) uniform writeonly image2D resultImage;
layout(constant_id = 10) const float SCALE = 0.5;
layout(push_constant) uniform Frame { ivec2 size; } frame;

const int MAX_SAMPLES = 32;

// The whole part of a length whose square is given: sqrt() may be off by a bit, and motion by whole pixels is common.
int wholeLength(float squared) {
    const float n = floor(sqrt(squared));
    if ((n + 1.0) * (n + 1.0) <= squared) return int(n) + 1;
    return n * n > squared ? int(n) - 1 : int(n);
}
vec3 bilinear(vec2 at) {
    const ivec2 q = ivec2(at);
    const vec2 f = at - vec2(q);
    const vec3 nw = texel(methodImage, q).rgb, ne = texel(methodImage, q + ivec2(1, 0)).rgb,
               sw = texel(methodImage, q + ivec2(0, 1)).rgb, se = texel(methodImage, q + ivec2(1, 1)).rgb;
    const vec3 top = nw + (ne - nw) * f.x, bottom = sw + (se - sw) * f.x;
    return top + (bottom - top) * f.y;
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const float longest = 0.5 * float(max(frame.size.x, frame.size.y));
    const vec2 motion = texelFetch(motionImage, p, 0).rg;
    const bool known = abs(motion.x) <= float(2 * frame.size.x) && abs(motion.y) <= float(2 * frame.size.y);
    vec2 v = motion * SCALE;
    const float squared = v.x * v.x + v.y * v.y;
    int n = 1;
    if (squared > longest * longest) {
        v = v * (longest / sqrt(squared));
        n = int(longest);
    } else if (squared >= 4.0)
        n = wholeLength(squared);
    n = known && n >= 2 ? min(n, MAX_SAMPLES) : 1;

    vec3 sum = texelFetch(methodImage, p, 0).rgb;
    for (int i = 1; i < n; i++) {
        const float t = float(i) / float(n - 1) - 0.5;
        sum = sum + bilinear(clamp(vec2(p) + v * t, vec2(0.0), vec2(frame.size - 1)));
    }
    imageStore(resultImage, p, vec4(n == 1 ? sum : sum / float(n), 1.0));
}
