#pragma once
#include "kernels/table.h"

namespace aa {
struct SsaaArgs {
    const RgbIn* samples;  // `count` views of equal stride
    int count;
    RgbOut out;
    int stride, width;
};
struct SsaaKernels {
    RowKernel<SsaaArgs> mean;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::SsaaKernels, ssaaKernels)
