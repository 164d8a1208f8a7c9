// What the GPU forms of spatial methods share: shaders/common/spatial.glsl from the host's side.
#pragma once
#include "gpu/method.h"

namespace aa::gpu {

// The push constants of every spatial shader.
struct SpatialPush {
    int32_t width, height;
    explicit SpatialPush(const Current& current) : width(current.width()), height(current.height()) {}
};

// A method whose one shader reads one picture.
class OneShaderForm : public GpuMethod {
  public:
    OneShaderForm(Session& session, const Params& params, Input picture, Shader shader)
        : GpuMethod(session, params), picture_(picture), shader_(std::move(shader)) {}

  private:
    void record(Current& current, Image& out) override {
        const SpatialPush push(current);
        const Binding images[] = {read(current[picture_]), written(out)};
        current.recorder().dispatch(shader_, push.width, push.height, images, push);
    }
    Input picture_;
    Shader shader_;
};

}  // namespace aa::gpu
