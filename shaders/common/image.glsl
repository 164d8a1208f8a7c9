// Pixels: p is the texel (x, y) with its centre at p + 1/2, y down, (0, 0) at the top left. Outside the picture lies its
// edge, repeated.
#ifndef AA_IMAGE
#define AA_IMAGE

ivec2 clampTexel(ivec2 p, ivec2 size) { return clamp(p, ivec2(0), size - 1); }
vec4 texel(sampler2D image, ivec2 p) { return texelFetch(image, clampTexel(p, textureSize(image, 0)), 0); }
uint texel(usampler2D image, ivec2 p) { return texelFetch(image, clampTexel(p, textureSize(image, 0)), 0).r; }

// By the bits: compilers may take x - x == 0 for granted.
bool isFinite(float x) { return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u; }
bool isFinite(vec3 c) { return isFinite(c.x) && isFinite(c.y) && isFinite(c.z); }
// The smaller, the larger; where b is NaN: a (GLSL's own may return either).
float lesser(float a, float b) { return b < a ? b : a; }
float greater(float a, float b) { return b > a ? b : a; }
vec3 lesser(vec3 a, vec3 b) { return vec3(lesser(a.x, b.x), lesser(a.y, b.y), lesser(a.z, b.z)); }
vec3 greater(vec3 a, vec3 b) { return vec3(greater(a.x, b.x), greater(a.y, b.y), greater(a.z, b.z)); }
float maxComponent(vec3 c) { return max(max(c.x, c.y), c.z); }
float minComponent(vec3 c) { return min(min(c.x, c.y), c.z); }

// a + (b - a) f, and a itself at f = 0, whatever b is: a texel of weight 0 cannot spread NaN.
vec4 lerpExact(vec4 a, vec4 b, float f) { return f == 0.0 ? a : a + (b - a) * f; }
vec3 lerpExact(vec3 a, vec3 b, float f) { return f == 0.0 ? a : a + (b - a) * f; }
float lerpExact(float a, float b, float f) { return f == 0.0 ? a : a + (b - a) * f; }

// Bilinear at p + offset, in px. Offset 0 gives the texel itself.
vec4 texelAt(sampler2D image, ivec2 p, vec2 offset) {
    const vec2 whole = floor(offset), f = offset - whole;
    const ivec2 q = p + ivec2(whole);
    const vec4 a = texel(image, q);
    if (f == vec2(0.0)) return a;
    const vec4 top = lerpExact(a, texel(image, q + ivec2(1, 0)), f.x);
    if (f.y == 0.0) return top;
    const vec4 bottom = lerpExact(texel(image, q + ivec2(0, 1)), texel(image, q + ivec2(1, 1)), f.x);
    return top + (bottom - top) * f.y;
}

#endif
