#pragma once
#include "methods/temporal_kernels.h"

namespace aa {

enum class DepthUnit { normalised, zfar, world };  // 2z / (z + far), z / far, scene units
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
