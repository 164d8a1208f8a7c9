#pragma once
#include "methods/temporal_kernels.h"

namespace aa {
struct TaaSimplestArgs {
    TemporalIn in;
    float feedback;  // weight of history
};
struct TaaSimplestKernels {
    RowKernel<TaaSimplestArgs> resolve;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::TaaSimplestKernels, taaSimplestKernels)
