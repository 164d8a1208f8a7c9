// t2msaa: temporal 2x multisampling of [Stejmar n.d., 4.4.2].
//
//  1. c = mean of the two sub-sample colours   2. q = p - motion of the pixel itself, history bilinear
//  3. rejection: border, mean depth (0.08, one-sided), magnification (1.0)   4. rejected: c, N = 1
//  5. a = 1 / (N + 1), under motion at least 0.25 + blur term (listing 4.19); blend with weights 1 / (1 + luma601);
//     N grows only while a is above that limit. N is read at the pixel itself, as in the thesis
//     (countAt=reprojected: where its surface was). depthTolerance and magnification are the thesis's thresholds
// Display-encoded by default, as the thesis's 8-bit buffers; the mean of the samples is taken there, too.
// The thesis moves the geometry by (-d, +d) and (+d, -d) px in alternate frames: the jitter `t2msaa`, with d = 0.25. A
// shot with exactly two sub-samples is taken as rendered: there `offset` would have no effect, so writing it is a usage
// error; d is chosen when the shot is exported. From a shot with more, each frame takes the two recorded sub-samples
// (jitter + position) that lie nearest to where the thesis samples, which may be up to an eighth of a pixel off:
// (.25, .25) and (-.25, -.25), plus (+d, -d) in even and (-d, +d) in odd frames.
#pragma once
#include <array>
#include <cstddef>

#include "kernels/display_args.h"
#include "methods/temporal/temporal_kernels.h"

namespace aa {
struct Frame;
struct MethodDescriptor;
MethodDescriptor t2msaaDescriptor();

// Numbers of the recorded sub-samples that are nearest to the thesis's two of this frame; `offsetPx`: d.
std::array<size_t, 2> t2msaaSamples(const Frame& frame, double offsetPx, int framesSinceReset);

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
