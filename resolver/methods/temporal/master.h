// master: the Sobel-improved TAA of [Oliveros 2018, 4.3].
//
// Idea: history is constrained hard where nothing is aliased and loosely where something is. Per pixel
//   aliasedValue A = clamp01(sobelAvg + depthPseudoVariance + depthTemporalPseudoVariance + modelAverage)  (eq 4.14)
// mixes the plus-shaped and the 3x3 colour bounds and shrinks the box toward the current colour (eqs 4.15, 4.16).
//  S. Sobel magnitudes of albedo luminance, lit luminance and depth -> one value (eqs 4.9, 4.10), at the texels of the
//     jittered frame; read at p - jitter from then on, as colours are (conventions 7.0); depth, ids and motion come
//     from the nearest texel
//  T. that value goes through a small TAA of its own: reprojected, clamped, luminance feedback
//  main: modelAverage from object ids (eq 4.1), pseudo-variances from depth now and before (eqs 4.4-4.6), A, box,
//     clip, feedback 0.925..0.979, blend -> history; output sharpened with eq 4.17
// Input and output: display-encoded [0,1]; albedo likewise; depth planar, background taken as the far plane. The text
// gives no unit for depth; the author's public program has one normalised depth 2z/(z + far) for Sobel,
// pseudo-variances and their threshold, and compares with the past depth of the same pixel: the defaults of depthUnit
// and pastDepth. Every term can be switched off for ablation. Deviations: eq 3.4 prints a factor 4, matrices 3.5/3.6
// hold (decisions 1); the ratio of eq 4.6 is capped at 1e3 against overflow (conventions 9). Depth deviations are taken
// from the centre pixel, never as differences of large sums.
#pragma once
#include "methods/temporal/temporal_kernels.h"

namespace aa {
struct Frame;
struct MethodDescriptor;
class Params;
MethodDescriptor masterDescriptor();

enum class DepthUnit { normalised, zfar, world };  // 2z / (z + far), z / far, scene units
DepthUnit masterDepthUnit(const Params& params);
float masterFarDepth(const Frame& frame);  // the camera's far plane, or the largest depth that is not background
inline constexpr int kMasterScratchRows = 48;
struct MasterArgs {
    TemporalIn in;  // encoded colour as it is; alpha of the history: the Sobel value, filtered over time
    RgbIn albedoEncoded;
    const uint32_t* objectId;
    const float* previousDepth;
    float* keptDepth;  // this frame's depth for the next one, in depthUnit
    ExpectedDepth expected;
    const float* depthOfTexel;  // in.depthView before it was moved to the texel nearest to p - jitter,
    int texelX, texelY;         // by this much
    float weightAlbedo, weightLit, farDepth;
    DepthUnit depthUnit;  // of Sobel, pseudo-variances and their threshold
    Luminance luminance;
    float kMin, kMax, depthThreshold, minAlias;
    ClipTarget clipTarget;
    bool temporalSobel, samePixelDepth, relativeThreshold, compensate;
    RgbOut
        sharpened;  // the sharpened blend, or null; but not the call's first and last row, whose neighbours are others'
    float sharpenGain;  // as of SharpenHistoryArgs
    void* scratch;      // kMasterScratchRows rows
    bool useModel, useDepth, useDepthTemporal, useSobel;
    // Debug, or null: aliasedValue and its four terms.
    float *debugAliased, *debugSobel, *debugModel, *debugDepth, *debugDepthTemporal;
};
struct MasterKernels {
    RowKernel<MasterArgs> resolve;  // the fewer calls, the less is computed twice: seven rows of margin each
};
}  // namespace aa
AA_KERNEL_TABLE(aa::MasterKernels, masterKernels)
