#include "methods/geometry/gbaa.h"

#include "methods/method.h"

namespace aa {
namespace {

class EdgeBlend : public Method {
  public:
    EdgeBlend(bool perAxis, bool searchNeighbours) : perAxis_(perAxis), searchNeighbours_(searchNeighbours) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        EdgeBlendArgs a{view(frame.colorLinear), view(out),    frame.edgeXPx.row(0),
                        frame.edgeYPx.row(0),    out.stride(), frame.width,
                        searchNeighbours_,       nullptr,      nullptr};
        layers_.clear();
        if (keepDebugLayers) {
            for (const char* layer : {"offsetXPx", "offsetYPx"})
                layers_.push_back({layer, {PlaneF(frame.width, frame.height)}});
            a.offsetXLayer = layers_[0].planes[0].row(0), a.offsetYLayer = layers_[1].planes[0].row(0);
        }
        const GbaaKernels& kernels = gbaaKernelsFor(exec);
        runKernel(perAxis_ ? kernels.d2e : kernels.gbaa, exec, a, frame.height);
    }
    std::vector<DebugLayer> debugLayers() const override { return layers_; }

  private:
    bool perAxis_, searchNeighbours_;
    std::vector<DebugLayer> layers_;
};

}  // namespace

MethodDescriptor gbaaDescriptor() {
    return {
        .id = "gbaa",
        .title = "Geometry buffer anti-aliasing",
        .family = "geometry",
        .summary = "Blends a pixel with the neighbour beyond the nearest edge of the triangle that it shows.",
        .source = "[Persson 2011]; [Stejmar n.d., 3.3]",
        .passes = Pass::color | Pass::edges,
        .params = {flagParam("searchNeighbours", true, "a pixel without an edge of its own asks its four neighbours",
                             "[Stejmar n.d., listing 3.1]")},
        .create = [](const Params& p, const ShotInfo&) -> std::unique_ptr<Method> {
            return std::make_unique<EdgeBlend>(false, p.flag("searchNeighbours"));
        },
        .reachPx = 2,
        .publishedMemory = {{0, 7.9, "[Stejmar n.d., table 5.6]"}}};
}

MethodDescriptor d2eDescriptor() {
    return {.id = "d2e",
            .title = "Distance-to-edge anti-aliasing",
            .family = "geometry",
            .summary = "Blends a pixel along each axis with the neighbour beyond the nearest edge.",
            .source = "[Malan 2010]",
            .passes = Pass::color | Pass::edges,
            .create = [](const Params&, const ShotInfo&) -> std::unique_ptr<Method> {
                return std::make_unique<EdgeBlend>(true, true);
            },
            .reachPx = 2};
}
}  // namespace aa
