#include "methods/temporal/taa_simplest.h"

#include "methods/method.h"
#include "methods/temporal/temporal.h"

namespace aa {
namespace {

class TaaSimplest : public Method {
  public:
    explicit TaaSimplest(const Params& params) : params_(params) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        TaaSimplestArgs args{temporal::frameView(frame, frame.colorLinear), params_.realf("k")};
        if (params_.flag("unjitter")) temporal::unjitter(frame, args.in);
        args.in.out = view(out);
        history_.begin(frame, "taaSimplest", args.in);
        args.in.feedbackCeiling = temporal::feedbackCeiling(params_, history_.framesSinceReset());
        args.in.filter = temporal::historyFilter(params_);
        args.in.clampOutside = params_.choice("outside") == "clamp";
        args.in.debug = debug_.begin(*this, frame.width, frame.height);
        temporal::runTemporal(taaSimplestKernelsFor(exec).resolve, exec, args);
        history_.end(temporal::historyStorage(params_), exec);
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

MethodDescriptor taaSimplestDescriptor() {
    return {.id = "taaSimplest",
            .title = "Simplest TAA",
            .family = "temporal",
            .summary = "Exponential blend with the reprojected history, without any rejection.",
            .source = "[Castorina 2023]",
            .passes = Pass::color | Pass::motion,
            .temporal = true,
            .params = {realParam("k", "0.9", 0, 1, "weight of history", "[Castorina 2023]: \"normally around 0.9\""),
                       temporal::unjitterParam(false, "conventions 7.0; not in the source"),
                       temporal::historyFilterParam("bilinear", "[Castorina 2023]"), temporal::historyClampParam(),
                       temporal::outsideParam(), temporal::warmupParam(), temporal::historyBitsParam(Space::linear),
                       temporal::ditherParam(Space::linear)},
            .create = [](const Params& p, const ShotInfo&) { return std::make_unique<TaaSimplest>(p); }};
}
}  // namespace aa
