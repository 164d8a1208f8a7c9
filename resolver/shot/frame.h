// One frame of a shot in memory. Passes that were not asked for are empty planes. All borders are filled.
#pragma once
#include <glm/vec2.hpp>
#include <optional>
#include <vector>

#include "image/colour.h"
#include "image/plane.h"
#include "shot/camera.h"
#include "shot/edge_segment.h"
#include "shot/pass.h"

namespace aa {

// Depth where no surface is; from kBackgroundFrom on others' depths, and what methods test, mean that too.
inline constexpr float kBackgroundDepth = 1e10f, kBackgroundFrom = 1e9f;
// Motion of a pixel without a previous position: outside of any picture, as the exporter writes it.
inline constexpr float kInvalidMotionPx = 1e6f;

// Passes (conventions 3) at one sub-sample position of every pixel.
struct SubSample {
    PlaneF depthView;  // as Frame::depthView
    Rgb normalWorld;
    PlaneU objectId;
    Rgb colorLinear;  // only when Pass::subsampleColor was asked for
};

struct Frame {
    int number = 1;
    int width = 0, height = 0;
    bool reset = false;
    glm::dvec2 jitterPx{0.0};  // sample position minus pixel centre, y down
    std::optional<Camera> camera;
    std::optional<Camera> previousCamera;  // of the frame before, when there is one and no reset
    PassSet passes;                        // what is present

    Rgb colorLinear;
    Rgb colorEncoded;  // D(colorLinear); filled by the driver when a method reads encoded colour
    Rgb albedoLinear;
    Rgb albedoEncoded;  // the chain's transfer of it, without its exposure; filled with colorEncoded, in a run in its
                        // place
    // From linear colours to displayed ones; set by the driver. With the identity transfer the driver has turned the
    // linear colours into displayed ones already, and this only clamps.
    DisplayChain display;
    PlaneF depthView;  // planar z > 0, background 1e10
    Rgb normalWorld;
    PlaneU objectId;              // 0 = background
    PlaneF motionXPx, motionYPx;  // current - previous, y down. In a static shot: zeros
    std::vector<SubSample> subSamples;
    std::vector<glm::dvec2> subSamplePositionsPx;  // offsets from pixel centre + jitterPx, y down
    PlaneU subSampleMask;                          // bit k: sub-sample k lies on the centre sample's surface
    PlaneF edgeXPx, edgeYPx;
    std::vector<EdgeSegment> segments;  // of the un-jittered picture, whatever this frame's jitter
};

// Ground truth: two independent halves; the reference is their mean, the error bar MSE(a, b) / 4 (conventions 13.9).
struct Truth {
    Rgb a, b;  // linear
};

}  // namespace aa
