// DEAA: directionally adaptive edge anti-aliasing ([Iourcha 2009], reconstructed).
//
// 1. Pixels whose sub-samples differ in colour are edge pixels; isolated ones and those in the midst of nothing but
// edges keep the box resolve. 2. A plane is fitted to the luma of all sub-samples of the 3x3 window; where it does not
// fit, the box stays. 3. Every sub-sample within a rectangle along the isolines counts with the length that its isoline
// has inside the pixel: an edge gets as many levels as the whole window has samples. Linear light, px, y down. The
// thresholds are ours; the paper's are not public.
#pragma once
#include "kernels/table.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor deaaDescriptor();

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
// Of the plane fit, from the sample offsets: constant for a pattern; left 0 when they lie on a line.
void setNormalMatrix(DeaaArgs& args);
struct DeaaKernels {
    RowKernel<DeaaArgs> mark, filter;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::DeaaKernels, deaaKernels)
