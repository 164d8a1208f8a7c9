#pragma once
#include "methods/temporal_kernels.h"

namespace aa {
// Depth that nothing known lies at: farther than any.
inline constexpr float kNoDepth = 3e38f;

// The nearest surface that was at each pixel of the previous frame, scattered from this one. Rows may run in parallel:
// the least of all is taken atomically, so their order does not matter.
struct Fsr2nScatterArgs {
    TemporalIn in;
    float* nearest;  // filled with kNoDepth before; positive floats, compared as integers
    bool shared;     // several threads write it
};
struct Fsr2nArgs {
    TemporalIn in;                        // history alpha = lifetime of the pixel's lock, 0..1
    const float *nearest, *previousLuma;  // luma: the 3x3 mean that is usual along the motion
    float* nextLuma;
    float lanczos[9];           // weights of the 3x3 current samples, row-major, sum 1
    float still[9], moving[9];  // weights of the colour box at rest and in motion, sum 1
    float weight;               // of the current colour against an accumulated weight of 1
    float boxScale;             // of the standard deviation at rest
    float lockDecay;            // per frame
    float separation;           // least depth difference that counts, share of the depth
    float power;                // of the graded difference
    bool locks;
    float *debugDepthClip, *debugLock;  // or null
};
struct Fsr2nKernels {
    RowKernel<Fsr2nScatterArgs> scatter;
    RowKernel<Fsr2nArgs> resolve;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::Fsr2nKernels, fsr2nKernels)
