#include "methods/temporal/karis.h"

#include <cmath>
#include <memory>

#include "methods/method.h"
#include "methods/temporal/temporal.h"

namespace aa {
namespace {

constexpr int kKarisRowsPerCall = 32;  // each converts two rows of its neighbours again

constexpr Choice<BoxKind> kBoxes[] = {
    {"minmax", BoxKind::minmax}, {"variance", BoxKind::variance}, {"intersection", BoxKind::intersection}};
constexpr Choice<HistoryConstraint> kKarisConstraints[] = {{"clipFiltered", HistoryConstraint::clipFiltered},
                                                           {"clipMean", HistoryConstraint::clipMean},
                                                           {"clamp", HistoryConstraint::clamp}};
constexpr Choice<AntiFlicker> kAntiFlickers[] = {
    {"none", AntiFlicker::none}, {"karis", AntiFlicker::karis}, {"falcor", AntiFlicker::falcor}};

class Karis : public Method {
  public:
    Karis(std::string_view id, const Params& params, bool pq) : id_(id), params_(params), pq_(pq) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const Params& p = params_;
        KarisArgs args{};
        args.in = temporal::frameView(frame, frame.colorLinear);
        if (p.flag("unjitter")) temporal::unjitter(frame, args.in);
        args.pq = pq_ ? &pqTables() : nullptr;
        args.in.out = view(out);
        history_.begin(frame, id_, args.in);
        args.in.feedbackCeiling = temporal::feedbackCeiling(p, history_.framesSinceReset());
        args.in.dilation = temporal::dilation(p);
        args.in.filter = temporal::historyFilter(p);
        args.alpha = p.realf("alpha");
        args.filtered = p.choice("filter") == "blackmanHarris";
        args.toneWeighted = p.choice("toneWeight") != "none";
        args.hdr4 = p.choice("toneWeight") == "hdr4";
        args.ycocg = p.flag("ycocg");
        args.inverseLuminance = p.flag("inverseLuminance");
        args.box = p.chosen("box", kBoxes);
        args.constraint = p.chosen("constraint", kKarisConstraints);
        args.neighbourhood = temporal::neighbourhood(p);
        args.gamma = p.realf("gamma");
        args.antiFlicker = p.chosen("antiFlicker", kAntiFlickers);
        karisFilter(args.in.jitterXPx, args.in.jitterYPx, args.filter);
        args.in.debug = debug_.begin(*this, frame.width, frame.height);
        temporal::runTemporal(karisKernelsFor(exec).resolve, exec, args, kKarisRowsPerCall, kKarisScratchRows);
        history_.end(temporal::historyStorage(p), exec);
    }
    size_t stateBytes() const override { return history_.bytes(); }
    const PlaneF* rejection() const override { return debug_.rejection(); }
    std::vector<DebugLayer> debugLayers() const override { return debug_.layers(); }

  private:
    static const PqTables& pqTables() {
        static const auto tables = [] {
            auto t = std::make_unique<PqTables>();
            karisKernelsFor(Exec{.precision = Precision::oracle}).fillPqTables(*t);
            return t;
        }();
        return *tables;
    }

