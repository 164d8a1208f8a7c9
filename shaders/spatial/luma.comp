// One luma per pixel for the edge decisions of a spatial method that searches in it (common/luma.glsl).
// Bindings 0 and 1 and push constants: common/spatial.glsl; resultImage is R 32F. Colours: as the kind demands.
//
//   constant   default
//   10 KIND    0         which luma, LUMA_...
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/luma.glsl"
#include "../common/spatial.glsl"

layout(constant_id = 10) const int KIND = 0;

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (!insidePicture(p)) return;
    imageStore(resultImage, p, vec4(lumaOf(colourAt(p), KIND), 0.0, 0.0, 0.0));
}
