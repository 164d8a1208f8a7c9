#include "methods/temporal/master.h"

#include "gpu/forms.h"
#include "gpu/forms/temporal/sharpened.h"

namespace aa::gpu {
namespace {

// What Recorder::dispatch(), which counts workgroups of 8, takes for workgroups of 16 that cover `pixels`.
int inGroupsOf16(int pixels) { return (pixels + 15) / 16 * 8; }

class MasterForm : public TemporalForm {
  public:
    MasterForm(Session& session, const Params& params)
        : TemporalForm(session, params, "master", Space::encoded), sharpening_(temporal::sharpenKernel(params)) {}

  private:
    void makeShaders() {
        const Params& p = params();
        sobelOfTexels_ =
            Shader("temporal/master_sobel",
                   {{10, p.realf("wU")}, {11, p.realf("wL")}, {12, masterDepthUnit(p)}, {13, temporal::luminance(p)}});
        resolve_ = Shader("temporal/master", constants({{10, p.realf("kmin")},
                                                        {11, p.realf("kmax")},
                                                        {12, temporal::clipTarget(p)},
                                                        {13, temporal::luminance(p)},
                                                        {15, p.flag("sobel")},
                                                        {16, p.flag("model")},
                                                        {17, p.flag("depth")},
                                                        {18, p.flag("depthTemporal")},
                                                        {19, p.flag("sobelTemporal")},
                                                        {20, masterDepthUnit(p)},
                                                        {21, p.realf("depthThreshold")},
                                                        {22, p.flag("relativeThreshold")},
                                                        {23, p.choice("pastDepth") == "samePixel"},
                                                        {24, p.flag("compensate")},
                                                        {25, p.realf("minAlias")}}));
    }
    void recordTemporal(Current& current, const TemporalPush& push, Image& out) override {
        if (resolve_.name().empty()) makeShaders();
        const bool sobel = params().flag("sobel");
        fitted(sobel_, sobel ? push.width : 1, sobel ? push.height : 1, Session::value);
        for (Image& image : depth_.images) fitted(image, push.width, push.height, Session::value);

        const float farDepth = masterFarDepth(current.frame());
        if (sobel) {
            const Binding images[] = {read(current[Input::encoded]), read(current[Input::albedoEncoded]),
                                      read(current[Input::depth]), written(sobel_)};
            const struct {
                int32_t width, height;
                float farDepth;
            } size{push.width, push.height, farDepth};
            current.recorder().dispatch(sobelOfTexels_, push.width, push.height, images, size);
        }
        std::vector<Binding> images = bindings(current, out);
        images.insert(images.end(),
                      {read(sobel_), read(current[Input::objectId]), read(depth_.previous()), written(depth_.next())});
        TemporalPush own = push;
        own.perDepth[3] = farDepth;
        current.recorder().dispatch(resolve_, inGroupsOf16(push.width), inGroupsOf16(push.height), images, own);
        sharpening_.record(current, blend().next(), out);
        depth_.swap();
    }
    bool showsBlend() const override { return !sharpening_.wanted(); }
    bool storesResult() const override { return false; }
    Shader sobelOfTexels_, resolve_;
    HistorySharpening sharpening_;
    Image sobel_;
    TwoImages depth_;  // in its unit
};
}  // namespace

std::vector<Form> masterForms() {
    return {{"master", [](Session& s, const Params& p, const ShotInfo&) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<MasterForm>(s, p);
             }}};
}

}  // namespace aa::gpu