    std::string_view id_;
    Params params_;
    bool pq_;
    ColourHistory history_;
    TemporalDebugLayers debug_;
};

// Defaults in which the four differ.
struct Preset {
    std::string_view id, title, summary, source, alpha, alphaSource, filter, toneWeight, ycocg, box, constraint,
        antiFlicker, inverseLuminance, dilation, history;
};

MethodDescriptor descriptor(const Preset& d) {
    const auto flag = [](std::string_view name, std::string_view def, std::string_view help, std::string_view source) {
        return flagParam(name, def == "on", help, source);
    };
    ParamSpec neighbourhood = temporal::neighbourhoodParam("rounded", "[Karis 2014]");
    neighbourhood.onlyWhen = "box=minmax|intersection";
    return {.id = d.id,
            .title = d.title,
            .family = "temporal",
            .summary = d.summary,
            .source = d.source,
            .passes = Pass::color | Pass::motion,
            .temporal = true,
            .params = {realParam("alpha", d.alpha, 0, 1, "weight of the current colour", d.alphaSource),
                       choiceParam("filter", d.filter, {"none", "blackmanHarris"},
                                   "filter of the current colour over 3x3, by distance to the pixel centre", d.source),
                       choiceParam("toneWeight", d.toneWeight, {"none", "inverse", "hdr4"},
                                   "weights within that filter: equal, 1/(1+Y), 4/(4+Y)", "decisions 45",
                                   "filter=blackmanHarris"),
                       flag("ycocg", d.ycocg, "colour box in YCoCg instead of RGB", d.source),
                       choiceParam("box", d.box, kBoxes, "colour box: bounds, mean -+ gamma sigma, both", d.source),
                       realParam("gamma", "1", 0, 8, "half width of the variance box in standard deviations",
                                 "[Salvi 2016]: 0.75 to 1.25", "box=variance|intersection"),
                       neighbourhood,
                       choiceParam("constraint", d.constraint, kKarisConstraints,
                                   "history to the box: clipped toward the current colour or the mean, or clamped",
                                   d.source),
                       choiceParam("antiFlicker", d.antiFlicker, kAntiFlickers, "rule that adapts alpha",
                                   "Unreal Engine 4's public shader; [Falcor 2022]"),
                       flag("inverseLuminance", d.inverseLuminance, "blend with weights 1/(1+Y)", d.source),
                       temporal::unjitterParam(false, "conventions 7.0; not in the source"),
                       temporal::dilationParam(d.dilation, d.source), temporal::historyFilterParam(d.history, d.source),
                       temporal::historyClampParam(), temporal::warmupParam(),
                       temporal::historyBitsParam(Space::linear), temporal::ditherParam(Space::linear)},
            .create = [id = d.id, pq = d.id == "donut"](const Params& p,
                                                        const ShotInfo&) { return std::make_unique<Karis>(id, p, pq); },
            .morePasses = temporal::dilationPasses};
}
}  // namespace

void karisFilter(float jitterXPx, float jitterYPx, float (&filter)[9]) {
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            const double dx = i + double(jitterXPx), dy = j + double(jitterYPx);
            filter[(j + 1) * 3 + i + 1] = float(std::exp(-2.29 * (dx * dx + dy * dy)));  // [Karis 2014]
        }
}

MethodDescriptor karisDescriptor() {
    return descriptor({"karis", "UE4 TAA (Karis)",
                       "Tone-weighted filter of the current frame, YCoCg clip, anti-flicker.", "[Karis 2014]", "0.04",
                       "[Karis 2014]: N_eff 49", "blackmanHarris", "inverse", "on", "minmax", "clipFiltered", "karis",
                       "on", "closestX", "bilinear"});
}
MethodDescriptor salviDescriptor() {
    return descriptor({"salvi", "Variance clipping (Salvi)",
                       "Karis's skeleton with a box of mean and standard deviation.", "[Salvi 2016]", "0.1",
                       "ours: N_eff 19", "blackmanHarris", "inverse", "off", "variance", "clipMean", "none", "on",
                       "closest3x3", "bilinear"});
}
MethodDescriptor falcorDescriptor() {
    return descriptor({"falcor", "Falcor TAA", "Variance clamp in YCoCg, longest motion, Catmull-Rom history.",
                       "[Falcor 2022]", "0.1", "[Falcor 2022]", "none", "none", "on", "variance", "clamp", "falcor",
                       "off", "longest3x3", "catmullRom5"});
}
MethodDescriptor donutDescriptor() {
    return descriptor({"donut", "Donut TAA", "PQ-encoded values clamped to mean and standard deviation.",
                       "[Donut 2021]", "0.1", "[Donut 2021], at native resolution", "none", "none", "off", "variance",
                       "clamp", "none", "off", "longest3x3", "catmullRom5"});
}
}  // namespace aa
