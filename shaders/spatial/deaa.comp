// deaa, second pass: directionally adaptive edge anti-aliasing, over the box resolve of spatial/deaa_mark.comp.
//
//  1. pixels whose samples differ; isolated ones and those in the midst of nothing but edges keep the box
//  2. a plane through the luma of all samples of the 3x3 window; where it does not fit, the box stays
//  3. every sample within a rectangle along the isolines counts with the length that its isoline has inside the pixel
//
// Source: [Iourcha 2009], reconstructed (docs/sources.md).
// Colours: linear, >= 0. Positions in px from the pixel centre, y down.
//
//   binding                    format           holds
//   0  sampleImages  textures  RGBA 16F / 32F   the sub-samples, one layer each
//   1  resultImage   image     RGBA 16F / 32F   the box resolve; written where a filtered colour replaces it
//   2  edgeImage     texture   R 32UI           1 where the samples of a pixel differ
//   3  Samples       buffer                     their offsets
//
//   constant            default   means
//   10 SAMPLES          8         2 to 16
//   11 FIT_TOLERANCE    0.3       rms of the fit relative to the window's luma range
//   12 MAX_LENGTH_PX    3         of the rectangle along the isolines
//   13 INVERSE_XX       0         inverse normal matrix of the plane fit over the window's samples
//   14 INVERSE_XY       0
//   15 INVERSE_YY       0
//
//   push constants      unit
//   size                px
#version 460
#extension GL_GOOGLE_include_directive : require
#include "../common/colour.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2DArray sampleImages;
layout(binding = 1) uniform writeonly image2D resultImage;
layout(binding = 2) uniform usampler2D edgeImage;
layout(std430, binding = 3) readonly buffer Samples {
    vec2 offsetsPx[];
};
layout(constant_id = 10) const int SAMPLES = 8;
layout(constant_id = 11) const float FIT_TOLERANCE = 0.3;
layout(constant_id = 12) const float MAX_LENGTH_PX = 3.0;
layout(constant_id = 13) const float INVERSE_XX = 0.0;
layout(constant_id = 14) const float INVERSE_XY = 0.0;
layout(constant_id = 15) const float INVERSE_YY = 0.0;
layout(push_constant) uniform Frame {
    ivec2 size;
} frame;

bool insidePicture(ivec2 p) { return all(greaterThanEqual(p, ivec2(0))) && all(lessThan(p, frame.size)); }
bool isEdge(ivec2 p) { return insidePicture(p) && texel(edgeImage, p) != 0u; }
vec3 sampleAt(ivec2 p, int k) { return texelFetch(sampleImages, ivec3(clampTexel(p, frame.size), k), 0).rgb; }

int edgePixelsAround(ivec2 p) {
    int n = 0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) n += isEdge(p + ivec2(i, j)) ? 1 : 0;
    return n;
}
struct Plane {
    vec2 gradient;  // of luma per px
    bool fits, level;
};
// Of the window's range per px: a gradient below it is what rounding leaves of none, and has no direction.
const float LEVEL = 1e-6;
// Least squares over all samples of the window; lumas minus that of the centre's first sample.
Plane fittedPlane(ivec2 p) {
    const int count = 9 * SAMPLES;
    vec2 middle = vec2(0.0);
    for (int k = 0; k < SAMPLES; k++) middle = middle + offsetsPx[k];
    middle = middle / float(SAMPLES);
    const float own = luma709(sampleAt(p, 0));
    float sum = 0.0, lowest = 0.0, highest = 0.0;
    vec2 moment = vec2(0.0);
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            for (int k = 0; k < SAMPLES; k++) {
                const float v = luma709(sampleAt(p + ivec2(i, j), k)) - own;
                sum = sum + v;
                lowest = min(lowest, v);
                highest = max(highest, v);
                moment = moment + (offsetsPx[k] + vec2(i, j) - middle) * v;
            }
    const float mean = sum / float(count);
    Plane plane;
    plane.gradient = vec2(INVERSE_XX * moment.x + INVERSE_XY * moment.y, INVERSE_XY * moment.x + INVERSE_YY * moment.y);
    float squares = 0.0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            for (int k = 0; k < SAMPLES; k++) {
                const float v = luma709(sampleAt(p + ivec2(i, j), k)) - own;
                const float e = v - mean - dot(plane.gradient, offsetsPx[k] + vec2(i, j) - middle);
                squares = squares + e * e;
            }
    plane.fits = sqrt(squares / float(count)) <= FIT_TOLERANCE * (highest - lowest);
    plane.level = !(length(plane.gradient) > LEVEL * (highest - lowest));
    return plane;
}
// Length of the line through `at` along the unit vector `t` inside the unit square around the origin. Isolines within a
// millionth of an axis lie on it: samples on the square's side then count in full.
const float PARALLEL = 1e-6;
float chord(vec2 at, vec2 t) {
    float from = -1e30, to = 1e30;
    for (int axis = 0; axis < 2; axis++) {
        if (abs(t[axis]) < PARALLEL) {
            if (abs(at[axis]) > 0.5) return 0.0;
            continue;
        }
        const float a = (-0.5 - at[axis]) / t[axis], b = (0.5 - at[axis]) / t[axis];
        from = max(from, min(a, b));
        to = min(to, max(a, b));
    }
    return max(0.0, to - from);
}

void main() {
    const ivec2 p = ivec2(gl_GlobalInvocationID.xy);
    if (!insidePicture(p)) return;

    // 1. edges
    if (!isEdge(p)) return;
    const int around = edgePixelsAround(p);
    if (around < 2 || around == 9) return;

    // 2. plane
    const Plane plane = fittedPlane(p);
    if (!plane.fits || plane.level) return;
    const vec2 along = vec2(-plane.gradient.y, plane.gradient.x) / length(plane.gradient);

    // 3. integral
    float total = 0.0;
    vec3 sum = vec3(0.0);
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            for (int k = 0; k < SAMPLES; k++) {
                const vec2 at = offsetsPx[k] + vec2(i, j);
                if (abs(dot(at, along)) > 0.5 * MAX_LENGTH_PX + PARALLEL) continue;
                const float w = chord(at, along);
                total = total + w;
                sum = sum + sampleAt(p + ivec2(i, j), k) * w;
            }
    if (total > 0.0) imageStore(resultImage, p, vec4(sum / total, 1.0));
}
