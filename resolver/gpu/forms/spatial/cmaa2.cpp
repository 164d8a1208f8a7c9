#include "methods/spatial/cmaa2.h"

#include "gpu/forms.h"
#include "methods/spatial/luma.h"

namespace aa::gpu {
namespace {

class Cmaa2Form : public GpuMethod {
  public:
    Cmaa2Form(Session& session, const Params& p)
        : GpuMethod(session, p), settings_(cmaa2Settings(p)), linear_(p.choice("blendSpace") == "linear") {
        const Cmaa2BlendArgs& b = settings_.blend;
        shapesShader_ = Shader("spatial/cmaa2_shapes", {{10, b.longestPx}});
        blendShader_ = Shader("spatial/cmaa2_blend", {{10, b.longestPx},
                                                      {11, float(b.simpleBlur)},
                                                      {12, float(b.fadeFrom)},
                                                      {13, float(b.fadePerEdge)},
                                                      {14, float(b.symmetryCorrection)},
                                                      {15, float(b.dampening)}});
    }

  private:
    void record(Current& current, Image& out) override {
        struct {
            int32_t width, height;
        } const push{current.width(), current.height()};
        const LumaKind luma = shownLuma(LumaKind::linearOfSqrt, current.frame().display);
        if (edgesShader_.name().empty() || luma != luma_)
            edgesShader_ = Shader("spatial/cmaa2_edges",
                                  {{10, settings_.threshold}, {11, settings_.localContrast}, {12, luma_ = luma}});
        fitted(edges_, push.width, push.height, Format::r32ui);
        fitted(shapes_, push.width, push.height, Format::r32ui);
        const auto dispatch = [&](Shader& shader, std::initializer_list<Binding> images) {
            current.recorder().dispatch(shader, push.width, push.height, std::span(images.begin(), images.size()),
                                        push);
        };
        dispatch(edgesShader_, {read(current[Input::colour]), written(edges_)});
        dispatch(shapesShader_, {read(edges_), written(shapes_)});
        dispatch(blendShader_, {read(current[linear_ ? Input::colour : Input::encoded]), read(shapes_), written(out)});
    }
    Cmaa2Settings settings_;
    bool linear_;
    LumaKind luma_ = LumaKind::linearOfSqrt;
    Shader edgesShader_, shapesShader_, blendShader_;
    Image edges_, shapes_;
};
}  // namespace

std::vector<Form> cmaa2Forms() {
    return {{"cmaa2", [](Session& s, const Params& p, const ShotInfo&) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<Cmaa2Form>(s, p);
             }}};
}

}  // namespace aa::gpu
