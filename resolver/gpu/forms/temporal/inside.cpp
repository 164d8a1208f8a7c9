#include "methods/temporal/inside.h"

#include "gpu/forms.h"
#include "gpu/forms/temporal/temporal_form.h"
#include "methods/temporal/temporal.h"

namespace aa::gpu {
namespace {

class InsideForm : public TemporalForm {
  public:
    InsideForm(Session& session, const Params& params) : TemporalForm(session, params, "inside", Space::encoded) {}

  private:
    void recordTemporal(Current& current, const TemporalPush& push, Image& out) override {
        const Params& p = params();
        if (shader_.name().empty()) {
            const bool motionUnjittered = temporal::dilation(p) == Dilation::none && p.flag("unjitterReprojection");
            shader_ = Shader("temporal/inside", constants({{10, p.realf("kmin")},
                                                           {11, p.realf("kmax")},
                                                           {12, int(p.choiceIndex("neighbourhood"))},
                                                           {13, temporal::clipTarget(p)},
                                                           {14, p.flag("unjitterColor")},
                                                           {15, p.flag("unjitterNeighbourhood")},
                                                           {16, motionUnjittered},
                                                           {17, p.flag("ycocg")},
                                                           {18, temporal::luminance(p)},
                                                           {19, p.realf("motionBlur")}}));
        }
        current.recorder().dispatch(shader_, push.width, push.height, bindings(current, out), push);
    }
    bool showsBlend() const override { return params().realf("motionBlur") == 0; }
    Shader shader_;
};
}  // namespace

std::vector<Form> insideForms() {
    return {{"inside", [](Session& s, const Params& p, const ShotInfo&) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<InsideForm>(s, p);
             }}};
}

}  // namespace aa::gpu
