// What every shader binds that reads the geometry of sub-samples, and what it knows of its frame. A shader that
// includes this adds its own bindings from 10 on and its own constants from 10 on.
//
// The centre sample of a pixel lies at its centre plus the frame's jitter; sub-sample k lies offsetsPx[k] beside it, as
// a GPU jitters all samples of a pixel together. Functions take a sample by its number: CENTRE, or 0 and up.
//
//   binding                           format           holds (where a method reads it: any texture otherwise)
//   0  colourImage        texture     RGBA 16F / 32F   centre samples: linear BT.709, >= 0
//   1  resultImage        image       RGBA 16F / 32F   what is shown
//   2  depthImage         texture     R 32F            planar view z > 0, background 1e10
//   3  normalImage        texture     RGBA 32F         world, unit; zero: none
//   4  objectImage        texture     R 32UI           object, 0 = background
//   5  sampleDepthImage   texture     R 32F            the same of the sub-samples, one layer each
//   6  sampleNormalImage  texture     RGBA 32F
//   7  sampleObjectImage  texture     R 32UI
//   8  sampleColourImage  texture     RGBA 16F / 32F
//   9  Offsets            buffer      {float x, y}     px from the centre sample, y down
//
//   specialisation constant   default   means
//   0  SAMPLES                8         sub-samples per pixel
//
//   push constants      unit   of this frame
//   size                px
//   toneMap, srgb, displayScale       the display chain of common/colour.glsl, where displayed values are averaged
//   ray, rayX, rayY            world-space ray, per unit of view depth, of the centre sample of pixel (0, 0), and its
//                              change per px
//   originX, originY           change per px of a ray's origin: zero for a perspective camera
#ifndef AA_SUBSAMPLES
#define AA_SUBSAMPLES
#include "dissimilarity.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D colourImage;
layout(binding = 1) uniform writeonly image2D resultImage;
layout(binding = 2) uniform sampler2D depthImage;
layout(binding = 3) uniform sampler2D normalImage;
layout(binding = 4) uniform usampler2D objectImage;
layout(binding = 5) uniform sampler2DArray sampleDepthImage;
layout(binding = 6) uniform sampler2DArray sampleNormalImage;
layout(binding = 7) uniform usampler2DArray sampleObjectImage;
layout(binding = 8) uniform sampler2DArray sampleColourImage;
layout(std430, binding = 9) readonly buffer Offsets { vec2 offsetsPx[]; };
layout(constant_id = 0) const int SAMPLES = 8;
layout(push_constant) uniform Frame {
    ivec2 size;
    int toneMap;
    uint srgb;
    vec3 ray;
    float displayScale;
    vec3 rayX;
    vec3 rayY;
    vec3 originX;
    vec3 originY;
} frame;

const int CENTRE = -1;

float depthOf(ivec2 p, int k) {
    return k < 0 ? texel(depthImage, p).r : texelFetch(sampleDepthImage, ivec3(p, k), 0).r;
}
vec3 normalOf(ivec2 p, int k) {
    return k < 0 ? texel(normalImage, p).rgb : texelFetch(sampleNormalImage, ivec3(p, k), 0).rgb;
}
uint objectOf(ivec2 p, int k) {
    return k < 0 ? texel(objectImage, p) : texelFetch(sampleObjectImage, ivec3(p, k), 0).r;
}
vec3 colourOf(ivec2 p, int k) {
    return k < 0 ? texel(colourImage, p).rgb : texelFetch(sampleColourImage, ivec3(p, k), 0).rgb;
}
vec2 positionOf(int k) { return k < 0 ? vec2(0.0) : offsetsPx[k]; }  // px from the centre sample
SurfacePoint surfacePoint(ivec2 p, int k) { return SurfacePoint(depthOf(p, k), normalOf(p, k)); }

// From the point seen `from` px beside the centre sample of pixel p to the one seen `stepPx` farther.
Separation separation(ivec2 p, vec2 from, vec2 stepPx) {
    const vec2 at = vec2(p) + from;
    precise vec3 ray = frame.ray + frame.rayX * at.x + frame.rayY * at.y;
    precise vec3 stepRay = frame.rayX * stepPx.x + frame.rayY * stepPx.y;
    precise vec3 stepOrigin = frame.originX * stepPx.x + frame.originY * stepPx.y;
    return Separation(ray, stepRay, stepOrigin);
}
// From sample a to sample b of pixel p.
Separation separation(ivec2 p, int a, int b) {
    return separation(p, positionOf(a), positionOf(b) - positionOf(a));
}
bool sameObject(ivec2 p, int a, int b) { return objectOf(p, a) == objectOf(p, b); }
bool sameGeometry(ivec2 p, int a, int b, float leastCosine, float mostDistance) {
    return sameSurface(surfacePoint(p, a), surfacePoint(p, b), separation(p, a, b), leastCosine, mostDistance);
}

#endif
