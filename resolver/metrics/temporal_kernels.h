#pragma once
#include "kernels/table.h"

namespace aa {

// Planes of one stride; pixel (0,0). Columns [first, end) count.
struct StepArgs {
    const float *luma, *previous;  // now and one frame ago, its border filled
    const float *qx, *qy;          // where a pixel was, px; NaN where nobody knows
    int stride, first = 0, end = 0;
    float* step = nullptr;             // what the luma of a pixel changed by, 0 where nobody knows; or null
    const float* truthStep = nullptr;  // the same of the truth; or null
    double* rows = nullptr;            // [height][2]: sums of (step - truthStep)^2, and how many; needed with truthStep
};
struct SpreadArgs {
    const float *luma, *previous;  // previous: null where there is none
    int stride, first = 0, end = 0;
    int count;               // of frames, this one included
    float *mean, *spread;    // over time; of the squared deviations their sum
    double* rows = nullptr;  // [height][2]: sums of |luma - previous| and of its square
};
struct TemporalMetricKernels {
    RowKernel<StepArgs> step;
    RowKernel<SpreadArgs> spread;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::TemporalMetricKernels, temporalMetricKernels)
