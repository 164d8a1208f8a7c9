#pragma once
#include "kernels/table.h"

namespace aa {

inline constexpr int kSumStrands = 8;  // partial sums per row, by x mod 8: one order of addition for every lane width
inline constexpr int kErrorTilePx = 8;

struct SquaredErrorArgs {
    RgbIn test, reference;
    int stride, width;
    int tilesX;
    double* tileRows;  // [height][tilesX]: sums of (T-R)^2 of one row of each tile
};
struct SquaresArgs {
    RgbIn image;
    int stride, width;
    double* rows;  // [height]: sums of squares
};
struct LumaArgs {
    RgbIn in;
    int stride, width;
    float* out;  // a plane of the same stride; BT.601
};
struct RelativeErrorArgs {
    RgbIn test, reference;
    int stride, width;
    double* rows;  // [height]
};

enum class SsimSignal { red, green, blue, luma, volume };  // the first three: channels 0, 1, 2
struct SsimArgs {
    RgbIn test, reference;
    int stride, width, height;
    SsimSignal signal;
    float* map;  // pixel (0,0) of a plane, or null
    int mapStride;
    double* rows;  // [height]: sums, zero at the start
};
struct DitherArgs {
    RgbOut image;
    int stride, width;
    uint32_t frame;
};
struct MetricsKernels {
    RowKernel<LumaArgs> luma;
    RowKernel<SquaredErrorArgs> squaredError;
    RowKernel<SquaresArgs> squares;
    RowKernel<RelativeErrorArgs> relativeError;
    RowKernel<SsimArgs> ssim;
    RowKernel<DitherArgs> dither;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::MetricsKernels, metricsKernels)
