// LDR-FLIP, second of two passes: the filters along y, and the difference that a viewer sees when flipping between the
// two pictures. The first, flip_along_x.comp, has run on each of them.
//
//  1. contrast sensitivity along y -> linear, held in [0, 1] -> CIELab, chroma fading with lightness (Hunt)
//  2. strengths of edges and of points from the luminance and its derivatives
//  3. colour difference: HyAB distance^0.7, mapped so that 0.4 of the largest becomes 0.95
//  4. feature difference: sqrt(max(|edge_T - edge_R|, |point_T - point_R|) / sqrt(2))
//  5. FLIP = colour^(1 - feature); a map and sums of it
//
// Sources: [Andersson 2020] (docs/sources.md).
// Workgroups of 8 x 32; 15 KB of shared memory.
//
//   binding                    format     holds
//   0  testContrast       tex  RGBA 32F   of the first pass: luminance, red-green, blue-yellow wide and narrow
//   1  testFeatures       tex  RGBA 32F   G, edge, point
//   2  referenceContrast  tex  RGBA 32F   of the reference
//   3  referenceFeatures  tex  RGBA 32F
//   4  mapImage           img  R32F       FLIP of each pixel, in [0, 1]
//   5  Sums               buf  float      of each workgroup, row by row: sum of the map. The host adds them in double,
//                                         in order, and divides by width height
//
//   push constants: size, px
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/colour.glsl"
#include "../common/flip.glsl"
#include "../common/group_sum.glsl"
#include "../common/image.glsl"
#include "../common/math.glsl"

const ivec2 GROUP = ivec2(8, 32);
layout(local_size_x = GROUP.x, local_size_y = GROUP.y) in;
layout(binding = 0) uniform sampler2D testContrast;
layout(binding = 1) uniform sampler2D testFeatures;
layout(binding = 2) uniform sampler2D referenceContrast;
layout(binding = 3) uniform sampler2D referenceFeatures;
layout(binding = 4) uniform writeonly image2D mapImage;
layout(binding = 5, std430) writeonly buffer Sums { float sums[]; };
layout(push_constant) uniform Frame { ivec2 size; } frame;

const int ROWS = GROUP.y + 2 * CSF_REACH;
shared vec4 contrastTile[ROWS][GROUP.x];
shared vec3 featureTile[ROWS][GROUP.x];

// Of the pixel (x, y + j).
vec4 contrastAt(int j) { return contrastTile[int(gl_LocalInvocationID.y) + CSF_REACH + j][gl_LocalInvocationID.x]; }
vec3 featuresAt(int j) { return featureTile[int(gl_LocalInvocationID.y) + CSF_REACH + j][gl_LocalInvocationID.x]; }

float labCurve(float t) {
    return t > 216.0 / 24389.0 ? cbrtPositive(max(t, 1e-6)) : t * (841.0 / 108.0) + 4.0 / 29.0;
}
// Filtered opponent colour -> CIELab with Hunt's adjustment. `precise`, here and below: equal pictures give equal
// values, whatever the compiler fuses.
vec3 huntLab(vec3 o) {
    precise const vec3 xyz = vec3(o.x + o.y * (1.0 / 500.0), o.x, o.x - o.z * (1.0 / 200.0));
    precise const vec3 linear = xyz.x * TO_RGB[0] + xyz.y * TO_RGB[1] + xyz.z * TO_RGB[2];
    const vec3 shown = clamp(linear, 0.0, 1.0);
    precise const vec3 seen = shown.x * TO_XYZ[0] + shown.y * TO_XYZ[1] + shown.z * TO_XYZ[2];
    const vec3 f = vec3(labCurve(seen.x), labCurve(seen.y), labCurve(seen.z));
    precise const float lightness = f.y * 116.0 - 16.0, hunt = lightness * 0.01;
    precise const vec3 lab = vec3(lightness, hunt * (f.x - f.y) * 500.0, hunt * (f.y - f.z) * 200.0);
    return lab;
}
vec3 labAlongY() {
    precise vec4 sum = contrastAt(0) * CSF[0];
    for (int j = 1; j <= CSF_REACH; j++) sum = sum + (contrastAt(-j) + contrastAt(j)) * CSF[j];
    precise const float blueYellow = sum.z * CZ_WIDE_SHARE + sum.w * (1.0 - CZ_WIDE_SHARE);
    return huntLab(vec3(sum.xy, blueYellow));
}
// Strength of edge and of point. As along x, the second derivative is taken of differences from the centre.
vec2 featuresAlongY() {
    const vec3 centre = featuresAt(0);
    precise vec2 edge = vec2(centre.y * FEATURE[0].x, 0.0), point = vec2(centre.z * FEATURE[0].x, 0.0);
    for (int j = 1; j <= FEATURE_REACH; j++) {
        const vec3 a = featuresAt(-j), b = featuresAt(j);
        edge = edge + vec2(a.y + b.y, a.x - b.x) * FEATURE[j].xy;
        point = point + vec2(a.z + b.z, a.x + b.x - centre.x * 2.0) * FEATURE[j].xz;
    }
    precise const vec2 squares = vec2(edge.x * edge.x + edge.y * edge.y, point.x * point.x + point.y * point.y);
    return sqrt(squares);
}

struct Seen {
    vec3 lab;
    vec2 features;
};
// Every invocation calls it, those beyond the picture too.
Seen seenOf(sampler2D contrast, sampler2D features) {
    barrier();  // what was in the tiles has been read
    const ivec2 first = ivec2(gl_WorkGroupID.xy) * GROUP - ivec2(0, CSF_REACH);
    for (int k = int(gl_LocalInvocationIndex); k < ROWS * GROUP.x; k += GROUP.x * GROUP.y) {
        const ivec2 q = ivec2(k % GROUP.x, k / GROUP.x);
        contrastTile[q.y][q.x] = texel(contrast, first + q);
        featureTile[q.y][q.x] = texel(features, first + q).xyz;
    }
    barrier();
    return Seen(labAlongY(), featuresAlongY());
}

float colourDifference(vec3 t, vec3 r) {
    const vec3 e = t - r;
    const float hyab = abs(e.x) + sqrt(e.y * e.y + e.z * e.z), d = powPositive(hyab, 0.7), knee = 0.4 * MAX_COLOUR;
    return d < knee ? d * (0.95 / knee) : 0.95 + (d - knee) * (0.05 / (MAX_COLOUR - knee));
}
float featureDifference(vec2 t, vec2 r) {
    const vec2 e = abs(t - r);
    return sqrt(max(e.x, e.y) * 0.70710678118654752);
}

void main() {
    const Seen t = seenOf(testContrast, testFeatures), r = seenOf(referenceContrast, referenceFeatures);
    const float colour = colourDifference(t.lab, r.lab), feature = featureDifference(t.features, r.features);
    const float flip = min(powPositive(colour, 1.0 - feature), 1.0);

    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    const bool inside = all(lessThan(p, frame.size));
    if (inside) imageStore(mapImage, p, vec4(flip));
    const float sum = groupSum(inside ? flip : 0.0);
    if (gl_LocalInvocationIndex == 0u) sums[groupNumber(frame.size.x, GROUP.x)] = sum;
}
