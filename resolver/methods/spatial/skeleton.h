// spatialSkeleton: a method to copy. Real and tested, but in no registry: `aaresolve list` does not show it.
//
// Where the luma of a pixel and of its four neighbours differs by a threshold or more, the pixel is moved toward the
// mean of the five. Encoded colour in and out, because a threshold on luma is one on what is seen (conventions 4).
//
// A header says: where the method is published and what it does, step by step; its input, with units and signs; where
// it deviates from its source, and why. It holds what host and kernel share: plain views and numbers, no container.
#pragma once
#include "kernels/table.h"
#include "methods/spatial/luma_kernels.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor spatialSkeletonDescriptor();  // one line in methods/registry.cpp

struct SpatialSkeletonArgs {
    RgbIn in;
    RgbOut out;
    const float* luma;
    float* contrast;    // debug layer; null when it is not wanted
    int stride, width;  // pixels; one stride for all planes of a size (image/plane.h)
    float threshold;    // least difference of luma that is filtered
    float strength;     // 0: nothing, 1: the mean itself
};
struct SpatialSkeletonKernels {
    RowKernel<SpatialSkeletonArgs> resolve;
};
}  // namespace aa
// Declares v2::, v3::, v4:: and plain::spatialSkeletonKernels, and spatialSkeletonKernelsFor(exec) that chooses among
// them.
AA_KERNEL_TABLE(aa::SpatialSkeletonKernels, spatialSkeletonKernels)
