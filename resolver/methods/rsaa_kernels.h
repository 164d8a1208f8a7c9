#pragma once
#include "kernels/dissimilarity.h"
#include "kernels/subsample_args.h"

namespace aa {

struct RsaaNeighbours {  // neighbouring pixels, -1..1, that may show a sub-sample's surface
    int at[3][2], count;
};
struct RsaaArgs {
    RgbIn color;
    RgbOut out;
    int stride, width, height, samples;
    const float* offsetsPx;            // u, v for each of the 2^samples masks
    const GeometryArgs* geometry;      // empty where the mask pass replaces it and tuning is off
    const RsaaNeighbours* neighbours;  // of each sub-sample
    const uint32_t* maskPass;          // null: the mask is computed
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
