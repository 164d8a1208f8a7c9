#include "methods/temporal/uncharted.h"

#include "methods/method.h"
#include "methods/temporal/temporal.h"

namespace aa {
namespace {

class Uncharted : public Method {
  public:
    explicit Uncharted(const Params& params) : params_(params), sharpen_(temporal::sharpenKernel(params)) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        UnchartedArgs args{temporal::frameView(frame, frame.colorEncoded),
                           params_.realf("kmin"),
                           params_.realf("kmax"),
                           temporal::neighbourhood(params_),
                           temporal::clipTarget(params_),
                           temporal::luminance(params_)};
        if (params_.flag("unjitter")) temporal::unjitter(frame, args.in);
        if (sharpen_ == SharpenKernel::none) args.in.out = view(out);
        history_.begin(frame, "uncharted", args.in);
        args.in.feedbackCeiling = temporal::feedbackCeiling(params_, history_.framesSinceReset());
        args.in.dilation = temporal::dilation(params_);
        args.in.filter = temporal::historyFilter(params_);
        args.in.debug = debug_.begin(*this, frame.width, frame.height);
        temporal::runTemporal(unchartedKernelsFor(exec).resolve, exec, args);
        history_.end(temporal::historyStorage(params_), exec);
        if (sharpen_ != SharpenKernel::none) sharpenEncoded(history_.latest(), sharpen_, exec, out);
    }
    size_t stateBytes() const override { return history_.bytes(); }
    const PlaneF* rejection() const override { return debug_.rejection(); }
    std::vector<DebugLayer> debugLayers() const override { return debug_.layers(); }

  private:
    Params params_;
    SharpenKernel sharpen_;
    ColourHistory history_;
    TemporalDebugLayers debug_;
};

MethodDescriptor descriptor(std::string_view id, std::string_view title, std::string_view summary,
                            std::string_view sharpen, std::string_view sharpenSource) {
    return {.id = id,
            .title = title,
            .family = "temporal",
            .summary = summary,
            .source = "[Oliveros 2018, 3.6], after [Xu 2016] and [Pedersen 2016]",
            .passes = Pass::color | Pass::motion,
            .input = Space::encoded,
            .output = Space::encoded,
            .temporal = true,
            .params = {temporal::unjitterParam(true, "[Oliveros 2018, appendix B]; decisions 15"),
                       temporal::kMinParam("0.925", "[Oliveros 2018, program]; decisions 5"),
                       temporal::kMaxParam("0.979", "[Oliveros 2018, program]; decisions 5"),
                       temporal::luminanceParam("quarter", "[Oliveros 2018, program]; decisions 9"),
                       temporal::sharpenParam(sharpen, sharpenSource),
                       temporal::dilationParam("closest3x3", "[Oliveros 2018, 3.6.3]"),
                       temporal::historyFilterParam("bilinear", "conventions 7.1"), temporal::historyClampParam(),
                       temporal::neighbourhoodParam("rounded", "[Oliveros 2018, 3.6.3]"),
                       temporal::clipTargetParam("aabbCentre", "decisions 6"), temporal::warmupParam(),
                       temporal::historyBitsParam(Space::encoded), temporal::ditherParam(Space::encoded)},
            .create =
                [id](const Params& p, const ShotInfo&) {
                    temporal::requireOrdered(id, p);
                    return std::make_unique<Uncharted>(p);
                },
            .morePasses = temporal::dilationPasses};
}
}  // namespace

MethodDescriptor unchartedDescriptor() {
    return descriptor("uncharted", "Uncharted TAA",
                      "Clipped and luminance-weighted history, sharpened with Xu's kernel as in the thesis.", "xu",
                      "[Oliveros 2018, eq 3.1]");
}
MethodDescriptor unchartedNormDescriptor() {
    return descriptor("unchartedNorm", "Uncharted TAA, normalised sharpening",
                      "As uncharted, sharpened with a quarter of the gain: the fair baseline.", "norm",
                      "[Oliveros 2018, eq 4.17, table 5.1]");
}
MethodDescriptor unchartedNoSharpenDescriptor() {
    return descriptor("unchartedNoSharpen", "Uncharted TAA, not sharpened",
                      "As uncharted without its sharpening: what the temporal part alone does.", "none",
                      "ours: what the temporal part alone does");
}
}  // namespace aa
