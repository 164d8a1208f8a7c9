#pragma once
#include "methods/temporal_kernels.h"

namespace aa {
enum class DepthTest { window, point, off };
struct AccumRejectArgs {
    TemporalIn in;          // history alpha = depth of the frame it came from
    const float* residual;  // RGBA: low part of the mean, alpha = N
    float* nextResidual;
    const float* previousFarthest;          // 3x3 maximum of the previous depth
    const uint32_t *objectId, *previousId;  // null: ids are not compared
    ExpectedDepth expected;
    DepthTest depthTest;
    RejectionTest rejection;
    float nMaxStatic, nMaxMoving;
    float* debugCount;  // or null
};
// 3x3 maximum of a plane.
struct DilateMaxArgs {
    const float* in;
    float* out;
    int stride, width;
};
struct AccumRejectKernels {
    RowKernel<AccumRejectArgs> resolve;
    RowKernel<DilateMaxArgs> farthest;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::AccumRejectKernels, accumRejectKernels)
