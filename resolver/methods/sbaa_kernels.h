#pragma once
#include "kernels/subsample_args.h"
#include "kernels/surface_rule.h"

namespace aa {

inline constexpr int kSbaaMaxSamples = 16;
struct SbaaArgs {
    RgbIn color;
    RgbOut out;
    const GeometryArgs* geometry;
    SurfaceRule merge;
    int surfaces;  // kept per pixel
    bool ids;      // objects stay apart before the reduction
    // Debug layers; null when not kept: surfaces before and after the reduction, sub-samples of the one that covers
    // most.
    float *clustersLayer, *surfacesLayer, *largestLayer;
};
struct SbaaKernels {
    RowKernel<SbaaArgs> resolve;
};

}  // namespace aa
AA_KERNEL_TABLE(aa::SbaaKernels, sbaaKernels)
