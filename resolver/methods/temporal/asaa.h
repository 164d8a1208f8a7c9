// asaa: amortized supersampling [Yang 2009] as in [Stejmar n.d., 3.8 and 4.4.1].
//
// Four sub-pixel buffers hold the image at the quadrant offsets (-+.25, -+.25); each frame updates the buffer of its
// jitter's quadrant.
//  1. s = the current sample   2. the surface point is followed into the frame of each buffer: by the two cameras, plus
//     the object's own motion (motion less camera motion) times the buffer's age   3. tent-weighted sums over the four
//     nearest samples of every buffer: b~ (radius half the footprint) and f~ (twice that)   4. rejection per buffer:
//     border, depth (depthTolerance 0.08), magnification (1)   5. alpha = 1 / (N + 1), N limited to 4 in motion
//     (thesis) or alpha bounded by eq 3.31 (blurMode=eq331)   6. buffer = alpha s + (1 - alpha) b~,
//     frame = alpha/4 s + (1 - alpha/4) f~   7. N + 1, or eq 3.29 with eq331
// N counts earlier samples. Where every buffer is rejected the thesis stores 0, so that the next frame, too, shows its
// own sample alone; eq 3.29 then gives 1. The first frame after a reset rejects nothing: N = 0 + 1. The thesis's text
// restricts N to four samples in motion, its listing 4.11 sets N = 4, also where fewer were taken (motionCount=four).
// It reads N at the pixel itself (countAt=reprojected: where the surface was, as eq 3.29 does).
// The radii of step 3 are at least 0.125 px, and at most 1 px where the source sets no upper bound (decisions 23).
// Works with any jitter (the quadrant is taken from its sign, the buffers' ages are tracked); made for the sequence
// "quadrants" with Gaussian sigma 0.2575. The output filter is a tent of radius 1 px: blurrier than a box truth.
// Display-encoded, as the thesis's 8-bit buffers (conventions 4). Depth of each buffer rides in its alpha.
#pragma once
#include <cstddef>
#include <glm/fwd.hpp>

#include "methods/temporal/temporal_kernels.h"

namespace aa {
struct Camera;
struct Frame;
struct MethodDescriptor;
MethodDescriptor asaaDescriptor();

// The buffer that a frame of this jitter updates, 0..3, and where a buffer's samples lie from the pixel centres.
size_t asaaQuadrant(glm::dvec2 jitterPx);
glm::vec2 asaaOffsetPx(size_t quadrant);

// Clip position of the static surface point that the pixel at p samples at depth z, in another camera jittered as this
// frame, as three rows x, y, w: z * (perDepth . (p, 1)) + constant . (p, 1). Less p it is how far the point moved; the
// sample itself lies at p + jitter, as the motion pass has it (conventions 3).
struct CameraPath {
    bool moves = false;  // false: the same camera, no displacement
    float perDepth[3][3] = {}, constant[3][3] = {};
};
// From this frame to `other`; null: unknown, no displacement.
CameraPath cameraPath(const Frame& frame, const Camera* other);
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
