#include "methods/temporal/uncharted.h"

#include "gpu/forms.h"
#include "gpu/forms/temporal/sharpened.h"
#include "methods/temporal/taa_simplest.h"

namespace aa::gpu {
namespace {

class TaaSimplestForm : public TemporalForm {
  public:
    TaaSimplestForm(Session& session, const Params& params)
        : TemporalForm(session, params, "taaSimplest", Space::linear) {}

  private:
    void recordTemporal(Current& current, const TemporalPush& push, Image& out) override {
        if (shader_.name().empty()) shader_ = Shader("temporal/taa_simplest", constants({{10, params().realf("k")}}));
        current.recorder().dispatch(shader_, push.width, push.height, bindings(current, out), push);
    }
    bool showsBlend() const override { return true; }
    Shader shader_;
};

class UnchartedForm : public TemporalForm {
  public:
    UnchartedForm(Session& session, const Params& params)
        : TemporalForm(session, params, "uncharted", Space::encoded), sharpening_(temporal::sharpenKernel(params)) {}

  private:
    void recordTemporal(Current& current, const TemporalPush& push, Image& out) override {
        const Params& p = params();
        if (shader_.name().empty())
            shader_ = Shader("temporal/uncharted", constants({{10, p.realf("kmin")},
                                                              {11, p.realf("kmax")},
                                                              {12, temporal::neighbourhood(p)},
                                                              {13, temporal::clipTarget(p)},
                                                              {14, temporal::luminance(p)}}));
        current.recorder().dispatch(shader_, push.width, push.height, bindings(current, out), push);
        sharpening_.record(current, blend().next(), out);
    }
    bool showsBlend() const override { return !sharpening_.wanted(); }
    bool storesResult() const override { return false; }
    Shader shader_;
    HistorySharpening sharpening_;
};

std::unique_ptr<GpuMethod> uncharted(Session& session, const Params& params, const ShotInfo&) {
    return std::make_unique<UnchartedForm>(session, params);
}
}  // namespace

std::vector<Form> unchartedForms() {
    return {{"taaSimplest",
             [](Session& s, const Params& p, const ShotInfo&) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<TaaSimplestForm>(s, p);
             }},
            {"uncharted", uncharted},
            {"unchartedNorm", uncharted},
            {"unchartedNoSharpen", uncharted}};
}

}  // namespace aa::gpu
