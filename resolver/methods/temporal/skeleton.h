// temporalSkeleton: a method to copy that brings a history of its own. Real and tested, but in no registry:
// `aaresolve list` does not show it.
//
//  1. reproject: q = p - motion, the history there (bilinear) and the number of samples N in it (nearest pixel)
//  2. rectify:   history clamped per channel to the 3x3 neighbourhood of the current colour
//  3. blend:     N := min(N + 1, most), out = history + (current - history) / N: a running mean, exponential from
//  `most`
//                samples on; where q is outside the image N := 1
// Linear light; motion in px, current - previous, y down. The history holds what is shown.
//
// A header says: where the method is published and what it does, step by step; its input, with units and signs; where
// it deviates from its source, and why. It holds what host and kernel share: plain views and numbers, no container.
#pragma once
#include "methods/temporal/temporal_kernels.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor temporalSkeletonDescriptor();  // one line in methods/registry.cpp

struct TemporalSkeletonArgs {
    TemporalIn in;       // colours, motion and the colour history, which every temporal method has
    const float* count;  // history of our own: samples in the history of each pixel; its border is filled
    float* nextCount;
    float mostSamples;
};
struct TemporalSkeletonKernels {
    RowKernel<TemporalSkeletonArgs> resolve;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::TemporalSkeletonKernels, temporalSkeletonKernels)
