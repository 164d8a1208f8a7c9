#include "methods/spatial/skeleton.h"

#include "methods/method.h"
#include "methods/spatial/luma.h"
#include "methods/working.h"

namespace aa {
namespace {

// A choice is one table: the texts of the command line and what they stand for.
constexpr Choice<LumaKind> kSpatialSkeletonLumas[] = {{"rec601", LumaKind::rec601}, {"green", LumaKind::green}};

class SpatialSkeleton : public Method {
  public:
    // Parameters are read once, here. A name that the table below does not hold throws at the first run.
    explicit SpatialSkeleton(const Params& p)
        : luma_(p.chosen("luma", kSpatialSkeletonLumas)),
          threshold_(p.realf("threshold")),
          strength_(p.realf("strength")) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const Rgb& in = frame.colorEncoded;   // filled because .input below says encoded
        const auto luma = lumaPlane_.take();  // this frame's alone: the next one makes it anew
        lumaPlane(in, luma_, exec, *luma);
        SpatialSkeletonArgs args{.in = view(in),
                                 .out = view(out),
                                 .luma = luma->row(0),
                                 .contrast = nullptr,
                                 .stride = in.stride(),
                                 .width = in.width(),
                                 .threshold = threshold_,
                                 .strength = strength_};
        if (keepDebugLayers) {
            contrast_ = PlaneF(in.width(), in.height());
            args.contrast = contrast_.row(0);
        }
        runKernel(spatialSkeletonKernelsFor(exec).resolve, exec, args, in.height());
    }
    size_t stateBytes() const override { return lumaPlane_.bytes(); }  // what `bench` counts; no debug layers
    std::vector<DebugLayer> debugLayers() const override {
        if (!keepDebugLayers) return {};
        return {{"contrast", {contrast_}}};
    }

  private:
    LumaKind luma_;
    float threshold_, strength_;
    Working<PlaneF> lumaPlane_;
    PlaneF contrast_;
};

}  // namespace

MethodDescriptor spatialSkeletonDescriptor() {
    return {.id = "spatialSkeleton",
            .title = "Spatial skeleton",
            .family = "spatial",
            .summary = "Moves a pixel toward the mean of its cross where its luma differs from a neighbour's.",
            .source = "an example",  // a key of docs/sources.md: [Lottes 2011]
            .passes = Pass::color,
            .input = Space::encoded,
            .output = Space::encoded,
            // One table makes help, JSON, the add-on's panel, the docs and sweeps. A default has a source, too.
            .params = {choiceParam("luma", "rec601", kSpatialSkeletonLumas, "luma that decides where edges are",
                                   "an example"),
                       realParam("threshold", "0.1", 0.0009765625, 1, "least difference of luma that is filtered",
                                 "an example"),
                       realParam("strength", "1", 0, 1, "0: nothing, 1: the mean of the five", "an example")},
            .create = [](const Params& p, const ShotInfo&) { return std::make_unique<SpatialSkeleton>(p); },
            .reachPx = 1};  // the cross; tests/property/reach_test.cpp measures it
}
}  // namespace aa
