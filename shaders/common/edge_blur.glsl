// Bilinear taps along an edge (nfaa, ssssaa), as differences from the pixel's own colour: a constant stays itself.
#ifndef AA_EDGE_BLUR
#define AA_EDGE_BLUR
#include "luma.glsl"
#include "spatial.glsl"

vec3 tapDifference(ivec2 p, vec3 own, vec2 offsetPx) {
    const vec2 whole = floor(offsetPx), f = offsetPx - whole;
    const ivec2 q = p + ivec2(whole);
    const vec3 top = (colourAt(q) - own) * (1.0 - f.x) + (colourAt(q + ivec2(1, 0)) - own) * f.x;
    const vec3 bottom = (colourAt(q + ivec2(0, 1)) - own) * (1.0 - f.x) + (colourAt(q + ivec2(1, 1)) - own) * f.x;
    return top * (1.0 - f.y) + bottom * f.y;
}
vec3 pairDifference(ivec2 p, vec3 own, vec2 offsetPx) {
    return tapDifference(p, own, offsetPx) + tapDifference(p, own, -offsetPx);
}

#endif
