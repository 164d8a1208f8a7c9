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
    int surfaces;                          // kept per pixel
    float *clustersLayer, *surfacesLayer;  // debug layers: before and after the reduction; null when not kept
};
struct SbaaKernels {
    RowKernel<SbaaArgs> resolve;
};

}  // namespace aa
AA_KERNEL_TABLE(aa::SbaaKernels, sbaaKernels)
