#include "gpu/forms.h"
#include "gpu/forms/spatial/spatial_form.h"

namespace aa::gpu {
namespace {

std::unique_ptr<GpuMethod> nfaa(Session& session, const Params& p, const ShotInfo&) {
    Shader shader("spatial/nfaa", {{10, p.integer("scale")}, {11, p.realf("strength")}, {12, p.realf("longest")}});
    return std::make_unique<OneShaderForm>(session, p, Input::encoded, std::move(shader));
}
std::unique_ptr<GpuMethod> ssssaa(Session& session, const Params& p, const ShotInfo&) {
    Shader shader("spatial/ssssaa", {{10, p.realf("reach")}, {11, p.realf("threshold")}});
    return std::make_unique<OneShaderForm>(session, p, Input::encoded, std::move(shader));
}

class DlaaForm : public GpuMethod {
  public:
    DlaaForm(Session& session, const Params& p)
        : GpuMethod(session, p),
          edges_("spatial/dlaa_edges"),
          filter_("spatial/dlaa", {{10, p.realf("lambda")},
                                   {11, p.realf("epsilon")},
                                   {12, p.realf("longThreshold")},
                                   {13, p.flag("preserveHighlights")}}) {}

  private:
    void record(Current& current, Image& out) override {
        const SpatialPush push(current);
        Image& edge = fitted(edgeImage_, push.width, push.height, Format::rg32f);
        const Image& picture = current[Input::encoded];
        const Binding edges[] = {read(picture), written(edge)};
        current.recorder().dispatch(edges_, push.width, push.height, edges, push);
        const Binding images[] = {read(picture), written(out), read(edge)};
        current.recorder().dispatch(filter_, push.width, push.height, images, push);
    }
    Shader edges_, filter_;
    Image edgeImage_;  // strength and luma
};
std::unique_ptr<GpuMethod> dlaa(Session& session, const Params& p, const ShotInfo&) {
    return std::make_unique<DlaaForm>(session, p);
}
}  // namespace

std::vector<Form> edgeBlurForms() { return {{"dlaa", dlaa}, {"nfaa", nfaa}, {"ssssaa", ssssaa}}; }

}  // namespace aa::gpu
