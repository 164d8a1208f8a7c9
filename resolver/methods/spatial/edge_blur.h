// Blurs along the edge that the luma gradient shows: NFAA [Styves n.d.] and "screen-space SSAA".
//
// Both turn the gradient by 90 degrees and average a few bilinear taps along it. NFAA steps as far as the gradient is
// steep and has no threshold; ssssaa steps half a pixel and one pixel where the gradient reaches a threshold.
// Encoded colour, px, y down. Constants from published ports; ssssaa is reconstructed from the shader of that name.
#pragma once
#include "kernels/table.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor nfaaDescriptor();
MethodDescriptor ssssaaDescriptor();

struct EdgeBlurArgs {
    const float* luma;
    RgbIn in;
    RgbOut out;
    float *directionX, *directionY;  // debug: blur vector, px; null when not wanted
    int stride, width;
    int scalePx;                // nfaa: distance of the lumas
    float strength, longestPx;  // nfaa: gain on the gradient, its largest length
    float reachPx, threshold;   // ssssaa: distance of the lumas, least gradient
};
struct EdgeBlurKernels {
    RowKernel<EdgeBlurArgs> nfaa, ssssaa;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::EdgeBlurKernels, edgeBlurKernels)
