#pragma once
#include "methods/temporal_kernels.h"

namespace aa {

inline constexpr int kMasterBlockRows = 32;
struct MasterArgs {
    TemporalIn in;  // encoded colour; alpha of the history: the Sobel value, filtered over time
    RgbIn albedoEncoded;
    const uint32_t* objectId;
    const float* previousDepth;
    float* keptDepth;  // this frame's depth for the next one
    ExpectedDepth expected;
    float weightAlbedo, weightLit, depthScale, farDepth;
    float kMin, kMax, depthThreshold, minAlias;
    ClipTarget clipTarget;
    bool bt601, temporalSobel, samePixelDepth, relativeThreshold, compensate;
    bool useModel, useDepth, useDepthTemporal, useSobel;
    // Debug, or null: aliasedValue and its four terms.
    float *debugAliased, *debugSobel, *debugModel, *debugDepth, *debugDepthTemporal;
};
struct MasterKernels {
    RowKernel<MasterArgs> resolve;  // over blocks of kMasterBlockRows rows
};
}  // namespace aa
AA_KERNEL_TABLE(aa::MasterKernels, masterKernels)
