#include "methods/temporal/accum_reject.h"

#include "methods/method.h"
#include "methods/temporal/temporal.h"

namespace aa {
namespace {

constexpr Choice<DepthTest> kDepthTests[] = {
    {"window", DepthTest::window}, {"point", DepthTest::point}, {"off", DepthTest::off}};

class AccumReject : public Method {
  public:
    explicit AccumReject(const Params& params) : params_(params), test_(params.chosen("depthTest", kDepthTests)) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const Params& p = params_;
        const AccumRejectKernels& kernels = accumRejectKernelsFor(exec);
        AccumRejectArgs args{};
        args.in = temporal::frameView(frame, frame.colorLinear);
        args.in.out = view(out);
        history_.begin(frame, "accumReject", args.in);
        args.expected = expectedDepth(frame);
        if (p.flag("objectIds") && args.in.history) {
            args.objectId = frame.objectId.row(0);
            args.previousId = id_.previous().row(0);
        }
        if (p.flag("unjitter")) temporal::unjitter(frame, args.in, args.expected, args.objectId);
        args.in.dilation = temporal::dilation(p);
        args.in.filter = temporal::historyFilter(p);
        args.in.debug = debug_.begin(*this, frame.width, frame.height);
        if (keepDebugLayers) args.debugCount = fitted(count_, frame.width, frame.height).row(0);
        args.residual = residual_.previous().row(0);
        args.nextResidual = residual_.next().row(0);
        args.previousFarthest = farthest_.previous().row(0);
        args.depthTest = test_;
        args.rejection = temporal::rejectionTest(p);
        args.nMaxStatic = p.realf("nMaxStatic");
        args.nMaxMoving = p.realf("nMaxMoving");
        temporal::runTemporal(kernels.resolve, exec, args);

        if (p.flag("objectIds")) id_.inPlace() = frame.objectId;
        if (test_ == DepthTest::window) {
            PlaneF& farthest = farthest_.inPlace();
            const DilateMaxArgs d{args.in.depthView, farthest.row(0), farthest.stride(), frame.width};
            runKernel(kernels.farthest, exec, d, frame.height);
        }
        history_.end({}, exec);
    }
    size_t stateBytes() const override { return history_.bytes(); }
    const PlaneF* rejection() const override { return debug_.rejection(); }
    std::vector<DebugLayer> debugLayers() const override {
        std::vector<DebugLayer> layers = debug_.layers();
        if (!count_.empty()) layers.push_back({"sampleCount", {count_}});
        return layers;
    }

  private:
    Params params_;
    DepthTest test_;
    ColourHistory history_;
    Kept<RgbaPlane> residual_{history_};
    Kept<PlaneF> farthest_{history_};
    Kept<PlaneU> id_{history_};
    TemporalDebugLayers debug_;
    PlaneF count_;
};
}  // namespace

MethodDescriptor accumRejectDescriptor() {
    return {
        .id = "accumReject",
        .title = "Accumulation with rejection",
        .family = "temporal",
        .summary = "Running mean along the motion, restarted where depth or object id says that the surface is new.",
        .source = "after [Nehab 2007] and [Stejmar n.d., 3.6.2]; decisions 51",
        .passes = Pass::color | Pass::depth | Pass::motion,
        .temporal = true,
        .params = {choiceParam("depthTest", "window", kDepthTests,
                               "previous depth compared: interpolated point, but farthest of 3x3 for a pixel at rest "
                               "(window); the point alone; none",
                               "conventions 7.3; window: jitter moves silhouettes at rest"),
                   temporal::depthToleranceParam("depthTest=window|point"), temporal::bothSidesParam("depthTest=point"),
                   flagParam("objectIds", true, "reject where the previous 3x3 has no pixel of this object",
                             "conventions 7.3"),
                   temporal::magnificationParam("off", "off but in the methods of [Stejmar n.d.]"),
                   realParam("nMaxStatic", "100000", 1, 16777215, "most frames in the mean of a pixel at rest",
                             "decisions 51"),
                   realParam("nMaxMoving", "16", 1, 16777215, "most frames in the mean of a moving pixel",
                             "decisions 51"),
                   temporal::unjitterParam(false, "conventions 7.0"),
                   temporal::dilationParam("closest3x3", "conventions 7.2"),
                   temporal::historyFilterParam("bilinear", "decisions 51"), temporal::historyClampParam()},
        .create = [](const Params& p, const ShotInfo&) { return std::make_unique<AccumReject>(p); },
        .morePasses = [](const Params& p) { return p.flag("objectIds") ? PassSet(Pass::object) : PassSet{}; }};
}
}  // namespace aa
