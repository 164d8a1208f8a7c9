#pragma once
#include "kernels/table.h"

namespace aa {
enum class Sharpen {
    xu,        // [0 -1 0; -1 5 -1; 0 -1 0], seed 000 eq. 3.1
    norm,      // [0 -1/4 0; -1/4 2 -1/4; 0 -1/4 0], seed 000 eq. 4.17
    lumaPost,  // c (L + (L - mean3x3 L)) / L, seed 002
};
struct SharpenArgs {
    RgbIn in;  // border of 1 px filled
    RgbOut out;
    int stride, width;
    Sharpen filter;
    bool displayRange;  // clamp to [0,1]; otherwise to the range of the 3x3 and to >= 0
};
struct SharpenKernels {
    RowKernel<SharpenArgs> sharpen;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::SharpenKernels, sharpenKernels)
