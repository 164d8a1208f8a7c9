#pragma once
#include "kernels/table.h"
#include "methods/smaa_kernels.h"  // edge bits

namespace aa {
enum class MlaaRule { maxdiff, msb4, luma };
struct MlaaEdgeArgs {
    RgbIn in;  // encoded
    uint8_t* edges;
    int stride, edgeStride, width;
    MlaaRule rule;
};
struct MlaaWeightArgs {
    const uint8_t* edges;
    uint8_t* transposed;  // written by the pass over rows; null in the pass over columns
    float* weights;       // pairs (own, opposite), for every top edge
    float* shapes;        // debug: 1 L, 2 Z, 3 U, 0 none; null when not wanted
    long weightAlong, weightAcross;
    int edgeStride, transposedStride, width;
};
struct MlaaBlendArgs {
    const uint8_t* edges;
    const float *topWeights, *leftWeights;  // pairs at 2 * (y * width + x)
    RgbIn in;
    RgbOut out;
    int stride, edgeStride, width, height;
};
struct MlaaKernels {
    RowKernel<MlaaEdgeArgs> edges;
    RowKernel<MlaaWeightArgs> weights;
    RowKernel<MlaaBlendArgs> blend;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::MlaaKernels, mlaaKernels)
