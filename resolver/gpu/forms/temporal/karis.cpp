#include "methods/temporal/karis.h"

#include "gpu/forms.h"
#include "gpu/forms/temporal/temporal_form.h"
#include "methods/temporal/temporal.h"

namespace aa::gpu {
namespace {

class KarisForm : public TemporalForm {
  public:
    KarisForm(Session& session, const Params& params, std::string_view id, bool pq)
        : TemporalForm(session, params, id, Space::linear), pq_(pq) {}

  private:
    void recordTemporal(Current& current, const TemporalPush& push, Image& out) override {
        const Params& p = params();
        if (shader_.name().empty())
            shader_ = Shader("temporal/karis", constants({{10, p.realf("alpha")},
                                                          {11, p.choice("filter") == "blackmanHarris"},
                                                          {12, p.choice("toneWeight") != "none"},
                                                          {13, p.choice("toneWeight") == "hdr4"},
                                                          {14, p.flag("ycocg")},
                                                          {15, int(p.choiceIndex("box"))},
                                                          {16, p.realf("gamma")},
                                                          {17, temporal::neighbourhood(p)},
                                                          {18, int(p.choiceIndex("constraint"))},
                                                          {19, int(p.choiceIndex("antiFlicker"))},
                                                          {20, p.flag("inverseLuminance")},
                                                          {21, pq_}}));
        float filter[9];
        karisFilter(push.jitterX, push.jitterY, filter);
        current.recorder().upload(fitted(filter_, sizeof filter), std::as_bytes(std::span(filter)));
        std::vector<Binding> all = bindings(current, out);
        all.push_back(memory(filter_));
        current.recorder().dispatch(shader_, push.width, push.height, all, push);
    }
    bool showsBlend() const override { return !pq_; }
    bool pq_;
    Shader shader_;
    Buffer filter_;
};

template <bool pq>
std::unique_ptr<GpuMethod> make(std::string_view id, Session& session, const Params& params) {
    return std::make_unique<KarisForm>(session, params, id, pq);
}
}  // namespace

std::vector<Form> karisForms() {
    return {{"karis", [](Session& s, const Params& p, const ShotInfo&) { return make<false>("karis", s, p); }},
            {"salvi", [](Session& s, const Params& p, const ShotInfo&) { return make<false>("salvi", s, p); }},
            {"falcor", [](Session& s, const Params& p, const ShotInfo&) { return make<false>("falcor", s, p); }},
            {"donut", [](Session& s, const Params& p, const ShotInfo&) { return make<true>("donut", s, p); }}};
}

}  // namespace aa::gpu
