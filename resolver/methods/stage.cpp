#include "methods/stage.h"

#include "image/error.h"
#include "methods/sharpen.h"
#include "methods/stages/fill.h"
#include "methods/stages/motion_blur.h"

namespace aa {
namespace {

class SharpenStage : public Stage {
  public:
    explicit SharpenStage(Sharpen filter) : filter_(filter) {}
    void apply(const Frame&, const Method&, Space space, const Exec& exec, Rgb& image) override {
        sharpen(image, filter_, space, exec, sharpened_);
        std::swap(image, sharpened_);
    }
    size_t stateBytes() const override { return sharpened_.bytes(); }

  private:
    Sharpen filter_;
    Rgb sharpened_;
};

StageDescriptor sharpenStage() {
    return {.value = choiceParam("sharpen", "norm", kSharpens,
                                 "3x3 cross with gain 1 (xu) or 1/4 (norm), or luminance against its 3x3 mean",
                                 "[Oliveros 2018, eq 3.1 and 4.17]; [Castorina 2023]"),
            .create = [](const std::string& value, const MethodSpec&, const ShotInfo&) {
                return std::make_unique<SharpenStage>(sharpenByName(value));
            }};
}

class StagedMethod : public Method {
  public:
    StagedMethod(std::unique_ptr<Method> method, const MethodSpec& spec, const ShotInfo& shot)
        : method_(std::move(method)), space_(spec.outputSpace()) {
        for (const auto& s : spec.stages) stages_.push_back(s.stage->create(s.value, spec, shot));
        for (const auto& stage : stages_) method_->keepRejection = method_->keepRejection || stage->needsRejection();
    }
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        method_->keepDebugLayers = keepDebugLayers;
        method_->resolve(frame, exec, out);
        for (const auto& stage : stages_) {
            out.fillBorder();
            stage->apply(frame, *method_, space_, exec, out);
        }
    }
    size_t stateBytes() const override {
        size_t bytes = method_->stateBytes();
        for (const auto& stage : stages_) bytes += stage->stateBytes();
        return bytes;
    }
    std::vector<DebugLayer> debugLayers() const override { return method_->debugLayers(); }
    const PlaneF* rejection() const override { return method_->rejection(); }
    std::optional<double> deviceSeconds() const override { return method_->deviceSeconds(); }

  private:
    std::unique_ptr<Method> method_;
    Space space_;
    std::vector<std::unique_ptr<Stage>> stages_;
};

}  // namespace

const std::vector<StageDescriptor>& stages() {
    static const std::vector<StageDescriptor> all = {
        sharpenStage(),
        fillStage(),
        motionBlurStage(),
    };
    return all;
}

const StageDescriptor& findStage(std::string_view name) {
    std::vector<std::string_view> known;
    for (const auto& s : stages()) {
        if (s.value.name == name) return s;
        known.push_back(s.value.name);
    }
    const std::string near = suggestion(name, known);
    throw UsageError("unknown stage '" + std::string(name) + "'" +
                     (near.empty() ? "; `aaresolve list` shows all" : "; did you mean '" + near + "'?"));
}

StageSpec parseStage(std::string_view text) {
    const size_t eq = text.find('=');
    const std::string_view name = text.substr(0, eq);
    StageSpec spec{&findStage(name), std::string(eq == std::string_view::npos ? "" : text.substr(eq + 1))};
    if (spec.value.empty())
        throw UsageError("stage '" + std::string(name) + "': expected " + std::string(name) + "=value, found '" +
                         std::string(text) + "'");
    if (spec.stage->valueIsMethod)
        parseMethod(spec.value);
    else  // a parameter table of one: throws on a bad value
        spec.value = Params("stage", {spec.stage->value}, {{std::string(name), spec.value}}).all().begin()->second;
    return spec;
}

PassSet passesOf(const StageSpec& spec) {
    return spec.stage->valueIsMethod ? spec.stage->passes | parseMethod(spec.value).passes() : spec.stage->passes;
}

bool readsEncoded(const StageSpec& spec) { return spec.stage->valueIsMethod && parseMethod(spec.value).readsEncoded(); }

std::unique_ptr<Method> withStages(std::unique_ptr<Method> method, const MethodSpec& spec, const ShotInfo& shot) {
    if (spec.stages.empty()) return method;
    return std::make_unique<StagedMethod>(std::move(method), spec, shot);
}

}  // namespace aa
