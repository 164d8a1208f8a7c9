#pragma once
#include "kernels/table.h"

namespace aa {
// As flip_constants.h has them for the usual distance.
struct FlipFilters {
    static constexpr int kMostReach = 24;
    int csfReach, narrowReach, featureReach;
    double csfY[kMostReach + 1], csfCx[kMostReach + 1], csfCzWide[kMostReach + 1], csfCzNarrow[kMostReach + 1];
    double czWideAlongX[kMostReach + 1], czNarrowAlongX[kMostReach + 1];
    double gauss[kMostReach + 1], edge[kMostReach + 1], point[kMostReach + 1];
};
// What is seen of a picture: blocks of kFlipTileRows rows and kFlipColumns columns, a row of blocks after the other; of
// each block the kFlipSeen quantities, and of each of these one column after the other. In the arithmetic's own
// precision.
inline constexpr int kFlipTileRows = 8, kFlipColumns = 256, kFlipSeen = 5;
// Rows of blocks that a thread takes: each take repeats the loading of 20 rows.
inline constexpr int kFlipPiece = 16;
struct FlipArgs {
    RgbIn image;
    bool encoded;  // sRGB codes; otherwise linear and display-referred
    int stride, width, height;
    const FlipFilters* filters;       // of `seeFrom` and `judgeFrom`, which look from another distance than usual
    void* seen = nullptr;             // of the image, to be written: see
    const void* reference = nullptr;  // what is seen of what the image is held against: judge
    float* map = nullptr;             // of FLIP: pixel (0,0) of a plane; or null
    int mapStride = 0;
    double* rows = nullptr;  // [height]: sums of FLIP, zero at the start
};
struct FlipKernels {
    RowKernel<FlipArgs> see, judge, seeFrom, judgeFrom;  // of rows of blocks
};
}  // namespace aa
AA_KERNEL_TABLE(aa::FlipKernels, flipKernels)
