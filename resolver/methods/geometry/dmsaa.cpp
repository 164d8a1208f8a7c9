#include "methods/geometry/dmsaa.h"

#include "methods/geometry/subsample_geometry.h"
#include "methods/method.h"

namespace aa {
namespace {

constexpr Choice<DmsaaVector> kVectors[] = {
    {"perS", DmsaaVector::perS}, {"perD", DmsaaVector::perD}, {"ideal", DmsaaVector::ideal}};

class Dmsaa : public Method {
  public:
    explicit Dmsaa(const Params& p)
        : vector_(p.chosen("vecMode", kVectors)), depthThreshold_(p.realf("depthThreshold")), gain_(p.realf("gain")) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const GeometryViews geometry(frame, {}, "dmsaa");
        std::vector<float> positionsPx;
        for (const auto& p : frame.subSamplePositionsPx)
            positionsPx.insert(positionsPx.end(), {float(p.x), float(p.y)});
        DmsaaArgs a{view(frame.colorLinear),
                    view(out),
                    &geometry.args(),
                    positionsPx.data(),
                    vector_,
                    depthThreshold_,
                    gain_,
                    nullptr,
                    nullptr,
                    nullptr};
        layers_.clear();
        if (keepDebugLayers) {
            for (const char* layer : {"differing", "offsetXPx", "offsetYPx"})
                layers_.push_back({layer, {PlaneF(frame.width, frame.height)}});
            a.countLayer = layers_[0].planes[0].row(0);
            a.offsetXLayer = layers_[1].planes[0].row(0), a.offsetYLayer = layers_[2].planes[0].row(0);
        }
        runKernel(dmsaaKernelsFor(exec).resolve, exec, a, frame.height);
    }
    std::vector<DebugLayer> debugLayers() const override { return layers_; }

  private:
    DmsaaVector vector_;
    float depthThreshold_, gain_;
    std::vector<DebugLayer> layers_;
};

}  // namespace

MethodDescriptor dmsaaDescriptor() {
    return {
        .id = "dmsaa",
        .title = "Deferred MSAA filter",
        .family = "geometry",
        .summary = "Fetches the colour beside the pixel centre, toward the sub-samples whose depth differs.",
        .source = "[Pettineo 2010] as told in [Reshetov 2012, slide 16]",
        .passes = Pass::color | GeometryNeeds{}.passes(),
        .params = {choiceParam("vecMode", "perS", kVectors,
                               "shift: sum of the differing offsets by S, by their number, or as long as their share",
                               "decisions 31"),
                   realParam("depthThreshold", "0.02", 0.0001, 10, "least depth difference, relative to the nearer",
                             "ours"),
                   realParam("gain", "1", 0, 4, "factor on the shift", "ours")},
        .create = [](const Params& p, const ShotInfo& shot) -> std::unique_ptr<Method> {
            requireSubSamples(shot.subSamplePositionsPx, "dmsaa", 64);
            return std::make_unique<Dmsaa>(p);
        },
        .reachPx = 2};
}
}  // namespace aa
