#pragma once
#include "kernels/display_args.h"
#include "kernels/table.h"

namespace aa {
struct ColourArgs {
    RgbIn in;
    RgbOut out;
    int stride, width;
    DisplayArgs display;
};
struct ColourKernels {
    RowKernel<ColourArgs> encode, decode;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::ColourKernels, colourKernels)
