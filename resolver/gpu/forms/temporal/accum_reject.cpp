#include "methods/temporal/accum_reject.h"

#include "gpu/forms.h"
#include "gpu/forms/temporal/temporal_form.h"
#include "methods/temporal/temporal.h"

namespace aa::gpu {
namespace {

class AccumRejectForm : public TemporalForm {
  public:
    AccumRejectForm(Session& session, const Params& params)
        : TemporalForm(session, params, "accumReject", Space::linear) {}

  private:
    void recordTemporal(Current& current, const TemporalPush& push, Image& out) override {
        const Params& p = params();
        const bool window = p.choice("depthTest") == "window", ids = p.flag("objectIds");
        if (shader_.name().empty()) {
            const RejectionTest test = temporal::rejectionTest(p);
            shader_ = Shader("temporal/accum_reject", constants({{10, int(p.choiceIndex("depthTest"))},
                                                                 {11, test.depthTolerance},
                                                                 {12, test.magnification},
                                                                 {13, test.bothSides},
                                                                 {14, ids},
                                                                 {15, p.realf("nMaxStatic")},
                                                                 {16, p.realf("nMaxMoving")},
                                                                 {17, session().fast()}}));
            farthestShader_ = Shader("temporal/accum_reject_farthest");
        }
        const int width = push.width, height = push.height;
        for (Image& image : depth_.images) fitted(image, width, height, Session::value);
        for (Image& image : residual_.images) fitted(image, width, height, Format::rgba32f);
        fitted(farthest_, window ? width : 1, window ? height : 1, Session::value);
        fitted(id_, ids ? width : 1, ids ? height : 1, Format::r32ui);

        Recorder& recorder = current.recorder();
        std::vector<Binding> images = bindings(current, out);
        images.insert(images.end(), {read(depth_.previous()), written(depth_.next()), read(residual_.previous()),
                                     written(residual_.next()), read(farthest_),
                                     read(ids ? current[Input::objectId] : id_), read(id_)});
        recorder.dispatch(shader_, width, height, images, push);
        if (ids) recorder.copy(current[Input::objectId], id_);
        if (window) {
            const std::array place{width, height, push.texelX, push.texelY};
            const Binding planes[] = {read(current[Input::depth]), written(farthest_)};
            recorder.dispatch(farthestShader_, width, height, planes, place);
        }
        depth_.swap();
        residual_.swap();
    }
    bool showsBlend() const override { return true; }
    Shader shader_, farthestShader_;
    TwoImages depth_, residual_;
    Image farthest_, id_;  // of the last frame
};
}  // namespace

std::vector<Form> accumRejectForms() {
    return {{"accumReject", [](Session& s, const Params& p, const ShotInfo&) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<AccumRejectForm>(s, p);
             }}};
}

}  // namespace aa::gpu
