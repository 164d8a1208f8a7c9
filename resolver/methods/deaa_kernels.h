#pragma once
#include "kernels/table.h"

namespace aa {
inline constexpr int kDeaaMaxSamples = 16;
struct DeaaArgs {
    const RgbIn* samples;     // linear colours, borders filled
    const double *xPx, *yPx;  // offsets from the pixel centre, y down
    int sampleCount;
    double fitTolerance, maxLengthPx, sameColour;
    double invXX, invXY, invYY;  // inverse normal matrix of the plane fit over the 3x3 window; all 0: singular
    const uint8_t* edges;        // 1 where the samples of a pixel differ; border zero
    uint8_t* edgesOut;
    RgbOut out;
    float* applied;  // debug; null when not wanted
    int stride, edgeStride, width;
};
struct DeaaKernels {
    RowKernel<DeaaArgs> mark, filter;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::DeaaKernels, deaaKernels)
