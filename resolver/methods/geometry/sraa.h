// sraa: subpixel reconstruction anti-aliasing. The colour of every sub-sample is a cross-bilateral mean of the shaded
// pixels around it, weighted by how near they are in place and geometry; the pixel is the mean of its sub-samples.
//
// Source: [Chajdas 2011]. Linear light. Weight of pixel q for sub-sample i:
//   product  exp(-|xq - xi|^2 / 2 sx^2) exp(-dz^2 / 2 sz^2) exp(-dn^2 / 2 sn^2), dz = distance of q's point from i's
//   tangent
//            plane relative to i's depth (distance=depth: relative depth difference), dn = 1 - cosine of the normals
//   max      exp(-T max(1 - cosine, dz)), as in the authors' published kernel
// Surface and background share nothing; nor do objects, with ids (always: the sigmas do not see a shallow relief from
// afar). Choices of ours: the three sigmas (decisions 43); pixels outside the picture
// are left out; a sub-sample without any usable pixel takes the pixel's own colour.
#pragma once
#include "kernels/subsample_args.h"

namespace aa {
class Params;
struct GeometryNeeds;
struct MethodDescriptor;
MethodDescriptor sraaDescriptor();

// Pixels of other objects: may share, share nothing where the depth differs too, or share nothing.
enum class SraaIds { off, depth, always };
struct SraaArgs {
    RgbIn color;
    RgbOut out;
    const GeometryArgs* geometry;
    int radius;
    bool maxMetric, plainDepth;
    SraaIds ids;
    // Factors of the squared differences in base-2 exponents: log2(e) / (2 sigma^2); of the max metric: T log2(e).
    float spatial, depth, normal, sharpness;
    float depthSigma;      // SraaIds::depth: objects are told apart where the relative depth differs by more
    float* ownShareLayer;  // debug layer; null when not kept
};
// What the parameters say; the images are left out.
SraaArgs sraaArgs(const Params& params);
GeometryNeeds sraaNeeds(const SraaArgs& args);

struct SraaKernels {
    RowKernel<SraaArgs> resolve;
};

}  // namespace aa
AA_KERNEL_TABLE(aa::SraaKernels, sraaKernels)
