// sbaa: surface based anti-aliasing. The sub-samples are merged into at most K surfaces, each shaded once.
//
// Source: [Salvi 2012]. Linear light.
//   cluster  one per object and tangent plane (kernels/surfaces.h)
//   merge    clusters whose normals agree and that lie in one plane; of one object only (ids=off: whatever their
//   object) reduce   while more than K: merge the two of smallest SADP; the one that covers more represents both shade
//   each at the sub-sample nearest to its centroid; out = sum of coverage x colour
// ids is ours: the plane's tolerance grows with the distance, and seen from afar a shallow relief of several objects
// would be one surface. Deviation: a pixel whose sub-samples all lie on the centre sample's plane keeps the pixel's
// colour, which is shaded at the centre already.
#pragma once
#include "kernels/subsample_args.h"
#include "kernels/surface_rule.h"

namespace aa {
struct GeometryNeeds;
struct MethodDescriptor;
MethodDescriptor sbaaDescriptor();
GeometryNeeds sbaaNeeds();

inline constexpr int kSbaaMaxSamples = 16;
struct SbaaArgs {
    RgbIn color;
    RgbOut out;
    const GeometryArgs* geometry;
    SurfaceRule merge;
    int surfaces;  // kept per pixel
    bool ids;      // objects stay apart before the reduction
    // Debug layers; null when not kept: surfaces before and after the reduction, sub-samples of the one that covers
    // most.
    float *clustersLayer, *surfacesLayer, *largestLayer;
};
struct SbaaKernels {
    RowKernel<SbaaArgs> resolve;
};

}  // namespace aa
AA_KERNEL_TABLE(aa::SbaaKernels, sbaaKernels)
