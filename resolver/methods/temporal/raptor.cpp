#include "methods/temporal/raptor.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "methods/method.h"
#include "methods/sharpen.h"
#include "methods/temporal/temporal.h"
#include "methods/working.h"

namespace aa {
namespace {

// [Mitchell 1988], x >= 0, zero from 2 on.
double cubic(double x, double b, double c) {
    if (x < 1) return ((12 - 9 * b - 6 * c) * x * x * x + (-18 + 12 * b + 6 * c) * x * x + (6 - 2 * b)) / 6;
    if (x < 2)
        return ((-b - 6 * c) * x * x * x + (6 * b + 30 * c) * x * x + (-12 * b - 48 * c) * x + 8 * b + 24 * c) / 6;
    return 0;
}
// Blackman-Harris window centred at 0, first zero at 1; periodic beyond as printed.
double blackmanHarris(double x) {
    const double t = std::numbers::pi * x;
    return 0.35875 + 0.48829 * std::cos(t) + 0.14128 * std::cos(2 * t) + 0.01168 * std::cos(3 * t);
}
constexpr Choice<RaptorConstraint> kRaptorConstraints[] = {{"none", RaptorConstraint::none},
                                                           {"clamp", RaptorConstraint::clamp},
                                                           {"clip", RaptorConstraint::clip},
                                                           {"varianceClip", RaptorConstraint::varianceClip},
                                                           {"varianceClipClamp", RaptorConstraint::varianceClipClamp}};
constexpr Choice<LuminanceDifference> kLuminanceDifferences[] = {{"off", LuminanceDifference::off},
                                                                 {"corrected", LuminanceDifference::corrected},
                                                                 {"printed", LuminanceDifference::printed}};
enum class CurrentFilter { none, mitchell, blackmanHarris, catmullRom };
constexpr Choice<CurrentFilter> kCurrentFilters[] = {{"none", CurrentFilter::none},
                                                     {"mitchell", CurrentFilter::mitchell},
                                                     {"blackmanHarris", CurrentFilter::blackmanHarris},
                                                     {"catmullRom", CurrentFilter::catmullRom}};
double filterWeight(CurrentFilter filter, bool printed, double dx, double dy, glm::dvec2 jitterPx) {
    // printed: distance of the pixels, doubled; fixed: distance of the sample from the pixel centre, radius 1.5 px.
    const double distance = printed ? std::hypot(dx, dy) : std::hypot(dx + jitterPx.x, dy + jitterPx.y);
    const double argument = printed ? 2 * distance : distance * 2 / 1.5;
    switch (filter) {
        case CurrentFilter::none:
            return printed ? distance : dx == 0 && dy == 0;
        case CurrentFilter::mitchell:
            return cubic(argument, 1.0 / 3, 1.0 / 3);
        case CurrentFilter::catmullRom:
            return cubic(argument, 0, 0.5);
        case CurrentFilter::blackmanHarris:
            return printed ? blackmanHarris(argument) : argument < 2 ? blackmanHarris(argument / 2) : 0;
    }
    return 0;
}

class Raptor : public Method {
  public:
    explicit Raptor(const Params& params) : params_(params) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const Params& p = params_;
        const float sharpen = p.realf("sharpen");
        const auto unsharpened = blend_.take();
        if (sharpen > 0) *unsharpened = Rgb::unset(frame.width, frame.height);
        Rgb& blend = sharpen > 0 ? *unsharpened : out;
        RaptorArgs args{};
        args.in = temporal::frameView(frame, frame.colorLinear);
        if (p.flag("unjitter")) temporal::unjitter(frame, args.in);
        args.in.out = view(blend);
        history_.begin(frame, "raptor", args.in);
        args.in.feedbackCeiling = temporal::feedbackCeiling(p, history_.framesSinceReset());
        args.in.dilation = temporal::dilation(p);
        args.in.filter = temporal::historyFilter(p);
        const auto filter = raptorFilter(p, args.in.jitterXPx, args.in.jitterYPx);
        std::copy(filter.begin(), filter.end(), args.filter);
        args.constraint = p.chosen("constraint", kRaptorConstraints);
        args.luminanceDifference = p.chosen("lumaDiff", kLuminanceDifferences);
        args.temporalFiltering = p.flag("temporalFiltering");
        args.luminanceWeights = p.flag(p.choice("lumaDiff") == "off" ? "inverseLuminance" : "lumaDiffWeights");
        args.clampCurrent = p.flag("currentClamp");
        args.signedDivisor = p.choice("contrastDivisor") == "printed";
        args.ycocg = p.flag("ycocg");
        args.gamma = p.realf("gamma");
        args.kMin = p.realf("kmin"), args.kMax = p.realf("kmax");
        args.in.debug = debug_.begin(*this, frame.width, frame.height);
        temporal::runTemporal(raptorKernelsFor(exec).resolve, exec, args);
        history_.end(temporal::historyStorage(p), exec);
        if (sharpen > 0) {
            blend.fillBorder();
            sharpenLuma(blend, sharpen, exec, out);
        }
    }
    size_t stateBytes() const override { return history_.bytes() + blend_.bytes(); }
    const PlaneF* rejection() const override { return debug_.rejection(); }
    std::vector<DebugLayer> debugLayers() const override { return debug_.layers(); }

