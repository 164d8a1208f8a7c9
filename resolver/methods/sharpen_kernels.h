#pragma once
#include "kernels/table.h"

namespace aa {
enum class Sharpen {
    xu,        // [0 -1 0; -1 5 -1; 0 -1 0], [Oliveros 2018, eq 3.1]
    norm,      // [0 -1/4 0; -1/4 2 -1/4; 0 -1/4 0], [Oliveros 2018, eq 4.17]
    lumaPost,  // c (L + amount (L - mean3x3 L)) / L, [Castorina 2023]
};
// What the result is held in.
enum class SharpenRange { display, neighbourhood, positive };  // [0,1]; that of the 3x3, and >= 0; >= 0
struct SharpenArgs {
    RgbIn in;  // border of 1 px filled
    RgbOut out;
    int stride, width;
    Sharpen filter;
    SharpenRange range;
    float amount = 1;  // of lumaPost
};
struct SharpenKernels {
    RowKernel<SharpenArgs> sharpen;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::SharpenKernels, sharpenKernels)
