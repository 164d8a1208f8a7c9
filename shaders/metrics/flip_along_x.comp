// LDR-FLIP, first of two passes, run on the test and on the reference: opponent colour filtered along x. The second is
// flip_along_y.comp.
//
//  1. encoded -> linear -> XYZ over the white point -> opponent colour (Y, 500 (X - Y), 200 (Y - Z)). The paper's
//     offset and scale of the first, 116 Y - 16, pass through every normalised filter and are left out
//  2. contrast sensitivity along x: of blue-yellow, the two Gaussians of which its filter is the sum
//  3. of the luminance, along x: G, its first and its second derivative
//
// Sources: [Andersson 2020] (docs/sources.md).
// Colours: sRGB-encoded; values outside [0, 1] count as 0 or 1, NaN as 0. The edge is repeated.
// Workgroups of 32 x 8; 7 KB of shared memory.
//
//   binding                format     holds
//   0  encodedImage   tex  RGBA 32F
//   1  contrastImage  img  RGBA 32F   luminance, red-green, blue-yellow wide and narrow
//   2  featureImage   img  RGBA 32F   G, edge, point
//
//   push constants: size, px
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/colour.glsl"
#include "../common/flip.glsl"
#include "../common/image.glsl"

const ivec2 GROUP = ivec2(32, 8);
layout(local_size_x = GROUP.x, local_size_y = GROUP.y) in;
layout(binding = 0) uniform sampler2D encodedImage;
layout(binding = 1) uniform writeonly image2D contrastImage;
layout(binding = 2) uniform writeonly image2D featureImage;
layout(push_constant) uniform Frame { ivec2 size; } frame;

const int COLUMNS = GROUP.x + 2 * CSF_REACH;
shared vec3 opponentTile[GROUP.y][COLUMNS];

// `precise`, here and below: equal pictures give equal values, whatever the compiler fuses.
vec3 opponent(vec3 linear) {
    precise const vec3 xyz = linear.x * TO_XYZ[0] + linear.y * TO_XYZ[1] + linear.z * TO_XYZ[2];
    precise const vec3 o = vec3(xyz.y, (xyz.x - xyz.y) * 500.0, (xyz.y - xyz.z) * 200.0);
    return o;
}
void fetchOpponent() {
    const ivec2 first = ivec2(gl_WorkGroupID.xy) * GROUP - ivec2(CSF_REACH, 0);
    for (int k = int(gl_LocalInvocationIndex); k < GROUP.y * COLUMNS; k += GROUP.x * GROUP.y) {
        const ivec2 q = ivec2(k % COLUMNS, k / COLUMNS);
        const vec3 shown = lesser(vec3(1.0), greater(vec3(0.0), texel(encodedImage, first + q).rgb));
        opponentTile[q.y][q.x] = opponent(srgbDecode(shown));
    }
}
// Of the pixel (x + i, y).
vec3 opponentAt(int i) { return opponentTile[gl_LocalInvocationID.y][int(gl_LocalInvocationID.x) + CSF_REACH + i]; }

vec4 contrastAlongX() {
    precise vec4 sum = opponentAt(0).xyzz * CSF[0];
    for (int i = 1; i <= CSF_REACH; i++) sum = sum + (opponentAt(-i) + opponentAt(i)).xyzz * CSF[i];
    return sum;
}
// The taps of the second derivative sum to 0: as differences from the centre they give exactly 0 on flat ground, where
// a later square root would turn a rounding error of 1e-8 into 1e-4.
vec3 featuresAlongX() {
    const float y = opponentAt(0).x;
    precise vec3 sum = vec3(y * FEATURE[0].x, 0.0, 0.0);
    for (int i = 1; i <= FEATURE_REACH; i++) {
        const float a = opponentAt(-i).x, b = opponentAt(i).x;
        sum = sum + vec3(a + b, a - b, a + b - y * 2.0) * FEATURE[i];
    }
    return sum;
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    fetchOpponent();
    barrier();
    if (any(greaterThanEqual(p, frame.size))) return;
    imageStore(contrastImage, p, contrastAlongX());
    imageStore(featureImage, p, vec4(featuresAlongX(), 0.0));
}
