#pragma once
#include "kernels/table.h"

namespace aa {
struct FlipArgs {
    RgbIn test, reference;  // linear display-referred
    int stride, width, height;
    float* map;  // pixel (0,0) of a plane, or null
    int mapStride;
    double* rows;  // [height][kSumStrands], zero at the start
};
struct FlipKernels {
    RowKernel<FlipArgs> flip;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::FlipKernels, flipKernels)
