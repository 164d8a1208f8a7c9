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

// FXAA 1: sub-pixel aliasing is removed by mixing in a low-pass instead of by shifting further.
struct Fxaa1Args : FxaaArgs {
    double subpixCap, subpixTrim;
    int acceleration;   // pixels per read of the search
    bool crossLowPass;  // mean of 5 taps instead of 9
};
// Compute-shader variant: `subpix` is SubpixelRemoval; edgeThreshold is unused (the contrast test is absolute).
struct FxaaCsArgs : FxaaArgs {};
// Console variant: four taps along the edge.
struct FxaaConsoleArgs : FxaaArgs {
    double reachPx, sharpness;
};
struct FxaaVariantKernels {
    RowKernel<Fxaa1Args> fxaa1;
    RowKernel<FxaaCsArgs> fxaaCs;
    RowKernel<FxaaConsoleArgs> console;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::FxaaVariantKernels, fxaaVariantKernels)
AA_KERNEL_TABLE(aa::FxaaKernels, fxaaKernels)
