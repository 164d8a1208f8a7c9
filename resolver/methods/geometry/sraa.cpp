#include "methods/geometry/sraa.h"

#include <cmath>

#include "methods/geometry/subsample_geometry.h"
#include "methods/method.h"

namespace aa {
namespace {

constexpr double kLog2E = 1.4426950408889634;

constexpr Choice<SraaIds> kIds[] = {{"off", SraaIds::off}, {"depth", SraaIds::depth}, {"always", SraaIds::always}};

class Sraa : public Method {
  public:
    explicit Sraa(const Params& p)
        : radius_(p.integer("radius")),
          max_(p.choice("metric") == "max"),
          plainDepth_(p.choice("distance") == "depth"),
          ids_(p.chosen("ids", kIds)),
          sigmaX_(p.real("sigmaX")),
          sigmaZ_(p.real("sigmaZ")),
          sigmaN_(p.real("sigmaN")),
          sharpness_(p.real("sharpness")) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const GeometryViews geometry(frame, {.normals = true, .ids = ids_ != SraaIds::off, .camera = !plainDepth_},
                                     "sraa:distance=plane");
        const auto exponent = [](double sigma) { return float(kLog2E / (2 * sigma * sigma)); };
        SraaArgs a{.color = view(frame.colorLinear),
                   .out = view(out),
                   .geometry = &geometry.args(),
                   .radius = radius_,
                   .maxMetric = max_,
                   .plainDepth = plainDepth_,
                   .ids = ids_,
                   .spatial = exponent(sigmaX_),
                   .depth = exponent(sigmaZ_),
                   .normal = exponent(sigmaN_),
                   .sharpness = float(sharpness_ * kLog2E),
                   .depthSigma = float(sigmaZ_),
                   .ownShareLayer = nullptr};
        layers_.clear();
        if (keepDebugLayers) {
            layers_.push_back({"ownShare", {PlaneF(frame.width, frame.height)}});
            a.ownShareLayer = layers_[0].planes[0].row(0);
        }
        runKernel(sraaKernelsFor(exec).resolve, exec, a, frame.height);
    }
    std::vector<DebugLayer> debugLayers() const override { return layers_; }

  private:
    int radius_;
    bool max_, plainDepth_;
    SraaIds ids_;
    double sigmaX_, sigmaZ_, sigmaN_, sharpness_;
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
        .passes = Pass::color | Pass::depth | Pass::normal | Pass::subsamples,
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
        .morePasses = [](const Params& p) { return p.choice("ids") == "off" ? PassSet{} : PassSet(Pass::object); },
        .reachPx = 3};
}
}  // namespace aa
