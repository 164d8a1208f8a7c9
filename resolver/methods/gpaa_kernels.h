#pragma once
#include "kernels/table.h"
#include "shot/edge_segment.h"

namespace aa {

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
