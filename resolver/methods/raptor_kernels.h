#pragma once
#include "methods/temporal_kernels.h"

namespace aa {
enum class RaptorConstraint { none, clamp, clip, varianceClip, varianceClipClamp };
enum class LuminanceDifference { off, corrected, printed };
struct RaptorArgs {
    TemporalIn in;
    float filter[9];  // weights of the 3x3 current samples, row-major; their sum may be 0: then the centre alone
    RaptorConstraint constraint;
    LuminanceDifference luminanceDifference;
    bool temporalFiltering, ycocg;
    bool luminanceWeights;  // 1 / (1 + L)
    bool clampCurrent;      // the filtered current colour is held within the window's bounds
    bool signedDivisor;     // temporal filtering divides by the colour as it is: printed
    float gamma, kMin, kMax;
};
struct RaptorKernels {
    RowKernel<RaptorArgs> resolve;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::RaptorKernels, raptorKernels)
