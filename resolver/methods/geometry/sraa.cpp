#include "methods/geometry/sraa.h"

#include <cmath>

#include "methods/geometry/subsample_geometry.h"
#include "methods/method.h"

namespace aa {
namespace {

constexpr double kLog2E = 1.4426950408889634;

constexpr Choice<SraaIds> kIds[] = {{"off", SraaIds::off}, {"depth", SraaIds::depth}, {"always", SraaIds::always}};

}  // namespace

SraaArgs sraaArgs(const Params& p) {
    const auto exponent = [&](const char* sigma) { return float(kLog2E / (2 * p.real(sigma) * p.real(sigma))); };
    SraaArgs a{};
    a.radius = p.integer("radius");
    a.maxMetric = p.choice("metric") == "max", a.plainDepth = p.choice("distance") == "depth";
    a.ids = p.chosen("ids", kIds);
    a.spatial = exponent("sigmaX"), a.depth = exponent("sigmaZ"), a.normal = exponent("sigmaN");
    a.sharpness = float(p.real("sharpness") * kLog2E), a.depthSigma = p.realf("sigmaZ");
    return a;
}

GeometryNeeds sraaNeeds(const SraaArgs& args) {
    return {.normals = true, .ids = args.ids != SraaIds::off, .camera = !args.plainDepth};
}

namespace {
class Sraa : public Method {
  public:
    explicit Sraa(const Params& p) : args_(sraaArgs(p)) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const GeometryViews geometry(frame, sraaNeeds(args_), "sraa:distance=plane");
        SraaArgs a = args_;
        a.color = view(frame.colorLinear), a.out = view(out), a.geometry = &geometry.args();
        layers_.clear();
        if (keepDebugLayers) {
            layers_.push_back({"ownShare", {PlaneF(frame.width, frame.height)}});
            a.ownShareLayer = layers_[0].planes[0].row(0);
        }
        runKernel(sraaKernelsFor(exec).resolve, exec, a, frame.height);
    }
    std::vector<DebugLayer> debugLayers() const override { return layers_; }

  private:
    SraaArgs args_;
    std::vector<DebugLayer> layers_;
};

}  // namespace

MethodDescriptor sraaDescriptor() {
    return {
        .id = "sraa",
        .title = "Subpixel reconstruction anti-aliasing",
        .family = "geometry",
        .summary = "Reconstructs the colour of every sub-sample from the pixels around it with like geometry.",
        .source = "[Chajdas 2011]",
        .passes = Pass::color,
        .params = {intParam("radius", "1", 1, 2, "pixels around: 1 = 3x3, 2 = 5x5", "[Chajdas 2011]"),
                   choiceParam("metric", "product", {"product", "max"}, "how place, depth and normal are combined",
                               "[Chajdas 2011]"),
                   choiceParam("distance", "plane", {"plane", "depth"},
                               "from the sub-sample's tangent plane, or in depth", "ours"),
                   realParam("sigmaX", "0.5", 0.05, 10, "px", "decisions 43", "metric=product"),
                   realParam("sigmaZ", "0.02", 0.0001, 10, "relative to the depth", "decisions 43", "metric=product"),
                   realParam("sigmaN", "0.25", 0.001, 10, "of 1 - cosine", "decisions 43", "metric=product"),
                   realParam("sharpness", "50", 0.1, 10000, "T of the max metric", "public ports; decisions 43",
                             "metric=max"),
                   choiceParam("ids", "off", kIds, "other objects share nothing: those at another depth, or all",
                               "[Chajdas 2011]; depth and always are ours")},
        .create = [](const Params& p, const ShotInfo& shot) -> std::unique_ptr<Method> {
            requireSubSamples(shot.subSamplePositionsPx, "sraa", 64);
            return std::make_unique<Sraa>(p);
        },
        .morePasses = [](const Params& p) { return sraaNeeds(sraaArgs(p)).passes(); },
        .reachPx = 3};
}
}  // namespace aa
