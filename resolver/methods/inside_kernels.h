#pragma once
#include "methods/temporal_kernels.h"

namespace aa {
enum class InsideNeighbourhood { rounded, box3x3, plus, fourTapVarying };
struct InsideArgs {
    TemporalIn in;
    float kMin, kMax;
    InsideNeighbourhood neighbourhood;
    ClipTarget clipTarget;
    bool unjitterColor, unjitterNeighbourhood, unjitterReprojection, ycocg;
    Luminance luminance;  // of the feedback, unless ycocg
    float motionBlur;     // share of the motion along which the screen is blurred; 0: not at all
    uint32_t frame;       // seeds the noise of the blur
};
struct InsideKernels {
    RowKernel<InsideArgs> resolve;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::InsideKernels, insideKernels)
