// taaSimplest: exponential blend of the current frame with its reprojected history, nothing else.
// Source: [Castorina 2023, "The simplest TAA implementation"].
//
// Input and output: linear light; motion in px, current - previous. No dilation, no rejection but the border test (the
// printed code has none: `outside=clamp`), so moving surfaces leave trails and bilinear reads blur in motion: the lower
// baseline of the temporal family. On a static scene nothing drifts.
#pragma once
#include "methods/temporal/temporal_kernels.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor taaSimplestDescriptor();

struct TaaSimplestArgs {
    TemporalIn in;
    float feedback;  // weight of history
};
struct TaaSimplestKernels {
    RowKernel<TaaSimplestArgs> resolve;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::TaaSimplestKernels, taaSimplestKernels)
