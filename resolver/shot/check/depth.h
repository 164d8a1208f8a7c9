// Is depth planar z in the camera's unit? Neighbouring pixels of one object with equal normals lie on one plane, so the
// step between their unprojected points must be perpendicular to the normal. Depth as ray length, normals in view space
// and (for an orthographic camera) a scaled depth all break that. Through a perspective camera a scaled scene looks the
// same, so there the scale is found where the camera moves (the parallax of resting surfaces), in the sub-samples, or
// by the frame's `depth_bounds`, the range that the producer knows from the objects' geometry.
#pragma once
#include "shot/check/check.h"
#include "shot/manifest.h"

namespace aa {

class DepthCheck {
  public:
    // Range, background and ids per pixel; planarity samples. Needs depth; uses normal, object, sub-samples, camera.
    void add(const Frame& frame, const FrameEntry& entry, CheckReport& report);
    // Parallax samples: needs depth, motion, and both cameras.
    void addMotion(const Frame& frame);
    void judge(CheckReport& report) const;

  private:
    void addRange(const Frame& frame, const FrameEntry& entry, CheckReport& report);
    void addBounds(const Frame& frame, const FrameEntry& entry, CheckReport& report);
    void addPlanarity(const Frame& frame);
    void addSubSamples(const Frame& frame);
    // Slope of the surface step against the normal, |n . d| / |d|, under each reading of the depth and normals.
    struct Slopes {
        std::vector<float> stated, rayLength, viewNormals;
    };
    Slopes slopes_;
    std::vector<float> orthographicScale_;  // stated slope / true slope
    std::vector<float> parallaxScale_;      // stated depth / depth that explains the motion
    std::vector<float> subSampleScale_;     // stated depth / depth of the same surface's sub-samples
    bool rangeFound_ = false, boundsFound_ = false, boundsSeen_ = false;
};

}  // namespace aa
