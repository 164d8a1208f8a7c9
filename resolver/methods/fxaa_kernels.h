#pragma once
#include "kernels/table.h"

namespace aa {
inline constexpr int kFxaaMaxSteps = 12;

// Common to the family: a luma plane with filled border, the colour to filter, thresholds (methods/02).
struct FxaaArgs {
    const float* luma;
    RgbIn in;
    RgbOut out;
    int stride, width, height;
    float edgeThreshold, edgeThresholdMin;
    double subpix;
    int steps;
    int distanceHalfPx[kFxaaMaxSteps];         // cumulative search distances in half pixels
    float* orientation;                        // debug: 1 horizontal, 2 vertical, 0 no edge; null when not wanted
    float *negativePx, *positivePx, *shiftPx;  // debug: distances to the two ends, and the shift across the edge
};
struct FxaaKernels {
    RowKernel<FxaaArgs> fxaa311;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::FxaaKernels, fxaaKernels)
