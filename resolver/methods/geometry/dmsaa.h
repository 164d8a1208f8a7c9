// dmsaa: deferred MSAA filter. The colour is fetched beside the pixel centre, toward the sub-samples whose depth
// differs.
//
// Source: [Pettineo 2010] as told in [Reshetov 2012, slide 16]; decisions 31. Linear light. The talk says "averaging
// all sub-samples" and "in the direction of the average vector" only, so there are three readings of the shift u = sum
// of the differing offsets: perS = u / S (default), perD = u / number of differing samples, ideal = the unit vector of
// u times the differing share, which makes the shift the covered area. Shifts are clamped to 1 px; u = 0 keeps the
// colour.
#pragma once
#include "kernels/subsample_args.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor dmsaaDescriptor();

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
