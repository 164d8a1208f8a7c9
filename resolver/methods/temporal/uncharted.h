// uncharted, unchartedNorm, unchartedNoSharpen: the "Uncharted TAA" baseline of [Oliveros 2018, 3.6] ([Xu 2016] with
// the clipping of [Pedersen 2016]).
//
// Input and output: display-encoded [0,1], as the thesis's 8-bit pipeline; depth planar, motion in px.
//  0. the current frame is un-jittered: colours read at p - jitter, bilinear (conventions 7.0). At rest the blend is
//     then a tent-filtered mean that the sharpening of step 4 can restore; without it (unjitter=off) the mean over a
//     jitter period is the box already, and sharpening overshoots
//  1. motion of the nearest pixel in 3x3; history read there, bilinear
//  2. colour box: mean of the 3x3 and the plus-shaped bounds; history is clipped into it toward its centre
//  3. feedback from the luminance difference, 0.925 .. 0.979 in favour of history, luminance 1/4 1/2 1/4; blend ->
//     history
//  4. output sharpened: eq 3.1 [0 -1 0; -1 5 -1; 0 -1 0] (uncharted) or eq 4.17 with a quarter of the gain
//     (unchartedNorm); clamped to [0,1], never fed back
// The sharpening kernel decides this baseline's figures ([Oliveros 2018, table 5.1]: MSE 149.3 against 8.8), hence
// three ids. Not in the thesis, chosen after its author's program (decisions 5 to 7, 15): kmin/kmax (INSIDE's are 0.88
// and 0.97), clip target, where to sharpen. Outside the image the current colour is taken.
#pragma once
#include "methods/temporal/temporal_kernels.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor unchartedDescriptor();
MethodDescriptor unchartedNormDescriptor();
MethodDescriptor unchartedNoSharpenDescriptor();

struct UnchartedArgs {
    TemporalIn in;
    float kMin, kMax;
    Neighbourhood neighbourhood;
    ClipTarget clipTarget;
    Luminance luminance;  // of the feedback
};
struct UnchartedKernels {
    RowKernel<UnchartedArgs> resolve;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::UnchartedKernels, unchartedKernels)
