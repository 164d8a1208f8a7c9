// rsaa: resampling anti-aliasing. One shade per pixel, several geometry samples; the pixel's colour is fetched beside
// its centre, at an offset learned for the pattern of sub-samples that lie on another surface.
//
// Source: [Reshetov 2012]. Linear light.
//   measure   dissimilarity of every sub-sample to the centre sample: SADP, relative depth or normal (kernels/sadp.h)
//   cluster   similar or different, by one k-means iteration from the centroids 0 and the largest dissimilarity; all
//             similar below an absolute floor: such a pixel keeps its colour
//   tune      a different sub-sample whose surface no neighbouring pixel on its side shows is dropped
//   resample  out = bilinear(colour, centre + table[mask])
// Masks are computed or taken from the shot's mask pass; bit k = 1: sub-sample k is on the centre sample's surface. The
// pass was made by the defaults of measure, floor, clustering and ids, so with these it is read (mask=auto): 4 bytes
// per pixel in place of 20 for every sub-sample.
//
// Choices of ours: the k-means start and the floors (decisions 32), the training set (decisions 33, rsaa_learn.h), the
// neighbours that a sub-sample is compared with (decisions 34: the talk says "closest outside samples"; taking only the
// nearest one drops surfaces that continue across the pixel's other side, 0.8 / 1.8 / 2.9 dB on half-planes for
// 4 / 8 / 16). Objects are told apart by their ids too (ids=off: geometry alone, as in the talk). The depth measure is
// capped at 2, so that no surface seems farther than the background.
#pragma once
#include "kernels/dissimilarity.h"
#include "kernels/subsample_args.h"

namespace aa {
struct MethodDescriptor;
MethodDescriptor rsaaDescriptor();

struct RsaaNeighbours {  // neighbouring pixels, -1..1, that may show a sub-sample's surface
    int at[3][2], count;
};
struct RsaaArgs {
    RgbIn color;
    RgbOut out;
    int stride, width, height, samples;
    const float* offsetsPx;            // u, v for each of the 2^samples masks
    const GeometryArgs* geometry;      // empty where the mask pass replaces it and tuning is off
    const RsaaNeighbours* neighbours;  // of each sub-sample
    const uint32_t* maskPass;          // null: the mask is computed
    Dissimilarity measure;
    float floor;  // below it everything is one surface
    bool adaptive, tuning, tuneAdaptive;

    // Debug layers; null when not kept.
    float *maskLayer, *tunedLayer, *dissimilarityLayer, *offsetXLayer, *offsetYLayer;
};
struct RsaaKernels {
    RowKernel<RsaaArgs> resolve;
};

}  // namespace aa
AA_KERNEL_TABLE(aa::RsaaKernels, rsaaKernels)
