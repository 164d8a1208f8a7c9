#pragma once
#include "kernels/table.h"

namespace aa {
struct EdgeBlurArgs {
    const float* luma;
    RgbIn in;
    RgbOut out;
    float *directionX, *directionY;  // debug: blur vector, px; null when not wanted
    int stride, width;
    int scalePx;                // nfaa: distance of the lumas
    float strength, longestPx;  // nfaa: gain on the gradient, its largest length
    float reachPx, threshold;   // ssssaa: distance of the lumas, least gradient
};
struct EdgeBlurKernels {
    RowKernel<EdgeBlurArgs> nfaa, ssssaa;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::EdgeBlurKernels, edgeBlurKernels)
