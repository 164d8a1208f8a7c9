// The FXAA family ([Lottes 2009], [Lottes 2011], [Stanard n.d.]): blends every pixel with the neighbour across the edge
// that it lies on, by the share that an edge through the two ends of the visible step would cover.
//
// fxaa311: where the local luma contrast is high enough, take the direction of the edge, the side with the steeper
// gradient, walk along the boundary both ways until the luma of the pair changes, and shift the sampling point across
// the boundary by (0.5 - nearer end / both ends) px, or further where the pixel stands out of its 3x3 neighbourhood.
// Input: encoded RGB in [0,1] and one luma per pixel. Positions in px, y down; taps clamp to the image.
// Deviation: edge pixels are decided in double with a relative tolerance of 1e-6 on two comparisons that are exact ties
// on clean edges (orientation; a sample half a pixel short of the end), which rounding would decide otherwise.
#pragma once
#include "kernels/table.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor fxaa311Descriptor();
MethodDescriptor fxaa1Descriptor();        // white paper: exhaustive search, low-pass against sub-pixel aliasing
MethodDescriptor fxaaCsDescriptor();       // compute shader (J. Stanard): log-luma decisions, blend in linear light
MethodDescriptor fxaaConsoleDescriptor();  // FXAA 3.11 console: four taps along the local edge direction

inline constexpr int kFxaaMaxSteps = 12;
// Searches read 8 px at a time: at distances of 1 to 8, 9 to 16 and 17 to 24 px, and half a pixel further.
inline constexpr int kFxaaWindows = 3;
inline constexpr int kFxaaBorder = 32;  // repeated pixels around the lumas: more than a search overshoots the image

// Common to the family: a luma plane with filled border, the colour to filter, thresholds ([Lottes 2009],
// [Lottes 2011]).
struct FxaaArgs {
    const float* luma;
    const float* transposedLuma;  // for searches along columns; null in the variants that search step by step
    RgbIn in;
    RgbOut out;
    int stride, lumaStride, transposedStride, width, height;
    float edgeThreshold, edgeThresholdMin;
    double subpix;
    int steps;
    int distanceHalfPx[kFxaaMaxSteps];  // cumulative search distances in half pixels
    // The same for searches by windows: which of its 8 distances are sampled, and which of those half a pixel further.
    unsigned sampled[kFxaaWindows], half[kFxaaWindows];
    unsigned sampledMirrored[kFxaaWindows], halfMirrored[kFxaaWindows];  // for the search toward smaller addresses
    int windows;
    float* orientation;  // debug: 1 horizontal, 2 vertical, 0 no edge; null when not wanted
    // Debug: distances to the two ends, and the shift across the edge; of the console variant the direction of its
    // taps, and whether the outer ones count.
    float *negativePx, *positivePx, *shiftPx;
};
struct FxaaTransposeArgs {
    const float* from;
    float* to;
    int fromStride, toStride, height;
};
struct FxaaKernels {
    RowKernel<FxaaArgs> fxaa311;
    RowKernel<FxaaTransposeArgs> transpose;  // over blocks of 16 columns
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
