#pragma once
#include "kernels/table.h"

namespace aa {
// One sub-sample of a neighbouring pixel in the filter's footprint.
struct ResolveTap {
    int dx, dy;  // pixel offset
    int sample;
    float weight;  // normalised: the weights sum to 1
};
struct ResolveArgs {
    const RgbIn* samples;  // linear colours, one image per sub-sample; borders filled
    int sampleCount;
    const ResolveTap* taps;
    int tapCount;
    bool inverseLuminance;  // weight * 1 / (1 + Y601 * scale)
    float luminanceScale;   // 2^exposure
    RgbOut out;
    int stride, width;
};
struct ResolveKernels {
    RowKernel<ResolveArgs> resolve;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::ResolveKernels, resolveKernels)
