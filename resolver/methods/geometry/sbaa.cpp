#include "methods/geometry/sbaa.h"

#include "methods/geometry/subsample_geometry.h"
#include "methods/method.h"

namespace aa {

GeometryNeeds sbaaNeeds() { return {.normals = true, .ids = true, .colors = true, .camera = true}; }

namespace {

class Sbaa : public Method {
  public:
    explicit Sbaa(const Params& p)
        : surfaces_(p.integer("surfaces")),
          merge_{p.realf("mergeNormal"), p.realf("mergeDepth")},
          ids_(p.flag("ids")) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const GeometryViews geometry(frame, sbaaNeeds(), "sbaa");
        SbaaArgs a{.color = view(frame.colorLinear),
                   .out = view(out),
                   .geometry = &geometry.args(),
                   .merge = merge_,
                   .surfaces = surfaces_,
                   .ids = ids_,
                   .clustersLayer = nullptr,
                   .surfacesLayer = nullptr,
                   .largestLayer = nullptr};
        layers_.clear();
        if (keepDebugLayers) {
            for (const char* layer : {"clusters", "surfaces", "largest"})
                layers_.push_back({layer, {PlaneF(frame.width, frame.height)}});
            a.clustersLayer = layers_[0].planes[0].row(0), a.surfacesLayer = layers_[1].planes[0].row(0);
            a.largestLayer = layers_[2].planes[0].row(0);
        }
        runKernel(sbaaKernelsFor(exec).resolve, exec, a, frame.height);
    }
    std::vector<DebugLayer> debugLayers() const override { return layers_; }

  private:
    int surfaces_;
    SurfaceRule merge_;
    bool ids_;
    std::vector<DebugLayer> layers_;
};

}  // namespace

MethodDescriptor sbaaDescriptor() {
    return {.id = "sbaa",
            .title = "Surface based anti-aliasing",
            .family = "geometry",
            .summary = "Merges the sub-samples of a pixel into a few surfaces and shades each of them once.",
            .source = "[Salvi 2012]",
            .passes = Pass::color | sbaaNeeds().passes(),
            .params = {intParam("surfaces", "2", 1, kSbaaMaxSamples, "surfaces shaded per pixel", "after [Salvi 2012]"),
                       realParam("mergeNormal", "0.95", -1, 1, "least cosine of the normals of one surface",
                                 "after [Salvi 2012]"),
                       realParam("mergeDepth", "0.01", 0, 10, "most distance from one plane, relative to the depth",
                                 "after [Salvi 2012]"),
                       flagParam("ids", true, "pieces of different objects are no one surface, whatever their geometry",
                                 "ours: a tolerance relative to the depth joins what is far away")},
            .create = [](const Params& p, const ShotInfo& shot) -> std::unique_ptr<Method> {
                requireSubSamples(shot.subSamplePositionsPx, "sbaa", size_t(kSbaaMaxSamples));
                return std::make_unique<Sbaa>(p);
            },
            .reachPx = 1};
}
}  // namespace aa
