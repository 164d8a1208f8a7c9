#include "methods/temporal/inside.h"

#include "methods/method.h"
#include "methods/temporal/temporal.h"

namespace aa {
namespace {

constexpr Choice<InsideNeighbourhood> kNeighbourhoods[] = {{"rounded", InsideNeighbourhood::rounded},
                                                           {"3x3", InsideNeighbourhood::box3x3},
                                                           {"plus", InsideNeighbourhood::plus},
                                                           {"4tapVarying", InsideNeighbourhood::fourTapVarying}};

class Inside : public Method {
  public:
    explicit Inside(const Params& params) : params_(params) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const Params& p = params_;
        InsideArgs args{temporal::frameView(frame, frame.colorEncoded),
                        p.realf("kmin"),
                        p.realf("kmax"),
                        p.chosen("neighbourhood", kNeighbourhoods),
                        temporal::clipTarget(p),
                        p.flag("unjitterColor"),
                        p.flag("unjitterNeighbourhood"),
                        temporal::dilation(p) == Dilation::none && p.flag("unjitterReprojection"),
                        p.flag("ycocg"),
                        temporal::luminance(p),
                        p.realf("motionBlur"),
                        uint32_t(frame.number)};
        args.in.out = view(out);
        history_.begin(frame, "inside", args.in);
        args.in.feedbackCeiling = temporal::feedbackCeiling(p, history_.framesSinceReset());
        args.in.dilation = temporal::dilation(p);
        args.in.filter = temporal::historyFilter(p);
        args.in.clampOutside = p.choice("outside") == "clamp";
        args.in.debug = debug_.begin(*this, frame.width, frame.height);
        runKernel(insideKernelsFor(exec).resolve, exec, args, frame.height);
        history_.end(temporal::historyStorage(p), exec);
    }
    size_t stateBytes() const override { return history_.bytes(); }
    const PlaneF* rejection() const override { return debug_.rejection(); }
    std::vector<DebugLayer> debugLayers() const override { return debug_.layers(); }

  private:
    Params params_;
    ColourHistory history_;
    TemporalDebugLayers debug_;
};
}  // namespace

MethodDescriptor insideDescriptor() {
    return {
        .id = "inside",
        .title = "INSIDE TRAA",
        .family = "temporal",
        .summary = "Un-jittered current colour, rounded colour box, clip, feedback by luminance difference.",
        .source = "[Pedersen 2016]",
        .passes = Pass::color | Pass::motion,
        .input = Space::encoded,
        .output = Space::encoded,
        .temporal = true,
        .params = {temporal::kMinParam("0.88", "[Pedersen 2016]"), temporal::kMaxParam("0.97", "[Pedersen 2016]"),
                   choiceParam("neighbourhood", "rounded", kNeighbourhoods,
                               "window of the colour box; 4tapVarying: bilinear taps, tighter under motion",
                               "[Pedersen 2016]"),
                   flagParam("unjitterColor", true, "fetch the current colour at the pixel centre", "[Pedersen 2016]"),
                   flagParam("unjitterNeighbourhood", false, "fetch the colour box there too", "[Pedersen 2016]"),
                   flagParam("unjitterReprojection", false, "fetch the motion there too", "[Pedersen 2016]",
                             "dilation=none"),
                   flagParam("ycocg", false, "work in YCoCg", "[Pedersen 2016]: not in the shipped game"),
                   temporal::luminanceParam("bt709", "ours; inside: [Pedersen 2016, source]", "ycocg=off"),
                   temporal::clipTargetParam("aabbCentre", "[Pedersen 2016]"),
                   temporal::dilationParam("closest3x3", "[Pedersen 2016]"),
                   temporal::historyFilterParam("bilinear", "[Pedersen 2016]"), temporal::historyClampParam(),
                   temporal::outsideParam(),
                   realParam("motionBlur", "0", 0, 16,
                             "length of the blur of what moves by more than 2 px, in frame intervals; the history "
                             "stays sharp; 0 = off, as the truth is an instant",
                             "[Pedersen 2016]"),
                   temporal::warmupParam(), temporal::historyBitsParam(Space::encoded),
                   temporal::ditherParam(Space::encoded)},
        .create =
            [](const Params& p, const ShotInfo&) {
                temporal::requireOrdered("inside", p);
                return std::make_unique<Inside>(p);
            },
        .morePasses =
            [](const Params& p) {
                return p.choice("neighbourhood") == "4tapVarying" ? PassSet(Pass::depth) : temporal::dilationPasses(p);
            }};
}
}  // namespace aa
