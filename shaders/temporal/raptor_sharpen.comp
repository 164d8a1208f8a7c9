// raptor, second pass: sharpening by luminance of what raptor.comp has blended, L' = L + s (L - mean L of 3x3) and
// c L' / L, held to >= 0. It is shown and never fed back [Castorina 2023].
//
//   binding                  format           holds
//   0  blendImage  texture   RGBA 16F / 32F   raptor.comp's nextImage of this frame, linear BT.709
//   1  resultImage image     RGBA 16F / 32F   what is shown
//   constant 10 AMOUNT: s, default 1
//   push constant: size, px
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/colour.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D blendImage;
layout(binding = 1) uniform writeonly image2D resultImage;
layout(constant_id = 10) const float AMOUNT = 1.0;
layout(push_constant) uniform Frame { ivec2 size; } frame;

vec3 colourAt(ivec2 p) { return texel(blendImage, p).rgb; }
vec3 lumaSharpened(ivec2 p) {
    const vec3 c = colourAt(p);
    const float luma = luma709(c);
    float excess = 0.0;  // 9 (L - mean)
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) excess = excess + (luma - luma709(colourAt(p + ivec2(i, j))));
    const float target = greater(0.0, luma + excess * (AMOUNT / 9.0));
    return luma >= 1e-6 ? c * (target / max(1e-6, luma)) : c;
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(p, frame.size))) return;
    imageStore(resultImage, p, vec4(greater(vec3(0.0), lumaSharpened(p)), 1.0));
}
