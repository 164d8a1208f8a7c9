#include "gpu/forms.h"
#include "gpu/forms/spatial/spatial_form.h"
#include "methods/spatial/fxaa_base.h"

namespace aa::gpu {
namespace {

// A luma per pixel, then the filter that searches in it.
class SearchingForm : public GpuMethod {
  public:
    SearchingForm(Session& session, const Params& params, LumaKind luma, Input picture, Shader filter)
        : GpuMethod(session, params), luma_(luma), picture_(picture), filter_(std::move(filter)) {}

  private:
    void record(Current& current, Image& out) override {
        const bool ofLinear = luma_ == LumaKind::sqrtLinear || luma_ == LumaKind::log2Linear;
        const LumaKind shown = shownLuma(luma_, current.frame().display);
        if (findLuma_.name().empty() || shown != shown_) findLuma_ = Shader("spatial/luma", {{10, shown_ = shown}});
        const SpatialPush push(current);
        Image& luma = fitted(lumaImage_, push.width, push.height, Session::value);
        const Binding lumas[] = {read(current[ofLinear ? Input::colour : Input::encoded]), written(luma)};
        current.recorder().dispatch(findLuma_, push.width, push.height, lumas, push);
        const Binding images[] = {read(current[picture_]), written(out), read(luma)};
        current.recorder().dispatch(filter_, push.width, push.height, images, push);
    }
    LumaKind luma_, shown_ = LumaKind::rec601;  // chosen, and what stands for it under the frame's display chain
    Input picture_;
    Shader findLuma_, filter_;
    Image lumaImage_;
};

Input blended(const Params& p) { return p.choice("blendSpace") == "linear" ? Input::colour : Input::encoded; }
// shaders/common/fxaa_search.glsl, and the filter's own.
std::vector<Constant> searchConstants(const FxaaArgs& args, std::vector<Constant> own) {
    own.push_back({10, args.steps});
    for (int k = 0; k < kFxaaMaxSteps; k++) own.push_back({uint32_t(11 + k), args.distanceHalfPx[k]});
    return own;
}

std::unique_ptr<GpuMethod> fxaa311(Session& session, const Params& p, const ShotInfo&) {
    const FxaaArgs args = fxaa311Args(p);
    Shader filter(
        "spatial/fxaa311",
        searchConstants(args, {{23, args.edgeThreshold}, {24, args.edgeThresholdMin}, {25, float(args.subpix)}}));
    return std::make_unique<SearchingForm>(session, p, fxaa311Luma(p), blended(p), std::move(filter));
}
std::unique_ptr<GpuMethod> fxaaCs(Session& session, const Params& p, const ShotInfo&) {
    const FxaaCsArgs args = fxaaCsArgs(p);
    Shader filter("spatial/fxaacs", searchConstants(args, {{23, args.edgeThresholdMin}, {24, float(args.subpix)}}));
    return std::make_unique<SearchingForm>(session, p, LumaKind::log2Linear, blended(p), std::move(filter));
}
std::unique_ptr<GpuMethod> fxaa1(Session& session, const Params& p, const ShotInfo&) {
    const Fxaa1Args args = fxaa1Args(p);
    Shader filter("spatial/fxaa1", {{10, args.steps},
                                    {11, args.acceleration},
                                    {12, args.edgeThreshold},
                                    {13, args.edgeThresholdMin},
                                    {14, float(args.subpixCap)},
                                    {15, float(args.subpixTrim)},
                                    {16, args.crossLowPass}});
    return std::make_unique<SearchingForm>(session, p, LumaKind::redGreen, Input::encoded, std::move(filter));
}
std::unique_ptr<GpuMethod> fxaaConsole(Session& session, const Params& p, const ShotInfo&) {
    const FxaaConsoleArgs args = fxaaConsoleArgs(p);
    Shader filter("spatial/fxaaconsole", {{10, float(args.reachPx)},
                                          {11, float(args.sharpness)},
                                          {12, args.edgeThreshold},
                                          {13, args.edgeThresholdMin}});
    return std::make_unique<OneShaderForm>(session, p, Input::encoded, std::move(filter));
}
}  // namespace

std::vector<Form> fxaaForms() {
    return {{"fxaa311", fxaa311}, {"fxaa1", fxaa1}, {"fxaacs", fxaaCs}, {"fxaaconsole", fxaaConsole}};
}

}  // namespace aa::gpu
