#include <optional>
#include <utility>

#include "image/error.h"
#include "methods/spatial/smaa.h"
#include "methods/temporal/smaa_temporal_kernels.h"
#include "methods/temporal/temporal.h"
#include "methods/working.h"

namespace aa {
namespace {

// Indices of the shot's sub-samples at a position and at its opposite; nothing when one of them is not there.
std::optional<SmaaSamples> opposites(const ShotInfo& shot, glm::dvec2 positionPx) {
    SmaaSamples found{};
    for (size_t i = 0; i < 2; i++) {
        const glm::dvec2 wanted = i == 0 ? positionPx : -positionPx;
        size_t k = 0;
        for (; k < shot.subSamplePositionsPx.size(); k++) {
            const glm::dvec2 d = shot.subSamplePositionsPx[k] - wanted;
            if (d.x * d.x + d.y * d.y < 1e-8) break;
        }
        if (k == shot.subSamplePositionsPx.size()) return {};
        found[i] = k;
    }
    return found;
}
[[noreturn]] void refuse(const ShotInfo& shot, const std::string& method, const std::string& patterns) {
    throw InputError(method + ": needs sub-samples at the " + patterns +
                     " standard positions; the shot's manifest lists " +
                     (shot.subSamplePositionsPx.empty() ? "none" : "others") + "; export the shot with that pattern");
}
constexpr glm::dvec2 kTwo{0.25, 0.25};                                  // d3d2
constexpr glm::dvec2 kFourEven{0.375, -0.125}, kFourOdd{0.125, 0.375};  // d3d4
}  // namespace

SmaaSamples smaaS2xSamples(const ShotInfo& shot) {
    if (const auto pair = opposites(shot, kTwo)) return *pair;
    refuse(shot, "smaaS2x", "2x");
}
std::array<SmaaSamples, 2> smaa4xSamples(const ShotInfo& shot) {
    if (const auto even = opposites(shot, kFourEven), odd = opposites(shot, kFourOdd); even && odd)
        return {*even, *odd};
    if (const auto both = opposites(shot, kTwo)) return {*both, *both};
    refuse(shot, "smaa4x", "2x or 4x");
}

namespace {
// The motion, which is blended into the two first planes of `velocity`.
Smaa::Motion motionInto(const Frame& frame, Rgb& velocity) {
    return {{&frame.motionXPx, &frame.motionYPx}, {&velocity.c[0], &velocity.c[1]}};
}
// Two sub-samples of a frame, each through SMAA 1x with its edges moved back, averaged.
class TwoSamples {
  public:
    explicit TwoSamples(const Params& p) : linear_(p.choice("blendSpace") == "linear"), smaa_(p) {}
    // As Smaa::blend().
    void resolve(const Frame& frame, const ShotInfo& shot, SmaaSamples samples, bool debug, const Exec& exec, Rgb& out,
                 const std::optional<Smaa::Motion>& motion = {}, const Smaa::RowsDone& done = {}) {
        smaa_.keepDebugLayers = debug;
        const Rgb* images[2];
        for (size_t k = 0; k < 2; k++) {
            const Rgb& color = frame.subSamples[samples[k]].colorLinear;
            const glm::dvec2 samplePx = frame.jitterPx + shot.subSamplePositionsPx[samples[k]];
            images[k] = linear_ ? &color : &encoded_[k];
            if (linear_) {
                smaa_.findEdgesOfLinear(frame, color, samplePx, exec, k);
            } else {
                encode(color, frame.display, exec, encoded_[k]);
                smaa_.findEdges(frame, encoded_[k], samplePx, exec, k);
            }
        }
        smaa_.blend(images, out, exec, motion, done);
    }
    size_t bytes() const { return smaa_.bytes() + encoded_[0].bytes() + encoded_[1].bytes(); }
    std::vector<DebugLayer> debugLayers() const {
        std::vector<DebugLayer> layers;
        for (size_t k = 0; k < 2; k++)
            for (DebugLayer& layer : smaa_.debugLayers(k)) {
                layer.name = "s" + std::to_string(k) + "." + layer.name;
                layers.push_back(std::move(layer));
            }
        return layers;
    }

