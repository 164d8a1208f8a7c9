#include "gpu/forms.h"

namespace aa::gpu {
namespace {

class NoaaForm : public GpuMethod {
  public:
    using GpuMethod::GpuMethod;

  private:
    void record(Current& current, Image& out) override {
        const struct { int32_t width, height; } push{current.width(), current.height()};
        const Binding images[] = {read(current[Input::colour]), written(out)};
        current.recorder().dispatch(shader_, push.width, push.height, images, push);
    }
    Shader shader_{"reference/noaa"};
};

class AccumForm : public GpuMethod {
  public:
    using GpuMethod::GpuMethod;

  private:
    void record(Current& current, Image& out) override {
        const Frame& frame = current.frame();
        const bool resized = sum_.width() != frame.width || sum_.height() != frame.height;
        if (frame.reset || resized) count_ = 0;
        const bool first = count_ == 0, adds = count_ < params().integer("samples");
        if (adds) count_++;
        const struct {
            int32_t width, height;
            uint32_t firstFrame, adds;
            float frames;
        } push{frame.width, frame.height, first, adds, float(count_)};
        const bool encoded = averagedSpace(params()) == Space::encoded;
        const Binding images[] = {read(current[encoded ? Input::encoded : Input::colour]),
                                  written(fitted(sum_, frame.width, frame.height, Format::rgba32f)),
                                  written(fitted(lost_, frame.width, frame.height, Format::rgba32f)), written(out)};
        current.recorder().dispatch(shader_, frame.width, frame.height, images, push);
    }
    int count_ = 0;
    Image sum_, lost_;
    Shader shader_{"reference/accum"};
};

class SsaaForm : public GpuMethod {
  public:
    SsaaForm(Session& session, const Params& p)
        : GpuMethod(session, p), shader_("reference/ssaa", {{10, averagedSpace(p) == Space::encoded}}) {}

  private:
    void record(Current& current, Image& out) override {
        const Frame& frame = current.frame();
        const DisplayArgs display = displayArgs(frame.display);
        const struct {
            int32_t width, height, samples;
            float displayScale;
            int32_t toneMap;
            uint32_t srgb;
        } push{frame.width,   frame.height,    int32_t(frame.subSamples.size()),
               display.scale, display.toneMap, display.srgb};
        const Binding images[] = {read(current[Input::subColour]), written(out)};
        current.recorder().dispatch(shader_, frame.width, frame.height, images, push);
    }
    Shader shader_;
};

template <class T>
std::unique_ptr<GpuMethod> make(Session& s, const Params& p, const ShotInfo&) {
    return std::make_unique<T>(s, p);
}
}  // namespace

std::vector<Form> averagesForms() {
    return {{"noaa", make<NoaaForm>}, {"accum", make<AccumForm>}, {"ssaa", make<SsaaForm>}};
}

}  // namespace aa::gpu
