// accumReject: running mean along the motion, forgotten where the surface was not visible before; no colour constraint.
// Our reference among the temporal methods (decisions 51): what identity (depth, object ids) alone can do.
//
//  1. q = p - motion   2. reject when q is outside, when the previous frame shows only nearer surfaces around q, or no
//  pixel of this object   3. N = N(q) + 1, capped at 1e5 at rest and 16 in motion; out = h + (c - h) / N
// The mean is a compensated pair of floats, so that 1e5 frames lose nothing (conventions 9). Linear light.
// Deviation: the depth test of conventions 7.3 compares one depth. With jittered frames a silhouette pixel of a static
// scene shows now one surface, now the other, and would be rejected every few frames; so `depthTest=window` accepts
// when any pixel of the previous 3x3 around q is as far as this one, and ids are sought in that window.
// `depthTest=point` is the printed test.
#pragma once
#include "methods/temporal/temporal_kernels.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor accumRejectDescriptor();

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
