#pragma once
#include "kernels/table.h"

namespace aa {
enum class LumaKind {
    rec601,        // dot(c, .299 .587 .114) of encoded colour
    rec709,        // dot(c, .2126 .7152 .0722) of encoded colour
    green,         // c.g
    redGreen,      // c.g * (.587 / .299) + c.r, FXAA 1
    sqrtLinear,    // sqrt(dot(sat(c), .299 .587 .114)) of linear colour
    linearOfSqrt,  // dot(sqrt(sat(c)), .299 .587 .114) of linear colour, CMAA2
    log2Linear,    // log2(1 + 15 Y) / 4, Y = sat(dot(c, .212671 .715160 .072169)) of linear colour, FXAA CS
    nfaa,          // dot(c, .212 .716 .072) of encoded colour
};

struct LumaArgs {
    RgbIn in;
    float* luma;
    int stride, lumaStride, width;
    LumaKind kind;
};
struct LumaKernels {
    RowKernel<LumaArgs> luma;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::LumaKernels, lumaKernels)
