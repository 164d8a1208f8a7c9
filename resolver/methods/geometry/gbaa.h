// gbaa, d2e: blending by the exact distance to a geometric edge.
//
// gbaa: geometry buffer anti-aliasing. Source: [Persson 2011], as in [Stejmar n.d., 3.3, listing 3.1]. The edges pass
// holds per pixel the signed distance along x or along y, in px, positive to the right or down, from the pixel centre
// to the nearest edge of the triangle seen there; 0.5 or more means that the edge does not cut this pixel. A cut pixel
// is fetched half a pixel beyond its edge, which blends as much of the neighbour as lies beyond the edge. A pixel that
// is not cut by its own triangle asks the four neighbours whether one of their edges reaches into it
// (searchNeighbours); a later one in the order left, right, up, down wins. Linear light.
//
// d2e: distance-to-edge anti-aliasing. Source: [Malan 2010]. The nearest edge is taken on each axis separately, from
// the pixel and from its neighbours alike, so that a corner blends with two neighbours. Deviation: the original stores
// four unsigned distances per pixel; the shot's two channels hold the nearest edge only, so the others count as none.
//
// NaN and far distances cut nothing.
#pragma once
#include "kernels/table.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor gbaaDescriptor();
MethodDescriptor d2eDescriptor();

struct EdgeBlendArgs {
    RgbIn color;
    RgbOut out;
    const float *edgeXPx, *edgeYPx;
    int stride, width;
    bool searchNeighbours;               // gbaa only
    float *offsetXLayer, *offsetYLayer;  // debug layers; null when not kept
};
struct GbaaKernels {
    RowKernel<EdgeBlendArgs> gbaa, d2e;
};

}  // namespace aa
AA_KERNEL_TABLE(aa::GbaaKernels, gbaaKernels)
