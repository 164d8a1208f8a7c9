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
struct FollowArgs {
    const float *motionXPx, *motionYPx;
    const float *depth, *previousDepth;  // now and one frame ago, its border filled
    const uint32_t *id, *previousId;
    const uint32_t* previousAge;  // one frame ago, 0 where nothing was on the trail
    uint32_t oldest;              // age from which a pixel leaves the trail
    int stride, width, height;
    float *qx, *qy;  // where a pixel was, px; qx: NaN where it was not to be seen
    uint32_t* age;   // 1: it came into view; more: since when it is, carried along the motion; else 0
};
struct SpreadArgs {
    const float *luma, *previous;  // previous: null where there is none
    int stride, first = 0, end = 0;
    int count;               // of frames, this one included
    float *mean, *spread;    // over time; of the squared deviations their sum
    double* rows = nullptr;  // [height][2]: sums of |luma - previous| and of its square
};
struct TemporalMetricKernels {
    RowKernel<FollowArgs> follow;
    RowKernel<StepArgs> step;
    RowKernel<SpreadArgs> spread;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::TemporalMetricKernels, temporalMetricKernels)
