#include "methods/temporal/t2msaa.h"

#include <utility>

#include "image/error.h"
#include "methods/method.h"
#include "methods/temporal/temporal.h"
#include "methods/working.h"

namespace aa {
namespace {

class T2msaa : public Method {
  public:
    explicit T2msaa(const Params& params) : params_(params), offsetPx_(params.real("offset")) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const Params& p = params_;
        T2msaaArgs args{};
        args.in = temporal::frameView(frame, frame.colorLinear);
        args.in.out = view(out);
        history_.begin(frame, "t2msaa", args.in);
        const auto pair = t2msaaSamples(frame, offsetPx_, history_.framesSinceReset());
        const std::array unjittered{unjittered_[0].take(), unjittered_[1].take()};
        for (size_t i = 0; i < 2; i++) {
            const SubSample& s = frame.subSamples[pair[i]];
            args.sample[i] = view(s.colorLinear);
            args.sampleDepth[i] = s.depthView.row(0);
            if (!p.flag("unjitter")) continue;
            // Their mean lies here from the pixel's centre.
            const auto& at = frame.subSamplePositionsPx;
            const glm::dvec2 placePx = frame.jitterPx + 0.5 * (at[pair[0]] + at[pair[1]]);
            temporal::unjitter(s.colorLinear, placePx, exec, *unjittered[i]);
            args.sample[i] = view(std::as_const(*unjittered[i]));
            const glm::ivec2 texel = temporal::unjitteredTexel(frame);
            args.sampleDepth[i] += ptrdiff_t(texel.y) * args.in.stride + texel.x;
        }
        if (p.flag("unjitter")) temporal::unjitter(frame, args.in);
        args.previousCount = count_.previous().row(0);
        args.nextCount = count_.next().row(0);
        args.expected = expectedDepth(frame);
        args.encoded = p.choice("space") == "encoded";
        args.display = displayArgs(frame.display);
        args.fractionalVelocity = p.choice("velocity") == "fractional";
        args.countAtPixel = temporal::countAtPixel(p);
        args.rejection = temporal::rejectionTest(p);
        args.in.debug = debug_.begin(*this, frame.width, frame.height);
        runKernel(t2msaaKernelsFor(exec).resolve, exec, args, frame.height);
        history_.end({}, exec);
    }
    size_t stateBytes() const override { return history_.bytes() + unjittered_[0].bytes() + unjittered_[1].bytes(); }
    const PlaneF* rejection() const override { return debug_.rejection(); }
    std::vector<DebugLayer> debugLayers() const override {
        std::vector<DebugLayer> layers = debug_.layers();
        if (!layers.empty()) layers.push_back({"sampleCount", {count_.latest()}});
        return layers;
    }

  private:
    Params params_;
    double offsetPx_;
    ColourHistory history_;
    Kept<PlaneF> count_{history_};
    Working<Rgb> unjittered_[2];
    TemporalDebugLayers debug_;
};

MethodDescriptor t2msaa() {
    MethodDescriptor d;
    d.id = "t2msaa";
    d.title = "Temporal 2x MSAA";
    d.family = "temporal";
    d.summary = "Two sub-samples a frame at alternating places, accumulated along the motion with rejection by depth.";
    d.source = "[Stejmar n.d., 4.4.2]";
    d.passes = Pass::color | Pass::motion | Pass::subsampleDepth | Pass::subsampleColor;
    d.output = Space::encoded;
    d.outputSpace = [](const Params& p) { return p.choice("space") == "encoded" ? Space::encoded : Space::linear; };
    d.temporal = true;
    d.publishedMemory = {{0, 67.2, "[Stejmar n.d., table 5.6]"}};
    d.params = {
        temporal::unjitterParam(false, "conventions 7.0; the shift between frames is the filter"),
        realParam("offset", "0.25", 0.0625, 0.375,
                  "shift of the two samples between frames, px; the thesis has 0.25, 0.1875, 0.125; chooses among more "
                  "than two recorded sub-samples, where there are two the shot's jitter has shifted them",
                  "[Stejmar n.d., tables 5.17-5.20]"),
        choiceParam("velocity", "uv", {"uv", "fractional"},
                    "velocity in the blur limit: in UV as listed, or the fraction of a pixel", "decisions 20"),
        temporal::countAtParam("[Stejmar n.d., 4.4.2]"),
        temporal::depthToleranceParam(),
        temporal::bothSidesParam(),
        temporal::magnificationParam("1", "[Stejmar n.d., figures 4.10 and 4.11]; decisions 18"),
        choiceParam("space", "encoded", {"encoded", "linear"}, "space of the blend",
                    "[Stejmar n.d.]: 8-bit buffers; conventions 4")};
    d.create = [](const Params& p, const ShotInfo& shot) -> std::unique_ptr<Method> {
        if (shot.subSamplePositionsPx.size() < 2)
            throw InputError("t2msaa: expected at least 2 sub-samples a pixel, found " +
                             std::to_string(shot.subSamplePositionsPx.size()) + "; export the shot with sub-samples");
        if (shot.subSamplePositionsPx.size() == 2 && p.isGiven("offset"))
            throw UsageError(
                "t2msaa: parameter 'offset' has no effect on a shot with exactly 2 sub-samples, which are taken as "
                "rendered: its jitter has shifted them; leave it out, or export the shot with more sub-samples");
        return std::make_unique<T2msaa>(p);
    };
    return d;
}
}  // namespace

std::array<size_t, 2> t2msaaSamples(const Frame& frame, double offsetPx, int framesSinceReset) {
    if (frame.subSamples.size() == 2) return {0, 1};
    const double d = framesSinceReset % 2 ? -offsetPx : offsetPx;
    std::array<size_t, 2> chosen{};
    for (size_t i = 0; i < 2; i++) {
        const glm::dvec2 base(i == 0 ? 0.25 : -0.25), wanted = base + glm::dvec2(d, -d);
        double nearest = 1e9;
        for (size_t k = 0; k < frame.subSamplePositionsPx.size(); k++) {
            const glm::dvec2 e = frame.jitterPx + frame.subSamplePositionsPx[k] - wanted;
            const double distance = e.x * e.x + e.y * e.y;
            if (distance < nearest && !(i == 1 && k == chosen[0])) nearest = distance, chosen[i] = k;
        }
    }
    return chosen;
}

MethodDescriptor t2msaaDescriptor() { return t2msaa(); }
}  // namespace aa
