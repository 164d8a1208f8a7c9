// ssssaa: "screen-space SSAA".
//
//  1. the gradient of the luma of four points around the pixel; pixels where it reaches a threshold, the others stay as
//     they are
//  2. a weighted mean of the pixel, two taps half a pixel and two a pixel away along the edge
//
// Reconstructed from the shader of that name (docs/sources.md).
// Colours: encoded. Bindings 0 and 1 and push constants: common/spatial.glsl.
//
//   constant       default   means
//   10 REACH_PX    1.75      distance of the lumas
//   11 THRESHOLD   0.0625    least luma gradient that is blurred
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/edge_blur.glsl"

layout(constant_id = 10) const float REACH_PX = 1.75;
layout(constant_id = 11) const float THRESHOLD = 0.0625;

float lumaAt(ivec2 p) { return lumaOf(colourAt(p), LUMA_REC709); }
float lumaToward(ivec2 p, ivec2 d) {
    const int whole = int(REACH_PX);
    const float near = lumaAt(p + d * whole);
    return near + (lumaAt(p + d * (whole + 1)) - near) * (REACH_PX - float(whole));
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (!insidePicture(p)) return;
    const vec3 own = colourAt(p);

    // 1. direction
    const float top = lumaToward(p, ivec2(0, -1)), bottom = lumaToward(p, ivec2(0, 1)),
                left = lumaToward(p, ivec2(-1, 0)), right = lumaToward(p, ivec2(1, 0));
    const vec2 gradient = vec2(bottom - top, right - left);  // turned by 90 degrees: along the edge
    const float length = sqrt(gradient.x * gradient.x + gradient.y * gradient.y);
    if (!(length >= THRESHOLD)) {
        storeResult(p, own);
        return;
    }

    // 2. blur
    const vec2 v = gradient * (1.0 / max(length, 1e-12));
    const vec3 sum = 0.9 * pairDifference(p, own, v * 0.5) + 0.75 * pairDifference(p, own, v);
    storeResult(p, own + sum * (1.0 / 4.3));
}
