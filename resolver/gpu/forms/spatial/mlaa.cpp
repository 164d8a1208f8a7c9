#include "methods/spatial/mlaa.h"

#include "gpu/forms.h"
#include "gpu/forms/spatial/spatial_form.h"

namespace aa::gpu {
namespace {

class MlaaForm : public GpuMethod {
  public:
    MlaaForm(Session& session, const Params& p)
        : GpuMethod(session, p),
          edges_("spatial/mlaa_edges", {{10, int(p.choiceIndex("edges"))}}),
          weights_("spatial/mlaa_weights", {{10, p.choice("heights") == "colour"}}),
          blend_("spatial/mlaa_blend", {{10, p.flag("simultaneous")}}) {}

  private:
    void record(Current& current, Image& out) override {
        const SpatialPush push(current);
        Recorder& recorder = current.recorder();
        const Image& picture = current[Input::encoded];
        const auto bytes = [](int lines, int length) { return size_t(lines) * size_t((length + 31) / 32) * 4; };
        Buffer& top = fitted(topBits_, bytes(push.height, push.width));
        Buffer& left = fitted(leftBits_, bytes(push.width, push.height));
        Image& weights = fitted(weightsImage_, push.width, push.height, session().colour());
        recorder.clear(top), recorder.clear(left);
        const Binding edges[] = {read(picture), memory(top), memory(left)};
        recorder.dispatch(edges_, push.width, push.height, edges, push);
        const Binding lines[] = {read(picture), memory(top), memory(left), written(weights)};
        recorder.dispatch(weights_, push.width, push.height, lines, push);
        const Binding images[] = {read(picture), written(out), read(weights)};
        recorder.dispatch(blend_, push.width, push.height, images, push);
    }
    Shader edges_, weights_, blend_;
    Buffer topBits_, leftBits_;
    Image weightsImage_;
};
std::unique_ptr<GpuMethod> mlaa(Session& session, const Params& p, const ShotInfo&) {
    return std::make_unique<MlaaForm>(session, p);
}
}  // namespace

std::vector<Form> mlaaForms() { return {{"mlaa", mlaa}}; }

}  // namespace aa::gpu
