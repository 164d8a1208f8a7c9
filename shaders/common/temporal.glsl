// What every temporal shader binds and what it knows of its frame. A shader that includes this adds its own images from
// binding 7 on and its own constants from 10 on.
//
//   binding                      format           holds
//   0  currentImage    texture   RGBA 16F / 32F   the current frame, in the method's space
//   1  motionImage     texture   RG 16F / 32F     px, y down, current - previous position, without jitter
//   2  depthImage      texture   R 32F            planar view z > 0, background 1e10 (unused: any texture)
//   3  historyImage    texture   RGBA 16F / 32F   what `nextImage` was a frame ago
//   4  nextImage       image     RGBA 16F / 32F   the blend, this frame's history for the next
//   5  resultImage     image     RGBA 16F / 32F   what is shown (SEPARATE_RESULT; otherwise nextImage is, and any
//                                                 image stands here)
//   6  rejectionImage  image     R 32F            REJECTED_... where the history was not used, 0 = it was
//                                                 (KEEP_REJECTION; otherwise any image)
//
//   specialisation constants     default          means
//   0  DILATION                  closest 3 x 3    whose motion a pixel takes
//   1  HISTORY_FILTER            bilinear         filter that reads the history (reproject.glsl)
//   2  CLAMP_OUTSIDE             false            a history position outside: the edge's colour, not rejected
//   3  HARDWARE_FILTER           false            bilinear by the texture unit
//   4  KEEP_REJECTION            false
//   5  SEPARATE_RESULT           true             what is shown is stored beside the blend, be it the same
//
//   push constants               unit             of this frame
//   size                         px
//   texelOffset                  texels           where depth and motion are read: p + texelOffset
//   jitter                       px, y down       of the colours as they are read: 0 where they are un-jittered
//   readOffset                   px               where colours are read: p + readOffset (-jitter: un-jittered; 0: as
//                                                 they are)
//   feedbackCeiling              0..1             the history's largest weight
//   firstFrame                   0 or 1           1: there is no history
//   frameNumber                                   seed of noise
//   depthKnown                   0 or 1           1: expectedPreviousDepth() follows the cameras
//   perDepth, constant                            previous view depth of a static point at pixel position p and depth z:
//                                                 z (perDepth.xy . p + perDepth.z) + constant.xy . p + constant.z
#ifndef AA_TEMPORAL
#define AA_TEMPORAL
#include "colour.glsl"
#include "reproject.glsl"

#ifndef AA_GROUP  // side of the workgroup, px; a shader that wants another one says so before it includes this
#define AA_GROUP 8
#endif
layout(local_size_x = AA_GROUP, local_size_y = AA_GROUP) in;
layout(binding = 0) uniform sampler2D currentImage;
layout(binding = 1) uniform sampler2D motionImage;
layout(binding = 2) uniform sampler2D depthImage;
layout(binding = 3) uniform sampler2D historyImage;
layout(binding = 4) uniform writeonly image2D nextImage;
layout(binding = 5) uniform writeonly image2D resultImage;
layout(binding = 6) uniform writeonly image2D rejectionImage;
layout(constant_id = 0) const int DILATION = 0;
layout(constant_id = 1) const int HISTORY_FILTER = 0;
layout(constant_id = 2) const bool CLAMP_OUTSIDE = false;
layout(constant_id = 3) const bool HARDWARE_FILTER = false;
layout(constant_id = 4) const bool KEEP_REJECTION = false;
layout(constant_id = 5) const bool SEPARATE_RESULT = true;
layout(push_constant) uniform Frame {
    ivec2 size;
    ivec2 texelOffset;
    vec2 jitter;
    vec2 readOffset;
    float feedbackCeiling;
    uint firstFrame;
    uint frameNumber;
    uint depthKnown;
    vec4 perDepth;
    vec4 constant;
} frame;

