// MLAA: morphological anti-aliasing [Reshetov 2009].
//
// 1. Edges between neighbours whose colours differ. 2. Maximal runs of collinear edges are separation lines; edges that
// cross their ends make L, Z and U shapes. 3. The silhouette runs from half the height of the crossing edge at one end
// to the other end (Z) or to the middle of the line (L, U); heights=colour: from where the blended lumas of both sides
// of the crossing edge agree, the middle where nothing decides. 4. Each pixel on the invaded side is blended with the
// pixel across the line by the area that the silhouette cuts off: horizontal lines first, then vertical lines on their
// result, edges always from the original image; simultaneous: vertical lines too on the original, and a pixel that both
// move goes halfway with each. Encoded colour. Deviation: a line is measured in one scan whatever its
// length, so there is no search limit to choose.
#pragma once
#include "kernels/table.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor mlaaDescriptor();

enum class MlaaRule { maxdiff, msb4, luma };
enum class MlaaHeights { half, colour };
struct MlaaEdgeArgs {
    RgbIn in;             // encoded
    uint8_t *top, *left;  // bits (methods/spatial/edge_bits.h)
    int stride, bitStride, width;
    MlaaRule rule;
};
inline constexpr int kMlaaBlockRows = 32;  // rows that are weighted and blended together
inline constexpr int kMlaaTabled = 64;     // distances to the ends of a line whose areas come from a table

// Lines of one orientation: the plane that they follow and the plane that crosses them.
struct MlaaAxis {
    const uint8_t *along, *cross;
    int stride;
    long alongStep, acrossStep;  // in the image: from a pixel to the next one along a line, and across it
    float *weights, *shapes;     // debug: pairs (own, opposite); 1 L, 2 Z, 3 U, 0 none; null when not wanted
};
// A separation line: a maximal run of edges. Its silhouette leaves from the edges that cross its ends, at this height
// (up positive); 0 where none does.
struct MlaaLine {
    int first, last;
    float left, right;
};
struct MlaaBlendArgs {
    MlaaAxis top, left;  // `left` by columns
    const float* areas;  // pairs by height at the left and right end (0, 1/2, -1/2) and distance to either
    RgbIn in;
    RgbOut out;
    float* scratch;     // per block: weights of two rows of top edges and of one row of left edges
    MlaaLine* columns;  // per block: the vertical line that each column met last
    long scratchSize;   // per block
    int stride, width, height;
    MlaaHeights heights;
    bool simultaneous;
};
struct MlaaAreaArgs {
    float* areas;
};
struct MlaaKernels {
    RowKernel<MlaaEdgeArgs> edges;
    RowKernel<MlaaBlendArgs> blend;  // over blocks of kMlaaBlockRows rows
    RowKernel<MlaaAreaArgs> areas;   // over the 9 pairs of heights
};
}  // namespace aa
AA_KERNEL_TABLE(aa::MlaaKernels, mlaaKernels)
