// raptor: the full TAA of [Castorina 2023] (the Vulkan book, whose engine is called Raptor), every option of the text.
//
//  1. motion of the nearest pixel in 3x3   2. history by Catmull-Rom   3. 3x3 bounds, moments, filtered current colour
//  4. outside: the filtered current colour   5. YCoCg: chroma range from the luma range
//  6. constraint: clamp, clip, variance clip, or clamp then variance clip
//  7. weights 0.1 / 0.9   8. temporal filtering: more history where contrast is high
//  9. luminance of compressed colours c / (1 + max c)   10. luminance difference, in place of 7 and 8
//  11. weights 1 / (1 + L)   12. blend
//  afterwards sharpening by luminance: L' = L + s (L - mean L of 3x3), c L' / L
// `lumaDiff=printed` exchanges the weights as the book's code does (similar colours then ignore history);
// `filterDomain=printed` evaluates the filters at twice the pixel distance (Mitchell and Catmull-Rom then return the
// centre pixel). Both default to the corrected form (decisions 25, 26); decisions 27 to 30 are the other corrections.
// In the book step 11 acts when either of its two filters (inverse luminance, luminance difference) is on, and step 10
// replaces what step 8 has found. So `temporalFiltering` and `inverseLuminance` have an effect only without lumaDiff
// and are refused beside it; `lumaDiffWeights=off` (ours) takes the weights of step 11 away from the luminance
// difference. Ours, against overshoot and division by nothing, each can be switched off to get the published step:
// `historyClamp` (2), `currentClamp` (3), `contrastDivisor=guarded` (8; in YCoCg chroma is signed). The combination
// that the book prints is `raptor:lumaDiff=printed,filterDomain=printed,historyClamp=off` (docs/published_steps.md).
// Input and output: linear light; depth planar; motion in px, current - previous.
#pragma once
#include <array>

#include "methods/temporal/temporal_kernels.h"

namespace aa {
class Params;
struct MethodDescriptor;
MethodDescriptor raptorDescriptor();

// Weights of the 3x3 current samples (RaptorArgs::filter) in a frame of this jitter.
std::array<float, 9> raptorFilter(const Params& params, float jitterXPx, float jitterYPx);

enum class RaptorConstraint { none, clamp, clip, varianceClip, varianceClipClamp };
enum class LuminanceDifference { off, corrected, printed };
struct RaptorArgs {
    TemporalIn in;
    float filter[9];  // weights of the 3x3 current samples, row-major; their sum may be 0: then the centre alone
    RaptorConstraint constraint;
    LuminanceDifference luminanceDifference;
    bool temporalFiltering, ycocg;
    bool luminanceWeights;  // 1 / (1 + L)
    bool clampCurrent;      // the filtered current colour is held within the window's bounds
    bool signedDivisor;     // temporal filtering divides by the colour as it is: printed
    float gamma, kMin, kMax;
};
struct RaptorKernels {
    RowKernel<RaptorArgs> resolve;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::RaptorKernels, raptorKernels)
