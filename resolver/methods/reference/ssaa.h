// ssaa: supersampling, the mean of the shaded sub-samples of every pixel (a box filter one pixel wide).
//
// Source: [Leler 1980]; [Oliveros 2018, 3.5.1]. Linear light, or displayed values
// (`space=encoded`: every sample goes through the display chain first, conventions 4). The pattern and its size are the
// shot's: N x N regular, D3D 2/4/8/16 or any other. Sums are double, so that the order of the samples does not matter
// and a constant stays constant to the bit. A sample with a NaN or an Inf in any channel is left out and the sum
// divided by the rest; a pixel without a finite sample is 0 (conventions 8).
#pragma once
#include "kernels/display_args.h"
#include "kernels/table.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor ssaaDescriptor();

struct SsaaArgs {
    const RgbIn* samples;  // `count` views of equal stride
    int count;
    RgbOut out;
    int stride, width;
    bool encoded;         // mean of displayed values
    DisplayArgs display;  // what makes them
};
struct SsaaKernels {
    RowKernel<SsaaArgs> mean;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::SsaaKernels, ssaaKernels)
