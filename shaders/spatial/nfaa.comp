// nfaa: normal-filter anti-aliasing.
//
//  1. the gradient of the luma of eight neighbours, turned by 90 degrees: along the edge, the longer the steeper
//  2. the mean of the pixel, two taps along it, and two at half that distance mirrored across the row
//
// Source: [Styves n.d.], public port (docs/sources.md).
// Colours: encoded. Bindings 0 and 1 and push constants: common/spatial.glsl.
//
//   constant        default   means
//   10 SCALE_PX     1         distance of the lumas
//   11 STRENGTH     1         length of the blur per gradient, px
//   12 LONGEST_PX   3         largest length of the blur
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/edge_blur.glsl"

layout(constant_id = 10) const int SCALE_PX = 1;
layout(constant_id = 11) const float STRENGTH = 1.0;
layout(constant_id = 12) const float LONGEST_PX = 3.0;

float lumaAt(ivec2 p, int dx, int dy) { return lumaOf(colourAt(p + SCALE_PX * ivec2(dx, dy)), LUMA_NFAA); }

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (!insidePicture(p)) return;

    // 1. direction
    const float nw = lumaAt(p, -1, -1), n = lumaAt(p, 0, -1), ne = lumaAt(p, 1, -1), w = lumaAt(p, -1, 0),
                e = lumaAt(p, 1, 0), sw = lumaAt(p, -1, 1), s = lumaAt(p, 0, 1), se = lumaAt(p, 1, 1);
    vec2 v = STRENGTH * vec2(((sw - nw) + (se - ne)) + (s - n), ((nw - ne) + (sw - se)) + (w - e));
    const float length = sqrt(v.x * v.x + v.y * v.y);
    if (length > LONGEST_PX) v *= LONGEST_PX / length;

    // 2. blur
    const vec3 own = colourAt(p);
    const vec3 sum = pairDifference(p, own, v) + pairDifference(p, own, v * vec2(0.5, -0.5));
    storeResult(p, own + sum * 0.2);
}
