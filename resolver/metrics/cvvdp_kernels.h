#pragma once
#include "kernels/table.h"
#include "metrics/cvvdp_constants.h"

namespace aa {

// Planes of one size, one per channel; pixel (0, 0).
struct ChannelsIn {
    const float* c[cvvdp_constants::kChannels];
};
struct ChannelsOut {
    float* c[cvvdp_constants::kChannels];
};

// Pixel values -> light of the display -> opponent colours.
struct CvvdpLightArgs {
    RgbIn picture;
    int stride, width;
    bool isLinear;                         // linear light, otherwise sRGB codes
    double gain, least, most, background;  // cd/m2: clamp(value x gain, least, most) + background
    double toOpponent[3][3];
    RgbOut opponent;
    int opponentStride;
};
// Opponent colours of the last frames -> channels.
struct CvvdpFilterArgs {
    const float* const* frames;  // [taps][3], oldest first
    const double* weights;       // [channels][taps / 2 + 1], from the middle tap outwards: filters are symmetric
    int taps, stride, width, channels;
    ChannelsOut out;
};
// One step of the Gaussian pyramid; rows are those of the smaller level.
struct CvvdpReduceArgs {
    ChannelsIn in;
    int inStride, inWidth, inHeight, channels;
    ChannelsOut out;
    int outStride, outWidth;
};
// What a level and the next smaller one hold of a picture.
struct CvvdpBand {
    ChannelsIn level, smaller;
    int stride, smallerStride, width, height, channels;
};
// Of the reference: sensitivity times gain, and the contrast times that.
struct CvvdpSensitivityArgs {
    CvvdpBand band;
    const float* log2Sensitivity;  // [channels][kCsfSize + 1], by luminance
    double bandGain;               // 2 for inner bands
    ChannelsOut sensitivity, response;
};
// Of the test: how far its response is from the reference's, and along x the blurred lesser of both.
struct CvvdpResponseArgs {
    CvvdpBand band;
    ChannelsIn sensitivity, reference;
    ChannelsOut difference, mutual;
    bool blurred;  // otherwise the lesser itself: small levels are not blurred
};
// The difference as masked by the mutual response.
struct CvvdpMaskArgs {
    ChannelsIn difference, mutual;
    int stride, width, height, channels;
    bool blurred;  // along x already, here along y
    double crossMasking[cvvdp_constants::kChannels][cvvdp_constants::kChannels];
    double weights[cvvdp_constants::kChannels];  // of the channels in the map
    double* rows;  // [channels][height][kSumStrands], zero at the start: sums of the squared masked differences
    float* map;    // the channels pooled, or null
};
struct CvvdpKernels {
    RowKernel<CvvdpLightArgs> light;
    RowKernel<CvvdpFilterArgs> filter;
    RowKernel<CvvdpReduceArgs> reduce;
    RowKernel<CvvdpSensitivityArgs> sensitivity;
    RowKernel<CvvdpResponseArgs> response;
    RowKernel<CvvdpMaskArgs> mask;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::CvvdpKernels, cvvdpKernels)
