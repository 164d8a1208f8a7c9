#pragma once
#include "kernels/dissimilarity.h"
#include "kernels/table.h"

namespace aa {

struct RsaaSample {
    const float* depthView;
    RgbIn normalWorld;
    const uint32_t* objectId;
    float offsetPx[2];     // from the centre sample
    int neighbours[3][2];  // neighbouring pixels, -1..1, that may show this sub-sample's surface
    int neighbourCount;
};
struct RsaaArgs {
    RgbIn color;
    RgbOut out;
    int stride, width, height;
    int samples;
    const float* offsetsPx;  // u, v for each of the 2^samples masks

    // Geometry; null where the mask pass replaces it and tuning is off.
    const float* depthView;
    RgbIn normalWorld;
    const uint32_t* objectId;  // null: objects are not told apart
    const RsaaSample* sample;
    float ray[3], rayX[3], rayY[3];  // world-space ray of the centre sample of pixel (0, 0), and its change per pixel
    float originX[3], originY[3];    // as in CameraRays
    const uint32_t* maskPass;        // null: the mask is computed
    Dissimilarity measure;
    float floor;  // below it everything is one surface
    bool adaptive, tuning, tuneAdaptive;

    // Debug layers; null when not kept.
    float *maskLayer, *tunedLayer, *dissimilarityLayer, *offsetXLayer, *offsetYLayer;
};
struct RsaaKernels {
    RowKernel<RsaaArgs> resolve;
};

}  // namespace aa
AA_KERNEL_TABLE(aa::RsaaKernels, rsaaKernels)
