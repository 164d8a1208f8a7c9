// What the GPU forms of methods that read sub-sample geometry share: shaders/common/subsamples.glsl from the host's
// side.
#pragma once
#include "gpu/method.h"
#include "methods/geometry/subsample_geometry.h"

namespace aa::gpu {

// The push constants of every shader that includes subsamples.glsl.
struct GeometryPush {
    int32_t width, height;
    int32_t toneMap;
    uint32_t srgb;
    float ray[3], displayScale;
    float rayX[4] = {}, rayY[4] = {}, originX[4] = {}, originY[4] = {};
};

class GeometryForm : public GpuMethod {
  protected:
    // `reader` names the method and its option for the message where the frame has no camera.
    GeometryForm(Session& session, const Params& params, std::string reader, GeometryNeeds needs)
        : GpuMethod(session, params), reader_(std::move(reader)), needs_(needs) {}

    GeometryPush push(const Frame& frame) const;
    // Bindings 0 to 9, and where the method has its own after them. A texture that is not read is one texel.
    std::vector<Binding> bindings(Current& current, Image& out, std::initializer_list<Binding> own = {});
    // Constant 0 and the form's own.
    static std::vector<Constant> constants(const ShotInfo& shot, std::vector<Constant> own);
    // One texel that nobody reads, of a picture or (1) of an array.
    Image& unread(Format format, int layers = 0);

  private:
    std::string reader_;
    GeometryNeeds needs_;
    Buffer offsets_;
    Image unread_[2][2];
};

// A method whose one shader binds nothing beyond that.
class OneShaderGeometryForm : public GeometryForm {
  protected:
    OneShaderGeometryForm(Session& session, const Params& params, std::string reader, GeometryNeeds needs,
                          Shader shader)
        : GeometryForm(session, params, std::move(reader), needs), shader_(std::move(shader)) {}

  private:
    void record(Current& current, Image& out) override {
        current.recorder().dispatch(shader_, current.width(), current.height(), bindings(current, out),
                                    push(current.frame()));
    }
    Shader shader_;
};

template <class T>
std::span<const std::byte> bytesOf(const std::vector<T>& values) {
    return std::as_bytes(std::span(values));
}

}  // namespace aa::gpu
