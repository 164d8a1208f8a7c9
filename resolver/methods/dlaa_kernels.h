#pragma once
#include "kernels/table.h"

namespace aa {
struct DlaaEdgeArgs {
    RgbIn in;
    float* edge;  // strength in [0,1]
    int stride, width;
};
struct DlaaArgs {
    RgbIn in;
    const float* edge;
    RgbOut out;
    float *shortMask, *longMask;  // debug: horizontal minus vertical; null when not wanted
    int stride, width;
    float lambda, epsilon, longThreshold;
    bool preserveHighlights;
};
struct DlaaKernels {
    RowKernel<DlaaEdgeArgs> edges;
    RowKernel<DlaaArgs> filter;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::DlaaKernels, dlaaKernels)
