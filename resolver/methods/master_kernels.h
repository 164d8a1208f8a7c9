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
// Pass T: the Sobel value over time; what the main pass needs of the past is stored beside it.
struct MasterPastArgs {
    TemporalIn in;  // history alpha = filtered Sobel value of the previous frame
    const float* sobel;
    const float* previousDepth;
    float* sobelFiltered;
    float* pastColor[3];
    float* pastDepth;  // NaN where history is outside
    float kMin, kMax;
    bool temporalSobel, samePixelDepth;
};
struct MasterArgs {
    TemporalIn in;
    const float* sobelFiltered;
    const uint32_t* objectId;
    const float *pastColor[3], *pastDepth;
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
