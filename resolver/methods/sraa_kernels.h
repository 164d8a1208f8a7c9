#pragma once
#include "kernels/subsample_args.h"

namespace aa {

// Pixels of other objects: may share, share nothing where the depth differs too, or share nothing.
enum class SraaIds { off, depth, always };
struct SraaArgs {
    RgbIn color;
    RgbOut out;
    const GeometryArgs* geometry;
    int radius;
    bool maxMetric, plainDepth;
    SraaIds ids;
    // Factors of the squared differences in base-2 exponents: log2(e) / (2 sigma^2); of the max metric: T log2(e).
    float spatial, depth, normal, sharpness;
    float depthSigma;      // SraaIds::depth: objects are told apart where the relative depth differs by more
    float* ownShareLayer;  // debug layer; null when not kept
};
struct SraaKernels {
    RowKernel<SraaArgs> resolve;
};

}  // namespace aa
AA_KERNEL_TABLE(aa::SraaKernels, sraaKernels)