  private:
    bool linear_;
    Smaa smaa_;
    Rgb encoded_[2];  // to blend, where that is wanted
};

class SmaaS2x : public Method {
  public:
    SmaaS2x(const Params& p, const ShotInfo& shot) : shot_(shot), samples_(smaaS2xSamples(shot)), two_(p) {}
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        two_.resolve(frame, shot_, samples_, keepDebugLayers, exec, out);
    }
    size_t stateBytes() const override { return two_.bytes(); }
    std::vector<DebugLayer> debugLayers() const override { return two_.debugLayers(); }

  private:
    ShotInfo shot_;
    SmaaSamples samples_;
    TwoSamples two_;
};

// The anti-aliased frame before and the velocities that it showed.
class VelocityWeightedPair {
  public:
    VelocityWeightedPair(std::string_view method, const Params& p)
        : method_(method),
          rejection_(p.realf("rejection")),
          reproject_(p.flag("reproject")),
          pixels1080_(p.choice("velocityUnit") == "px1080"),
          unjitter_(p.flag("unjitter")) {}
    // current(color, velocity, done) fills both with the current frame, and calls `done` as rows are complete. Mixes it
    // with the previous one and keeps it for the next.
    template <class Current>
    void resolve(const Frame& frame, bool debug, const Exec& exec, Rgb& out, const Current& current) {
        history_.begin(frame, method_);
        if (debug) weight_ = PlaneF(frame.width, frame.height);
        Rgb &color = color_.next(), &velocity = velocity_.next();
        const auto fn = rowsOf(smaaTemporalKernelsFor(exec).resolve, exec.precision);
        if (unjitter_) {
            current(color, velocity, Smaa::RowsDone());
            color.fillBorder();
            const auto unjittered = unjittered_.take();
            temporal::unjitter(color, frame.jitterPx, exec, *unjittered);
            std::swap(color, *unjittered);
            runKernel(smaaTemporalKernelsFor(exec).resolve, exec, argsOf(frame, debug, out), frame.height);
        } else {
            const SmaaTemporalArgs args = argsOf(frame, debug, out);
            current(color, velocity, [&](int y0, int y1) { fn(args, y0, y1); });
        }
        history_.end();
    }
    size_t bytes() const { return history_.bytes() + unjittered_.bytes(); }
    DebugLayer debugLayer() const { return {"weight.previous", {weight_}}; }

  private:
    SmaaTemporalArgs argsOf(const Frame& frame, bool debug, Rgb& out) {
        const Rgb &current = color_.next(), &velocity = velocity_.next();
        const bool first = history_.fresh();
        const Rgb& previous = first ? current : color_.previous();
        const Rgb& previousVelocity = first ? velocity : velocity_.previous();
        return {view(current),
                view(previous),
                velocity.c[0].row(0),
                velocity.c[1].row(0),
                frame.motionXPx.row(0),
                frame.motionYPx.row(0),
                previousVelocity.c[0].row(0),
                previousVelocity.c[1].row(0),
                pixels1080_ ? 1.0f / 1080 : 1.0f / float(frame.width),
                pixels1080_ ? 1.0f / 1080 : 1.0f / float(frame.height),
                rejection_,
                reproject_ && !first,
                view(out),
                debug ? weight_.row(0) : nullptr,
                out.stride(),
                frame.width,
                frame.height};
    }

    std::string_view method_;
    float rejection_;
    bool reproject_, pixels1080_, unjitter_;
    History history_;
    Kept<Rgb> color_{history_}, velocity_{history_};  // velocity: two of the three planes
    Working<Rgb> unjittered_;
    PlaneF weight_;
};

class SmaaT2x : public Method {
  public:
    explicit SmaaT2x(const Params& p) : linear_(p.choice("blendSpace") == "linear"), smaa_(p), pair_("smaaT2x", p) {}
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        smaa_.keepDebugLayers = keepDebugLayers;
        smaa_.findEdges(frame, frame.colorEncoded, frame.jitterPx, exec);
        const Rgb* const images[] = {linear_ ? &frame.colorLinear : &frame.colorEncoded};
        pair_.resolve(frame, keepDebugLayers, exec, out, [&](Rgb& color, Rgb& velocity, const Smaa::RowsDone& done) {
            smaa_.blend(images, color, exec, motionInto(frame, velocity), done);
        });
    }
    size_t stateBytes() const override { return smaa_.bytes() + pair_.bytes(); }
    std::vector<DebugLayer> debugLayers() const override {
        if (!keepDebugLayers) return {};
        auto layers = smaa_.debugLayers();
        layers.push_back(pair_.debugLayer());
        return layers;
    }

