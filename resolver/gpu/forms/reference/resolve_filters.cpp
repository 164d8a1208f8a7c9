#include "methods/reference/resolve_filters.h"

#include <cmath>

#include "gpu/forms.h"

namespace aa::gpu {
namespace {

class ResolveForm : public GpuMethod {
  public:
    ResolveForm(Session& session, const Params& p, const ShotInfo& shot)
        : GpuMethod(session, p),
          taps_(resolveTaps(resolveShape(p), shot.subSamplePositionsPx)),
          shader_("reference/resolve", {{10, p.flag("inverseLuminance")}, {11, false}}) {}

  private:
    void record(Current& current, Image& out) override {
        const auto taps = std::as_bytes(std::span(taps_));
        current.recorder().upload(fitted(buffer_, taps.size()), taps);
        const struct {
            int32_t width, height, samples, taps;
            float luminanceScale;
        } push{current.width(), current.height(), int32_t(current.frame().subSamples.size()), int32_t(taps_.size()),
               float(std::exp2(params().real("exposure")))};
        const Binding bindings[] = {read(current[Input::subColour]), written(out), memory(buffer_)};
        current.recorder().dispatch(shader_, push.width, push.height, bindings, push);
    }
    std::vector<ResolveTap> taps_;
    Shader shader_;
    Buffer buffer_;
};
}  // namespace

std::vector<Form> resolveFiltersForms() {
    return {{"resolve", [](Session& s, const Params& p, const ShotInfo& shot) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<ResolveForm>(s, p, shot);
             }}};
}

}  // namespace aa::gpu
