// inside: temporal reprojection of INSIDE [Pedersen 2016].
//
//  1. current colour fetched at the pixel centre, jitter taken back (bilinear)   2. motion of the nearest pixel in 3x3
//  3. colour box: mean of 3x3 and plus bounds; or the game's first form, four bilinear taps on the diagonals whose
//     distance grows where nothing moves: by the motion of 2 times the depth of the surface that has it
//  4. YCoCg: chroma range from the luma range (not used in the shipped game)
//  5. history clipped to the box   6. feedback 0.88 .. 0.97 by luminance difference   7. blend -> history
// Input and output: display-encoded [0,1]; depth planar; motion in px. Outside the image the current colour is taken;
// the original clamps (`outside=clamp`).
// `unjitterReprojection`: the original moves the place where it seeks depth and motion by the jitter, too, but reads
// both planes at their nearest texel; less than half a pixel away that is the same texel, so with dilation the option
// has no effect and is refused. Without dilation ours reads the motion bilinearly.
//  8. motionBlur=SCALE (off: the truth is an instant): the screen, not the history, shows seven taps along the motion
//     where that exceeds 2 px; not in the first frame after a reset, whose motion leads to another picture
#pragma once
#include "methods/temporal/temporal_kernels.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor insideDescriptor();

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
