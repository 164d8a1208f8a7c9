#pragma once
#include "kernels/table.h"

namespace aa {
// As flip_constants.h has them for the usual distance.
struct FlipFilters {
    static constexpr int kMostReach = 24;
    int csfReach, narrowReach, featureReach;
    double csfY[kMostReach + 1], csfCx[kMostReach + 1], csfCzWide[kMostReach + 1], csfCzNarrow[kMostReach + 1];
    double gauss[kMostReach + 1], edge[kMostReach + 1], point[kMostReach + 1];
    double czWideShare;
};
struct FlipArgs {
    RgbIn test, reference;
    bool encoded;  // sRGB codes; otherwise linear and display-referred
    int stride, width, height;
    float* map;  // pixel (0,0) of a plane, or null
    int mapStride;
    double* rows;                // [height]: sums, zero at the start
    const FlipFilters* filters;  // of `given` alone
};
struct FlipKernels {
    RowKernel<FlipArgs> flip, given;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::FlipKernels, flipKernels)
