#pragma once
#include "methods/temporal_kernels.h"

namespace aa {
// Clip position of a static surface point at pixel position p and depth z in another camera, as three rows x, y, w:
// z * (perDepth . (p, 1)) + constant . (p, 1).
struct CameraPath {
    bool moves = false;  // false: the same camera, no displacement
    float perDepth[3][3] = {}, constant[3][3] = {};
};
struct AsaaBuffer {
    const float* rgba = nullptr;  // null: not filled since the reset; alpha = depth
    float phiX = 0, phiY = 0;     // quadrant offset, px
    float age = 1;                // frames since its update
    CameraPath path;
    ExpectedDepth expected;
};
struct AsaaArgs {
    TemporalIn in;  // history and next are the buffer of this frame's quadrant
    AsaaBuffer buffer[4];
    CameraPath lastFrame;
    bool anyHistory;
    float phiX, phiY;  // of this frame's quadrant
    const float* previousCount;
    float* nextCount;
    bool eq331;         // bound of alpha by eq 3.31 and N by eq 3.29, instead of a limit on N
    bool fourInMotion;  // N = 4 in motion (listing 4.11), not at most 4
    bool countAtPixel;  // N is read at the pixel itself, not where its surface was
    RejectionTest rejection;
};
struct AsaaKernels {
    RowKernel<AsaaArgs> resolve;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::AsaaKernels, asaaKernels)
