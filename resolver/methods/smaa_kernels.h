#pragma once
#include "kernels/table.h"

namespace aa {
// Edge bits of a pixel (methods/03 s.3.2.1), one byte per pixel in a plane whose border repeats the edge pixels far
// enough for every search.
inline constexpr uint8_t kEdgeLeft = 1, kEdgeTop = 2;
inline constexpr uint8_t kDiagonalDone = 4;  // in the transposed plane only: the diagonal pass has handled this pixel

enum class SmaaEdges { luma, colour, depth };
enum class SmaaPredication { off, depth, object };
struct SmaaEdgeArgs {
    const float* scalar;       // luma or depth; null for colour edges
    RgbIn color;               // encoded
    const float* depthView;    // predication
    const uint32_t* objectId;  // predication
    uint8_t* edges;
    int stride, edgeStride, width;
    SmaaEdges kind;
    SmaaPredication predication;
    bool consistent;  // colour edges: compare left with leftleft, as luma edges do, not the centre
    float threshold, localContrast;
    float predicationThreshold, predicationScale, predicationStrength;
};

inline constexpr int kMaxDiagonal = 20;  // methods/03 s.3.2.4: published tables hold 20 distances
inline constexpr int kDiagonals = kMaxDiagonal + 1;
struct SmaaWeightArgs {
    const uint8_t* edges;
    uint8_t* transposed;  // written by the pass over rows: the plane for the pass over columns; null in the second
    float* weights;       // pairs (own, opposite)
    float* lengths;       // debug: pairs (left, right) of search distances; null when not wanted
    long weightAlong, weightAcross;  // index steps of the weight pairs along a row and from row to row of `edges`
    int edgeStride, transposedStride, width;
    int searchSteps, diagonalSteps;  // diagonalSteps 0: off
    float cornerRounding;            // negative: off
    float offset;                    // of the sub-sample across the edge (area tile)
    const float* orthoTable;         // 25 code pairs x 16 x 16 pairs; null: analytic areas
    const float* diagonalTable[2];   // 16 code pairs x kDiagonals^2 pairs, for the two directions
    bool unorm8;
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

struct SmaaBlendArgs {
    const uint8_t* edges;
    const float* topWeights;   // pairs at 2 * (y * weightStride + x), defined where kEdgeTop is set
    const float* leftWeights;  // likewise, where kEdgeLeft is set
    const float* in[3];
    float* out[3];
    int channels;
    int stride, edgeStride, width, height;
    long weightStride;
};
struct SmaaKernels {
    RowKernel<SmaaEdgeArgs> edges;
    RowKernel<SmaaBlendArgs> blend;
};
struct SmaaWeightKernels {
    RowKernel<SmaaWeightArgs> weights;
    RowKernel<SmaaAreaArgs> areas;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::SmaaKernels, smaaKernels)
AA_KERNEL_TABLE(aa::SmaaWeightKernels, smaaWeightKernels)
