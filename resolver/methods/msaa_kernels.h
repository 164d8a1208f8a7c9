#pragma once
#include "kernels/display_args.h"
#include "kernels/subsample_args.h"
#include "kernels/surface_rule.h"

namespace aa {

inline constexpr int kMsaaMaxSamples = 32;
struct MsaaArgs {
    RgbIn color;   // linear
    RgbIn copied;  // what a pixel of one surface keeps: `color`, or its displayed values
    RgbOut out;
    const GeometryArgs* geometry;
    SurfaceRule rule;
    int slots;                   // sub-samples 0..slots-1 hold a colour; msaa: all of them
    const int* order;            // sub-samples by distance from the pixel centre
    const int* nearestSlot;      // of each sub-sample
    bool byGeometry;             // surfaces are objects split by geometry, or whole objects
    bool centroid;               // shade a partly covered surface at a covered sub-sample even if it covers the centre
    bool encoded;                // average displayed values
    DisplayArgs display;         // what makes them
    bool inverseLuminance;       // weight 1 / (1 + luminance)
    const RgbOut* sampleColors;  // per sub-sample: where its surface's colour goes; null when no filter follows
    float *surfacesLayer, *coverageLayer;  // debug layers; null when not kept
};
struct MsaaKernels {
    RowKernel<MsaaArgs> resolve;
};

}  // namespace aa
AA_KERNEL_TABLE(aa::MsaaKernels, msaaKernels)