  private:
    bool linear_;
    Smaa smaa_;
    VelocityWeightedPair pair_;
};

// As published: two sub-samples (2x) in frames whose jitter alternates (sequence `smaa4x`). From a shot with the 4x
// pattern frames alternate between two opposite ones of the four, which are nearly the same places without jitter.
class Smaa4x : public Method {
  public:
    Smaa4x(const Params& p, const ShotInfo& shot)
        : shot_(shot), samples_(smaa4xSamples(shot)), two_(p), pair_("smaa4x", p) {}
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const SmaaSamples& samples = samples_[frame.number % 2 == 0 ? 0 : 1];
        pair_.resolve(frame, keepDebugLayers, exec, out, [&](Rgb& color, Rgb& velocity, const Smaa::RowsDone& done) {
            two_.resolve(frame, shot_, samples, keepDebugLayers, exec, color, motionInto(frame, velocity), done);
        });
    }
    size_t stateBytes() const override { return two_.bytes() + pair_.bytes(); }
    std::vector<DebugLayer> debugLayers() const override {
        if (!keepDebugLayers) return {};
        auto layers = two_.debugLayers();
        layers.push_back(pair_.debugLayer());
        return layers;
    }

  private:
    ShotInfo shot_;
    std::array<SmaaSamples, 2> samples_;  // of even and of odd frames
    TwoSamples two_;
    VelocityWeightedPair pair_;
};

Space outputSpaceOf(const Params& p) { return p.choice("blendSpace") == "linear" ? Space::linear : Space::encoded; }

std::vector<ParamSpec> temporalParams() {
    auto params = smaaParams();
    params.push_back(temporal::unjitterParam(false, "conventions 7.0; the pair of places is the filter"));
    params.push_back(
        flagParam("reproject", true, "fetch the previous frame where the pixel was", "[Jimenez 2012, v2.8]"));
    params.push_back(realParam("rejection", "30", 0, 80, "K: how soon a difference in speed rejects the previous frame",
                               "[Jimenez 2012, v2.8]", "reproject=on"));
    params.push_back(choiceParam("velocityUnit", "uv", {"uv", "px1080"},
                                 "unit of that speed: the image's size, or 1080 px at any resolution",
                                 "[Stejmar n.d., eq 3.1]", "reproject=on"));
    return params;
}

}  // namespace

MethodDescriptor smaaS2xDescriptor() {
    return {.id = "smaaS2x",
            .title = "SMAA S2x",
            .family = "spatial",
            .summary = "SMAA 1x on each of two sub-samples, with the edges of each moved back, averaged.",
            .source = "[Jimenez 2012]",
            .passes = Pass::subsampleColor,
            .params = smaaParams(),
            .create = [](const Params& p, const ShotInfo& shot) { return std::make_unique<SmaaS2x>(p, shot); },
            .morePasses = smaaPasses,
            .outputSpace = outputSpaceOf,
            .reachPx = 66,
            .patterns = {"d3d2"}};
}

MethodDescriptor smaaT2xDescriptor() {
    return {.id = "smaaT2x",
            .title = "SMAA T2x",
            .family = "temporal",
            .summary = "SMAA 1x on jittered frames, mixed with the frame before where the speed agrees.",
            .source = "[Jimenez 2012]",
            .passes = Pass::color | Pass::motion,
            .input = Space::encoded,
            .temporal = true,
            .params = temporalParams(),
            .create = [](const Params& p, const ShotInfo&) { return std::make_unique<SmaaT2x>(p); },
            .morePasses = smaaPasses,
            .outputSpace = outputSpaceOf};
}

MethodDescriptor smaa4xDescriptor() {
    return {
        .id = "smaa4x",
        .title = "SMAA 4x",
        .family = "temporal",
        .summary = "SMAA S2x on two of four sub-samples per frame, mixed with the frame before where the speed agrees.",
        .source = "[Jimenez 2012]",
        .passes = Pass::subsampleColor | Pass::motion,
        .temporal = true,
        .params = temporalParams(),
        .create = [](const Params& p, const ShotInfo& shot) { return std::make_unique<Smaa4x>(p, shot); },
        .morePasses = smaaPasses,
        .outputSpace = outputSpaceOf,
        .patterns = {"d3d4", "d3d2"}};
}

}  // namespace aa
