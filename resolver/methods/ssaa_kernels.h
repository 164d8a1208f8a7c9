#pragma once
#include "kernels/display_args.h"
#include "kernels/table.h"

namespace aa {
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
