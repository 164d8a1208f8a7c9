// mlaa, first pass: edges between neighbours whose colours differ. Then spatial/mlaa_weights.comp, mlaa_blend.comp.
//
// Source: [Reshetov 2009] (docs/sources.md).
// Bindings 0 to 2 and push constants: common/mlaa.glsl. The bits are 0 beforehand.
//
//   constant   default   means
//   10 RULE    0         what separates pixels: 0 a channel by 1/16, 1 the four highest of a channel's 8 bits, 2 luma
//                        by 0.1
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/luma.glsl"
#include "../common/mlaa.glsl"

layout(constant_id = 10) const int RULE = 0;

const int RULE_MAXDIFF = 0, RULE_MSB4 = 1, RULE_LUMA = 2;

vec3 fourHighestBits(vec3 c) {  // of the 8-bit code
    precise const vec3 code = c * 255.0 + 0.5;
    return floor(floor(code) * (1.0 / 16.0));
}
bool differ(vec3 a, vec3 b) {
    if (RULE == RULE_MSB4) return maxComponent(abs(fourHighestBits(a) - fourHighestBits(b))) >= 0.5;
    if (RULE == RULE_LUMA) return abs(lumaOf(a, LUMA_REC601) - lumaOf(b, LUMA_REC601)) >= 0.1;
    return maxComponent(abs(a - b)) >= 1.0 / 16.0;
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    const vec3 c = colourAt(p);
    const int topWord = p.y * wordsOf(ROWS) + (p.x >> 5), leftWord = p.x * wordsOf(COLUMNS) + (p.y >> 5);
    if (differ(c, colourAt(p + ivec2(0, -1)))) atomicOr(topBits[topWord], 1u << (p.x & 31));
    if (differ(c, colourAt(p + ivec2(-1, 0)))) atomicOr(leftBits[leftWord], 1u << (p.y & 31));
}
