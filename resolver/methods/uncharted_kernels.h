#pragma once
#include "methods/temporal_kernels.h"

namespace aa {
struct UnchartedArgs {
    TemporalIn in;
    float kMin, kMax;
    Neighbourhood neighbourhood;
    ClipTarget clipTarget;
    Luminance luminance;  // of the feedback
};
struct UnchartedKernels {
    RowKernel<UnchartedArgs> resolve;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::UnchartedKernels, unchartedKernels)
