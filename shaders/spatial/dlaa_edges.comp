// dlaa, first pass: strength of edges by a high-pass, and luma.
//
// Source: [Andreev 2011], public ports (docs/sources.md); then spatial/dlaa.comp.
// Colours: encoded. Bindings 0 and 1 and push constants: common/spatial.glsl; resultImage is RG 32F: strength in
// [0, 1], luma.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/colour.glsl"
#include "../common/spatial.glsl"

// The second difference of the colours: both neighbours at `d`, minus twice the centre.
vec3 secondDifference(ivec2 p, ivec2 d, vec3 c) { return (colourAt(p - d) - c) + (colourAt(p + d) - c); }

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (!insidePicture(p)) return;
    const vec3 c = colourAt(p);
    const vec3 alongX = secondDifference(p, ivec2(1, 0), c), alongY = secondDifference(p, ivec2(0, 1), c);
    const float strength = clamp(luma709(abs(alongX + alongY)) * 4.0, 0.0, 1.0);
    imageStore(resultImage, p, vec4(strength, luma709(c), 0.0, 0.0));
}
