// Pixels of pictures that lie in the layers of one image; outside a picture lies its edge, as in image.glsl.
#ifndef AA_LAYERS
#define AA_LAYERS
#include "image.glsl"

vec4 texel(sampler2DArray images, ivec2 p, int layer) {
    return texelFetch(images, ivec3(clampTexel(p, textureSize(images, 0).xy), layer), 0);
}
// Bilinear at p + offset, in px. Offset 0 gives the texel itself.
vec4 texelAt(sampler2DArray images, ivec2 p, int layer, vec2 offset) {
    const vec2 whole = floor(offset), f = offset - whole;
    const ivec2 q = p + ivec2(whole);
    const vec4 a = texel(images, q, layer);
    if (f == vec2(0.0)) return a;
    const vec4 top = lerpExact(a, texel(images, q + ivec2(1, 0), layer), f.x);
    if (f.y == 0.0) return top;
    const vec4 bottom = lerpExact(texel(images, q + ivec2(0, 1), layer), texel(images, q + ivec2(1, 1), layer), f.x);
    return top + (bottom - top) * f.y;
}

#endif