  private:
    Params params_;
    ColourHistory history_;
    Working<Rgb> blend_;  // before sharpening
    TemporalDebugLayers debug_;
};
}  // namespace

std::array<float, 9> raptorFilter(const Params& params, float jitterXPx, float jitterYPx) {
    const CurrentFilter filter = params.chosen("currentFilter", kCurrentFilters);
    const bool printed = params.choice("filterDomain") == "printed";
    std::array<float, 9> weights;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            weights[size_t((j + 1) * 3 + i + 1)] = float(filterWeight(filter, printed, i, j, {jitterXPx, jitterYPx}));
    return weights;
}

MethodDescriptor raptorDescriptor() {
    return {
        .id = "raptor",
        .title = "Full TAA of the Vulkan book",
        .family = "temporal",
        .summary =
            "Closest-depth motion, Catmull-Rom history, clamped variance clip, three adaptive weights, sharpening.",
        .source = "[Castorina 2023]",
        .passes = Pass::color | Pass::motion,
        .temporal = true,
        .params = {temporal::unjitterParam(false, "conventions 7.0; not in the source"),
                   temporal::dilationParam("closest3x3", "[Castorina 2023]"),
                   temporal::historyFilterParam("catmullRom", "[Castorina 2023]"),
                   temporal::historyClampParam(),
                   choiceParam("constraint", "varianceClipClamp", kRaptorConstraints,
                               "how history is held to the 3x3 window's colours", "[Castorina 2023]"),
                   realParam("gamma", "1", 0, 8, "half width of the variance box in standard deviations",
                             "[Castorina 2023]", "constraint=varianceClip|varianceClipClamp"),
                   choiceParam("currentFilter", "mitchell", kCurrentFilters, "filter of the current colour over 3x3",
                               "[Castorina 2023]"),
                   choiceParam("filterDomain", "fixed", {"fixed", "printed"},
                               "distance under that filter: of the sample from the pixel centre, radius 1.5 px; or as "
                               "printed",
                               "decisions 26"),
                   flagParam("currentClamp", true,
                             "hold that filter's result within the window's bounds: negative lobes overshoot them; off "
                             "as in the book, whose printed domain has no such lobes",
                             "ours", "filterDomain=fixed"),
                   flagParam("temporalFiltering", true, "more history where the window has contrast",
                             "[Castorina 2023]", "lumaDiff=off"),
                   choiceParam("contrastDivisor", "guarded", {"guarded", "printed"},
                               "what temporalFiltering divides the contrast by: the colour, at least 1e-4; or the "
                               "colour as printed, with the sign of chroma in YCoCg",
                               "decisions 29", "temporalFiltering=on"),
                   flagParam("inverseLuminance", true, "weights 1/(1+L) of compressed colours", "[Castorina 2023]",
                             "lumaDiff=off"),
                   choiceParam("lumaDiff", "corrected", kLuminanceDifferences,
                               "weight from the luminance difference; printed has history and current exchanged",
                               "decisions 25"),
                   flagParam("lumaDiffWeights", true,
                             "weights 1/(1+L) with the luminance difference, too, as the book has them; off is ours",
                             "[Castorina 2023]", "lumaDiff=corrected|printed"),
                   realParam("kmin", "0.88", 0, 1, "weight of history where its luminance differs most",
                             "[Pedersen 2016]", "lumaDiff=corrected"),
                   realParam("kmax", "0.97", 0, 1, "weight of history where its luminance is equal", "[Pedersen 2016]",
                             "lumaDiff=corrected"),
                   flagParam("ycocg", false, "work in YCoCg", "[Castorina 2023]"),
                   realParam("sharpen", "1", 0, 4, "luminance sharpening of the output, never fed back; 0 = none",
                             "[Castorina 2023]: 1 is standard; its program has 0.1 (decisions 30)"),
                   temporal::warmupParam(),
                   temporal::historyBitsParam(Space::linear),
                   temporal::ditherParam(Space::linear)},
        .create =
            [](const Params& p, const ShotInfo&) {
                temporal::requireOrdered("raptor", p);
                return std::make_unique<Raptor>(p);
            },
        .morePasses = temporal::dilationPasses};
}
}  // namespace aa
