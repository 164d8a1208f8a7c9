#include "methods/temporal/raptor.h"

#include "gpu/forms.h"
#include "gpu/forms/temporal/temporal_form.h"
#include "methods/temporal/temporal.h"

namespace aa::gpu {
namespace {

class RaptorForm : public TemporalForm {
  public:
    RaptorForm(Session& session, const Params& params) : TemporalForm(session, params, "raptor", Space::linear) {}

  private:
    void recordTemporal(Current& current, const TemporalPush& push, Image& out) override {
        const Params& p = params();
        const bool sharpened = !showsBlend();
        if (shader_.name().empty()) {
            const bool weighted = p.flag(p.choice("lumaDiff") == "off" ? "inverseLuminance" : "lumaDiffWeights");
            shader_ = Shader("temporal/raptor", constants({{10, int(p.choiceIndex("constraint"))},
                                                           {11, int(p.choiceIndex("lumaDiff"))},
                                                           {12, p.flag("temporalFiltering")},
                                                           {13, p.flag("ycocg")},
                                                           {14, weighted},
                                                           {15, p.flag("currentClamp")},
                                                           {16, p.choice("contrastDivisor") == "printed"},
                                                           {17, p.realf("gamma")},
                                                           {18, p.realf("kmin")},
                                                           {19, p.realf("kmax")}}));
            if (sharpened) sharpen_ = Shader("temporal/raptor_sharpen", {{10, p.realf("sharpen")}});
        }
        const auto filter = raptorFilter(p, push.jitterX, push.jitterY);
        current.recorder().upload(fitted(filter_, sizeof(filter)), std::as_bytes(std::span(filter)));
        std::vector<Binding> images = bindings(current, out);
        images.push_back(memory(filter_));
        current.recorder().dispatch(shader_, push.width, push.height, images, push);
        if (!sharpened) return;
        const std::array size{push.width, push.height};
        const Binding shown[] = {read(blend().next()), written(out)};
        current.recorder().dispatch(sharpen_, push.width, push.height, shown, size);
    }
    bool showsBlend() const override { return params().realf("sharpen") == 0; }
    bool storesResult() const override { return false; }
    Shader shader_, sharpen_;
    Buffer filter_;
};
}  // namespace

std::vector<Form> raptorForms() {
    return {{"raptor", [](Session& s, const Params& p, const ShotInfo&) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<RaptorForm>(s, p);
             }}};
}

}  // namespace aa::gpu
