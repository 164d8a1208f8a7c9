#pragma once
#include "kernels/table.h"

namespace aa {
inline constexpr int kDlaaReach = 8;  // px that the blur along a long edge reads to either side
// A long edge needs a mean strength above 1/2 over 16 pixels. With fewer than 6 of them at 1/4 or more that cannot be:
// 5 * 1 + 11 / 4 < 8.
inline constexpr float kDlaaStrong = 0.25f;
inline constexpr int kDlaaFewestStrong = 6;
// Where a decision of the method jumps, rounding would make it: the result then depends on the precision, and two
// frames that differ by nothing visible differ. It fades over a range that 8 bits cannot tell apart instead.
inline constexpr double kDlaaEqualLumas = 0.5 / 255;  // half a code: the ratio of a shift goes to 1, its value at 0
inline constexpr double kDlaaFade = 1.0 / 255;        // of a mask or of the shares of a shift
struct DlaaEdgeArgs {
    RgbIn in;
    float *edge, *luma;  // strength in [0,1]; the kernel fills their borders, as far as kDlaaReach
    // Of each group of 8 columns, (width + 7) / 8 per row: how many strengths reach kDlaaStrong, and a bit per pixel
    // one of whose second differences, along x or along y, exceeds busyAbove in a channel.
    uint8_t *strong, *busy;
    int stride, width, height;
    float busyAbove;
};
struct DlaaArgs {
    RgbIn in;
    const float *edge, *luma;
    RgbOut out;
    const uint8_t *strong, *busy;
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
