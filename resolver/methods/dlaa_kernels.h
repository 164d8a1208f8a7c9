#pragma once
#include "kernels/table.h"

namespace aa {
// A long edge needs a mean strength above 1/2 over 16 pixels. With fewer than 6 of them at 1/4 or more that cannot be:
// 5 * 1 + 11 / 4 < 8.
inline constexpr float kDlaaStrong = 0.25f;
inline constexpr int kDlaaFewestStrong = 6;
struct DlaaEdgeArgs {
    RgbIn in;
    float* edge;      // strength in [0,1]
    uint8_t* strong;  // a bit per pixel whose strength reaches kDlaaStrong, (width + 7) / 8 bytes per row
    int stride, width;
};
struct DlaaArgs {
    RgbIn in;
    const float* edge;
    RgbOut out;
    const uint8_t* strong;
    float *shortMask, *longMask;  // debug: horizontal minus vertical; null when not wanted
    int stride, width, height;
    float lambda, epsilon, longThreshold;
    bool preserveHighlights;
};
struct DlaaKernels {
    RowKernel<DlaaEdgeArgs> edges;
    RowKernel<DlaaArgs> filter;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::DlaaKernels, dlaaKernels)
