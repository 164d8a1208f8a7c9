#pragma once
#include "kernels/subsample_args.h"

namespace aa {

enum class DmsaaVector { perS, perD, ideal };
struct DmsaaArgs {
    RgbIn color;
    RgbOut out;
    const GeometryArgs* geometry;
    const float* positionsPx;  // x, y of each sub-sample from the pixel centre
    DmsaaVector vector;
    float depthThreshold, gain;
    float *countLayer, *offsetXLayer, *offsetYLayer;  // debug layers; null when not kept
};
struct DmsaaKernels {
    RowKernel<DmsaaArgs> resolve;
};

}  // namespace aa
AA_KERNEL_TABLE(aa::DmsaaKernels, dmsaaKernels)
