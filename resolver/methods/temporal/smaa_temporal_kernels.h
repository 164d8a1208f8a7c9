#pragma once
#include "kernels/table.h"

namespace aa {
struct SmaaTemporalArgs {
    RgbIn current, previous;             // anti-aliased frames; previous is the one before, not the result
    const float *velocityX, *velocityY;  // px, anti-aliased with the colour
    const float *motionX, *motionY;      // px, of the pixel itself: where it was
    const float *previousVelocityX, *previousVelocityY;
    float scaleX, scaleY;  // px -> the unit of the test
    float rejection;       // K
    bool reproject;        // off: half and half
    RgbOut out;
    float* weight;  // debug; null when not wanted
    int stride, width, height;
};
struct SmaaTemporalKernels {
    RowKernel<SmaaTemporalArgs> resolve;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::SmaaTemporalKernels, smaaTemporalKernels)
