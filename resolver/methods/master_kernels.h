#pragma once
#include "methods/temporal_kernels.h"

namespace aa {

// Pass S, part 1: luminance planes.
struct MasterLuminanceArgs {
    RgbIn albedoLinear, colorEncoded;
    float *luminanceAlbedo, *luminanceLit;
    int stride, width;
    bool bt601;
};
// Pass S, part 2.
struct MasterSobelArgs {
    const float *luminanceAlbedo, *luminanceLit, *depthView;
    float* sobel;
    int stride, width;
    float weightAlbedo, weightLit, depthScale, farDepth;
};
// Pass T: the Sobel value over time. What the main pass needs of the past waits for it in in.next, where the main pass
// puts the blend: the history's colour, and in alpha the past depth, NaN where history is outside.
struct MasterPastArgs {
    TemporalIn in;  // history alpha = filtered Sobel value of the previous frame
    const float* sobel;
    const float* previousDepth;
    float* sobelFiltered;
    float kMin, kMax;
    bool temporalSobel, samePixelDepth;
};
struct MasterArgs {
    TemporalIn in;  // in.next as pass T left it
    const float* sobelFiltered;
    const uint32_t* objectId;
    float* keptDepth;  // this frame's depth for the next one; null: not wanted
    ExpectedDepth expected;
    float kMin, kMax, farDepth, depthThreshold, minAlias;
    ClipTarget clipTarget;
    bool relativeThreshold, compensate;
    bool useModel, useDepth, useDepthTemporal, useSobel;
    // Debug, or null: aliasedValue and its four terms.
    float *debugAliased, *debugSobel, *debugModel, *debugDepth, *debugDepthTemporal;
};
struct MasterKernels {
    RowKernel<MasterLuminanceArgs> luminance;
    RowKernel<MasterSobelArgs> sobel;
    RowKernel<MasterPastArgs> past;
    RowKernel<MasterArgs> resolve;
};
}  // namespace aa
AA_KERNEL_TABLE(aa::MasterKernels, masterKernels)
