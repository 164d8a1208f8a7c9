#pragma once
#include "kernels/display_args.h"
#include "kernels/table.h"

namespace aa {
enum class SmaaEdges { luma, colour, depth };
enum class SmaaPredication { off, depth, object };
inline constexpr int kSmaaEdgeScratchRows = 8;
struct SmaaEdgeArgs {
    RgbIn color;   // of edges of luma and of colour: encoded
    bool encodes;  // or linear, of luma alone, and shown by `display`
    DisplayArgs display;
    const float* depthView;    // of edges and predication by it
    const uint32_t* objectId;  // predication
    uint8_t *top, *left;       // bits (methods/spatial/edge_bits.h)
    int stride, bitStride, width, height;
    void* scratch;  // kSmaaEdgeScratchRows rows; of luma
    SmaaEdges kind;
    SmaaPredication predication;
    bool consistent;  // colour edges: compare left with leftleft, as luma edges do, not the centre
    float threshold, localContrast;
    float predicationThreshold, predicationScale, predicationStrength;
};

struct SmaaTransposeArgs {
    const uint8_t* from;
    uint8_t* to;
    int fromStride, toStride, height;
};

inline constexpr int kMaxDiagonal = 20;  // the published tables hold 20 distances
inline constexpr int kDiagonals = kMaxDiagonal + 1;
inline constexpr int kSmaaChannels = 5;  // colour, and motion with the same weights
inline constexpr int kSmaaImages = 2;
inline constexpr int kSmaaBlendScratchRows = 8;

// Lines of one orientation: the plane that they follow, the plane that crosses them, and the latter transposed.
struct SmaaAxis {
    const uint8_t *along, *cross, *crossTransposed;
    int stride, crossTransposedStride, crossTransposedRows;
    float offset;                 // of the sub-sample across the edge (area tile)
    const float* publishedTable;  // 25 code pairs x 16 x 16 pairs; null: exact areas
    const float* exactTable;      // exact areas: 16 code pairs x reach x (reach + 1) pairs; null: evaluated
    float *weights, *lengths;     // debug: pairs (own, opposite) and (left, right) per pixel; null when not wanted
};
// One of the images that are blended, and its edges.
struct SmaaImage {
    SmaaAxis top, left;
    const float* diagonalTable[2];  // 16 code pairs x kDiagonals^2 pairs, for the two directions
    RgbIn color;
    uint8_t* isDiagonal;  // debug: one byte per pixel; null when not wanted
};
struct SmaaBlendArgs {
    SmaaImage image[kSmaaImages];
    int images;                      // 2: the mean of both results
    int searchSteps, diagonalSteps;  // diagonalSteps 0: off
    float cornerRounding;            // negative: off
    bool unorm8;
    const float* motion[2];  // blended by each image's weights as its colour is
    float* out[kSmaaChannels];
    int channels;   // kSmaaChannels, or 3 without motion
    void* scratch;  // kSmaaBlendScratchRows rows; weights
    int stride, width, height;
};
// One orthogonal area: crossing codes, distances to the two ends, sub-sample offset -> weights.
struct SmaaAreaQuery {
    int left, right, leftPx, rightPx;
    double offset;
    double own, opposite;  // out
};
struct SmaaAreaArgs {
    SmaaAreaQuery* queries;
};

struct SmaaKernels {
    RowKernel<SmaaEdgeArgs> edges;
    RowKernel<SmaaTransposeArgs> transpose;  // over blocks of 8 columns
};
struct SmaaBlendKernels {
    RowKernel<SmaaBlendArgs> blend;  // the fewer calls, the less is computed twice: one row of weights each
    RowKernel<SmaaAreaArgs> areas;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::SmaaKernels, smaaKernels)
AA_KERNEL_TABLE(aa::SmaaBlendKernels, smaaBlendKernels)
