// A frame's centre samples and sub-samples as plain views, filled by methods/geometry/subsample_geometry.h. Null: not
// read.
#pragma once
#include "kernels/table.h"

namespace aa {

struct SubSampleArgs {
    const float* depthView;
    RgbIn normalWorld;
    const uint32_t* objectId;
    RgbIn color;
    float offsetPx[2];  // from the centre sample; both are moved by the jitter
};
struct GeometryArgs {
    int stride, width, height;
    const float* depthView;  // centre samples
    RgbIn normalWorld;
    const uint32_t* objectId;
    const SubSampleArgs* sample;
    int samples;
    float ray[3], rayX[3], rayY[3];  // world-space ray of the centre sample of pixel (0, 0), and its change per pixel
    float originX[3], originY[3];    // as in CameraRays
};

}  // namespace aa
