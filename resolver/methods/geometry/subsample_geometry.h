// What the geometry-aware methods know of a frame's sub-samples, as plain views for kernels (conventions 3).
//
// Positions. The frame's colour, depth, normal and object were sampled at the pixel centre plus the jitter ("centre
// sample"); sub-sample k lies at its position from there, as a GPU jitters all samples of a pixel together. So every
// vector from the centre sample to sub-sample k is the position itself, with and without jitter.
#pragma once
#include <array>

#include "kernels/subsample_args.h"
#include "shot/frame.h"

namespace aa {

using Vec3d = std::array<double, 3>;

// Position of the point seen at pixel position p with planar depth z, relative to the camera, in world axes:
// z * (ray + p.x rayX + p.y rayY) + (origin + p.x originX + p.y originY). The origin part is 0 for perspective.
struct CameraRays {
    Vec3d ray{}, rayX{}, rayY{}, origin{}, originX{}, originY{};
};
// From the un-jittered matrices. Throws InputError when the frame has no camera or one without a projection matrix;
// `reader` names the method and its option for the message.
CameraRays cameraRays(const Frame& frame, std::string_view reader);

// What a method reads of the geometry, at the centre samples and at the sub-samples, and of the latter's colours.
struct GeometryNeeds {
    bool depth = true, normals = false, ids = false, colors = false, camera = false;
    PassSet passes() const;
};
// Kernel arguments and the sub-sample views that they point to; valid as long as the frame.
class GeometryViews {
  public:
    // Throws InputError as cameraRays.
    GeometryViews(const Frame& frame, GeometryNeeds needs, std::string_view reader);
    GeometryViews(const GeometryViews&) = delete;
    const GeometryArgs& args() const { return args_; }

  private:
    GeometryArgs args_{};
    std::vector<SubSampleArgs> samples_;
};

// Throws InputError when the shot has no sub-samples or more than `most`.
void requireSubSamples(const std::vector<glm::dvec2>& positionsPx, std::string_view method, size_t most);

}  // namespace aa
