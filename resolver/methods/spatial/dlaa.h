// DLAA: directionally localised anti-aliasing [Andreev 2011].
//
// 1. A high-pass gives the strength of edges. 2. Short edges: blur along the direction in which the other direction's
// high-pass is strong. 3. Long edges, where the strength over 16 px in one direction dominates: shift across the edge
// so that the luma matches the blur along it. Encoded colour; taps in px. Constants are those of published ports.
// Bilinear taps at half pixels are written as the pixels that they average.
// Deviation: three decisions that jump where nothing visible differs fade over what 8 bits cannot tell
// (dlaa_kernels.h): the ratio of nearly equal lumas, the "all four shares are 0" rule and the dominance of one
// direction. As published, neighbours that differ by 1e-8 moved single pixels by 0.3, in float otherwise than in
// double.
#pragma once
#include "kernels/table.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor dlaaDescriptor();

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
