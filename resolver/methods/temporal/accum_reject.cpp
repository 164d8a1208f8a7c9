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
        if (p.flag("unjitter")) temporal::unjitter(frame, args.in);
        args.in.out = view(out);
        history_.begin(frame, "accumReject", args.in);
        args.in.dilation = temporal::dilation(p);
        args.in.filter = temporal::historyFilter(p);
        args.in.debug = debug_.begin(*this, frame.width, frame.height);
        if (keepDebugLayers) {
            if (count_.width() != frame.width || count_.height() != frame.height)
                count_ = PlaneF(frame.width, frame.height);
            args.debugCount = count_.row(0);
        }
        if (residual_[0].width() != frame.width || residual_[0].height() != frame.height) {
            for (auto& plane : residual_) plane = RgbaPlane(frame.width, frame.height);
            farthest_ = PlaneF(frame.width, frame.height);
        }
        args.residual = residual_[0].row(0);
        args.nextResidual = residual_[1].row(0);
        args.previousFarthest = farthest_.row(0);
        if (p.flag("objectIds") && args.in.history) {
            args.objectId = frame.objectId.row(0);
            args.previousId = previousId_.row(0);
        }
        args.expected = expectedDepth(frame);
        if (p.flag("unjitter")) {
            const glm::ivec2 texel = temporal::unjitteredTexel(frame);
            args.expected = temporal::moved(args.expected, texel);
            if (args.objectId) args.objectId += ptrdiff_t(texel.y) * args.in.stride + texel.x;
        }
        args.depthTest = test_;
        args.rejection = temporal::rejectionTest(p);
        args.nMaxStatic = p.realf("nMaxStatic");
        args.nMaxMoving = p.realf("nMaxMoving");
        temporal::runTemporal(kernels.resolve, exec, args);

        history_.end({}, exec);
        std::swap(residual_[0], residual_[1]);
        residual_[0].fillBorder();
        if (p.flag("objectIds")) previousId_ = frame.objectId;
        if (test_ == DepthTest::window) {
            const DilateMaxArgs d{args.in.depthView, farthest_.row(0), farthest_.stride(), frame.width};
            runKernel(kernels.farthest, exec, d, frame.height);
            farthest_.fillBorder();
        }
    }
    size_t stateBytes() const override {
        return history_.bytes() + residual_[0].bytes() + residual_[1].bytes() + farthest_.bytes() + previousId_.bytes();
    }
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
    RgbaPlane residual_[2];
    PlaneF farthest_;  // of the previous frame
    PlaneU previousId_;
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
