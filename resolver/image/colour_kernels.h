#pragma once
#include "kernels/table.h"

namespace aa {
struct ColourArgs {
    RgbIn in;
    RgbOut out;
    int stride, width;
    float scale;  // 2^exposure
    int toneMap;  // ToneMap as an integer
};
struct ColourKernels {
    RowKernel<ColourArgs> encode, decode;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::ColourKernels, colourKernels)
