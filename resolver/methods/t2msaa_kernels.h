#pragma once
#include "kernels/display_args.h"
#include "methods/temporal_kernels.h"

namespace aa {
struct T2msaaArgs {
    TemporalIn in;    // color unused; history alpha = mean depth of the previous frame
    RgbIn sample[2];  // linear
    const float* sampleDepth[2];
    const float* previousCount;
    float* nextCount;
    ExpectedDepth expected;
    bool encoded;         // blend display-encoded colours
    DisplayArgs display;  // what encodes them
    bool fractionalVelocity;
    bool countAtPixel;  // the sample count is read at the pixel itself, not where its surface was
    RejectionTest rejection;
};
struct T2msaaKernels {
    RowKernel<T2msaaArgs> resolve;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::T2msaaKernels, t2msaaKernels)
