#pragma once
#include "kernels/table.h"

namespace aa {

struct EdgeBlendArgs {
    RgbIn color;
    RgbOut out;
    const float *edgeXPx, *edgeYPx;
    int stride, width;
    bool searchNeighbours;               // gbaa only
    float *offsetXLayer, *offsetYLayer;  // debug layers; null when not kept
};
struct GbaaKernels {
    RowKernel<EdgeBlendArgs> gbaa, d2e;
};

}  // namespace aa
AA_KERNEL_TABLE(aa::GbaaKernels, gbaaKernels)
