#include "gpu/forms.h"
#include "gpu/forms/spatial/smaa_form.h"
#include "methods/spatial/smaa_areas.h"

namespace aa::gpu {
namespace {
struct Size {
    int32_t width, height;
};
}  // namespace

SmaaForm::SmaaForm(Session& session, const Params& p)
    : GpuMethod(session, p), settings_(smaaSettings(p)), linear_(p.choice("blendSpace") == "linear") {
    const SmaaEdgeArgs& e = settings_.edge;
    const SmaaBlendArgs& b = settings_.blend;
    edgesShader_ = Shader("spatial/smaa_edges", {{10, e.kind},
                                                 {11, e.predication},
                                                 {12, e.consistent},
                                                 {13, e.threshold},
                                                 {14, e.localContrast},
                                                 {15, e.predicationThreshold},
                                                 {16, e.predicationScale},
                                                 {17, e.predicationStrength}});
    weightsShader_ = Shader("spatial/smaa_weights", {{10, b.searchSteps},
                                                     {11, b.diagonalSteps},
                                                     {12, b.cornerRounding},
                                                     {13, settings_.published},
                                                     {14, b.unorm8}});
    blendShader_ = Shader("spatial/smaa_blend", {{10, false}});
    velocityShader_ = Shader("spatial/smaa_blend", {{10, true}});
    separateShader_ = Shader("spatial/smaa_separate");
}

const Buffer& SmaaForm::areasFor(Current& current, glm::dvec2 samplePx) {
    for (const Areas& a : areas_)
        if (a.samplePx == samplePx) return a.memory;
    std::vector<float> tables;
    const auto append = [&](const std::vector<float>& t) { tables.insert(tables.end(), t.begin(), t.end()); };
    if (settings_.published) {
        append(orthogonalTable(-samplePx.y));
        append(orthogonalTable(-samplePx.x));
    }
    if (settings_.blend.diagonalSteps > 0)
        for (const bool falling : {false, true})
            append(diagonalTableAt({samplePx.x, samplePx.y}, falling, settings_.published));
    // Jitter without a period: the oldest goes. Uploads and dispatches keep their order: its last reader is done.
    constexpr size_t kMost = 64;
    if (areas_.size() < kMost) areas_.emplace_back();
    Areas& a = areas_[latest_ = (latest_ + 1) % kMost];
    a.samplePx = samplePx;
    fitted(a.memory, std::max<size_t>(tables.size() * sizeof(float), 16));
    current.recorder().upload(a.memory, std::as_bytes(std::span(tables)));
    return a.memory;
}

void SmaaForm::findEdges(Current& current, const Image* encoded, glm::dvec2 samplePx) {
    const int width = current.width(), height = current.height();
    const SmaaEdgeArgs& e = settings_.edge;
    const bool depth = e.kind == SmaaEdges::depth || e.predication == SmaaPredication::depth;
    const Image* const depthImage = depth ? &current[Input::depth] : encoded;
    const Image* const ids =
        e.predication == SmaaPredication::object ? &current[Input::objectId] : &fitted(noIds_, 1, 1, Format::r32ui);
    fitted(edges_, width, height, Format::r32ui);
    fitted(weights_, width, height, session().fast() && settings_.blend.unorm8 ? Format::rgba8 : session().colour());
    const Binding edgeImages[] = {read(encoded ? *encoded : *depthImage), read(*depthImage), read(*ids),
                                  written(edges_)};
    current.recorder().dispatch(edgesShader_, width, height, edgeImages, Size{width, height});

    struct {
        int32_t width, height;
        float top, left;
    } push{width, height, -float(samplePx.y), -float(samplePx.x)};
    const Binding weightImages[] = {read(edges_), memory(areasFor(current, samplePx)), written(weights_)};
    current.recorder().dispatch(weightsShader_, width, height, weightImages, push);
}

void SmaaForm::blend(Current& current, const Image& in, Blended out, const Blended* first) {
    struct {
        int32_t width, height;
        uint32_t average;
    } push{current.width(), current.height(), first ? 1u : 0u};
    const Binding images[] = {read(in),
                              read(weights_),
                              read(out.velocity ? current[Input::motion] : in),
                              read(first ? *first->colour : in),
                              read(first && first->velocity ? *first->velocity : in),
                              written(*out.colour),
                              written(out.velocity ? *out.velocity : *out.colour)};
    current.recorder().dispatch(out.velocity ? velocityShader_ : blendShader_, push.width, push.height, images, push);
}

const Image& SmaaForm::separate(Current& current, Input samples, size_t layer, Image& to) {
    struct {
        int32_t width, height, layer;
    } push{current.width(), current.height(), int32_t(layer)};
    fitted(to, push.width, push.height, session().colour());
    const Binding images[] = {read(current[samples]), written(to)};
    current.recorder().dispatch(separateShader_, push.width, push.height, images, push);
    return to;
}

void SmaaForm::blendTwo(Current& current, const ShotInfo& shot, SmaaSamples samples, Blended out) {
    Blended first{&fitted(first_, current.width(), current.height(), session().colour())};
    if (out.velocity) first.velocity = &fitted(firstVelocity_, current.width(), current.height(), velocityFormat());
    for (size_t k = 0; k < 2; k++) {
        const Image* const encoded =
            needsEncoded() || !linear_ ? &separate(current, Input::subEncoded, samples[k], encoded_) : nullptr;
        findEdges(current, encoded, current.frame().jitterPx + shot.subSamplePositionsPx[samples[k]]);
        const Image& in = linear_ ? separate(current, Input::subColour, samples[k], colour_) : *encoded;
        blend(current, in, k == 0 ? first : out, k == 0 ? nullptr : &first);
    }
}

namespace {
class Smaa1xForm : public SmaaForm {
  public:
    using SmaaForm::SmaaForm;

  private:
    void record(Current& current, Image& out) override {
        findEdges(current, needsEncoded() ? &current[Input::encoded] : nullptr, {0, 0});
        blend(current, current[linear() ? Input::colour : Input::encoded], {&out});
    }
};

class SmaaS2xForm : public SmaaForm {
  public:
    SmaaS2xForm(Session& session, const Params& params, const ShotInfo& shot)
        : SmaaForm(session, params), shot_(shot), samples_(smaaS2xSamples(shot)) {}

  private:
    void record(Current& current, Image& out) override { blendTwo(current, shot_, samples_, {&out}); }
    ShotInfo shot_;
    SmaaSamples samples_;
};
}  // namespace

std::vector<Form> smaaForms() {
    return {{"smaa1x",
             [](Session& s, const Params& p, const ShotInfo&) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<Smaa1xForm>(s, p);
             }},
            {"smaaS2x", [](Session& s, const Params& p, const ShotInfo& shot) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<SmaaS2xForm>(s, p, shot);
             }}};
}

}  // namespace aa::gpu
