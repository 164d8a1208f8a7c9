// gpaa: geometric post-process anti-aliasing. Every edge of the geometry is drawn over the finished picture as a line
// of one pixel, and blends each pixel that it crosses with the neighbour beyond it.
//
// Source: [Persson 2011]. The segments pass lists the edges. For a pixel that a segment touches:
//   axis   across the segment: y for a mostly horizontal one, x otherwise
//   s      distance along that axis from the pixel centre to the segment, px
//   blend  c = 0.5 - |s|; where c > 0 the colour is fetched at the centre + sign(s) c axis, from the original picture
//   test   a segment behind the surface that the pixel shows is hidden (depthTest, with a bias for its own surface)
// Of several edges the last in the list wins, as in the original, or the nearest (keep). s = 0 blends toward +.
// Linear light.
//
// Choices of ours: for |s| < 1e-3 either side would do, and the sign of s, which is the side that was rasterised, gains
// 1.6 dB on half-planes over always +. Near its ends a segment touches the pixels whose centre projects on it, or half
// a pixel beyond. The list is of the un-jittered picture: a jittered frame shows everything displaced by -jitter, and
// so does the list then. depthTest=farther also draws an edge that the surface beyond it does not hide: on surfaces
// seen at a grazing angle half a pixel is more depth than any bias.
#pragma once
#include "kernels/table.h"
#include "shot/edge_segment.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor gpaaDescriptor();

struct GpaaArgs {
    RgbIn color;
    RgbOut out;
    const float* depthView;  // null: no depth test
    int stride, width;
    const EdgeSegment* segments;
    const uint32_t *firstOfRow,
        *ofRow;                  // ofRow[firstOfRow[y]..firstOfRow[y + 1]]: those that may touch row y, in order
    float jitterXPx, jitterYPx;  // of the frame
    bool perspective;            // 1 / depth is linear along a segment; otherwise depth is
    bool farther;                // hidden only if behind the neighbour beyond it, too
    bool keepNearest;
    float depthLimit;            // hidden beyond this times the depth shown
    float *shiftXPx, *shiftYPx;  // scratch: where each pixel is fetched, from its centre
};
struct GpaaKernels {
    RowKernel<GpaaArgs> resolve;
};

}  // namespace aa
AA_KERNEL_TABLE(aa::GpaaKernels, gpaaKernels)
