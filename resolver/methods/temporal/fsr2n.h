// A temporal upscaler's accumulation at native resolution, after AMD's FSR 2 (public description and source).
// [AMD 2022]; results are "FSR2-like", not FSR 2.
//
// 1. Every surface is splatted to where it was a frame ago; a pixel that finds something nearer there was hidden
//    (depth clip), by how much is graded by the separation that the depth's resolution can tell.
// 2. One-pixel ridges of luma are locked: their history survives the colour box while the window's luma stays.
// 3. Current colour: Lanczos-2 over 3x3 around the jittered samples, deringed. Colour box: Gaussian mean and deviation
//    in YCoCg, cut with the window's bounds.
// 4. Blend in the tone-mapped space x / (1 + max), history read by Lanczos-2.
// Light ends at 65504, as in FSR 2, which renders into half floats.
// Differs from FSR 2: no upscaling, no reactive masks, no auto-exposure; a lock watches the 3x3 mean of luma against
// its running mean over a jitter period, not a blurred pyramid; the box's Gaussian goes from exp(-2 d^2) to exp(-3 d^2)
// by mixing the two.
#pragma once
#include "methods/temporal/temporal_kernels.h"

namespace aa {
struct Frame;
struct MethodDescriptor;
MethodDescriptor fsr2nDescriptor();

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
    void* scratch;                      // kFsr2nScratchRows rows
};
inline constexpr int kFsr2nScratchRows = 3 * 4;
// Those of them that a frame's size, camera and jitter decide: lanczos, still, moving, separation, power.
void setFsr2nFrame(Fsr2nArgs& args, const Frame& frame, float jitterXPx, float jitterYPx);
struct Fsr2nKernels {
    RowKernel<Fsr2nScatterArgs> scatter;
    RowKernel<Fsr2nArgs> resolve;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::Fsr2nKernels, fsr2nKernels)