vec3 colourAt(ivec2 p) { return texelAt(currentImage, p, frame.readOffset).rgb; }
float depthAt(ivec2 p) { return texel(depthImage, p + frame.texelOffset).r; }
vec2 motionAt(ivec2 p) { return texel(motionImage, p + frame.texelOffset).rg; }

// ---- dilation -------------------------------------------------------------------------------------------------------
// By number: of the surface nearest to the camera in 3 x 3, or of the centre and the diagonals alone; the longest; the
// pixel's own. The centre wins ties, otherwise the first in row-major order.
const int DILATE_CLOSEST_3X3 = 0, DILATE_CLOSEST_X = 1, DILATE_LONGEST_3X3 = 2, DILATE_NONE = 3;
struct Surface {
    float depth;
    vec2 motion;
};
Surface closestSurface(ivec2 p, bool diagonalsOnly) {
    float nearest = depthAt(p);
    ivec2 at = p;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            if ((i == 0 && j == 0) || (diagonalsOnly && (i == 0 || j == 0))) continue;
            const float z = depthAt(p + ivec2(i, j));
            if (z < nearest) nearest = z, at = p + ivec2(i, j);
        }
    return Surface(nearest, motionAt(at));
}
vec2 dilatedMotion(ivec2 p) {
    if (DILATION == DILATE_CLOSEST_3X3) return closestSurface(p, false).motion;
    if (DILATION == DILATE_CLOSEST_X) return closestSurface(p, true).motion;
    vec2 best = motionAt(p);
    if (DILATION == DILATE_LONGEST_3X3) {
        float longest = best.x * best.x + best.y * best.y;
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++) {
                if (i == 0 && j == 0) continue;
                const vec2 m = motionAt(p + ivec2(i, j));
                const float length2 = m.x * m.x + m.y * m.y;
                if (length2 > longest) longest = length2, best = m;
            }
    }
    return best;
}
// Of the surface whose motion dilatedMotion() takes by its depth; otherwise the pixel's own.
float dilatedDepth(ivec2 p) {
    if (DILATION == DILATE_CLOSEST_3X3) return closestSurface(p, false).depth;
    if (DILATION == DILATE_CLOSEST_X) return closestSurface(p, true).depth;
    return depthAt(p);
}

// ---- history --------------------------------------------------------------------------------------------------------
// Depth that the surface at p had in the previous camera, if it did not move by itself.
float expectedPreviousDepth(float depth, ivec2 p) {
    if (frame.depthKnown == 0u || depth >= 1e9) return depth;
    const vec2 c = vec2(p) + 0.5;
    const float perDepth = c.x * frame.perDepth.x + c.y * frame.perDepth.y + frame.perDepth.z;
    const float constant = c.x * frame.constant.x + c.y * frame.constant.y + frame.constant.z;
    return depth * perDepth + constant;
}
Reprojection reproject(ivec2 p, vec2 motion) { return reproject(p, motion, frame.size, CLAMP_OUTSIDE); }
vec3 fetchHistory(ivec2 p, Reprojection q) { return fetchHistory(historyImage, p, q, HISTORY_FILTER, HARDWARE_FILTER); }

const float REJECTED_NOT = 0.0, REJECTED_OUTSIDE = 1.0, REJECTED_DISOCCLUDED = 2.0, REJECTED_MAGNIFIED = 3.0,
            REJECTED_OTHER_OBJECT = 4.0, REJECTED_FIRST_FRAME = 5.0;
void storeRejection(ivec2 p, float reason) {
    if (KEEP_REJECTION) imageStore(rejectionImage, p, vec4(reason, 0.0, 0.0, 0.0));
}
void storeRejection(ivec2 p, bool inside) { storeRejection(p, inside ? REJECTED_NOT : REJECTED_OUTSIDE); }
void storeBlend(ivec2 p, vec3 next, float alpha, vec3 shown) {
    imageStore(nextImage, p, vec4(next, alpha));
    if (SEPARATE_RESULT) imageStore(resultImage, p, vec4(shown, 1.0));
}

#endif
