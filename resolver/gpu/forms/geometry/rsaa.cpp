#include "gpu/forms.h"
#include "gpu/forms/geometry/geometry_form.h"
#include "methods/geometry/rsaa_options.h"

namespace aa::gpu {
namespace {

class RsaaForm : public GeometryForm {
  public:
    RsaaForm(Session& session, const Params& p, const ShotInfo& shot, const RsaaOptions& o)
        : GeometryForm(session, p, "rsaa:measure=sadp", o.needs()),
          maskPass_(o.maskPass),
          shiftsPx_(rsaaOffsets(shot.subSamplePositionsPx, o.training)),
          shader_("geometry/rsaa", constants(shot, {{10, o.measure},
                                                    {11, o.floor},
                                                    {12, o.adaptive},
                                                    {13, o.tuning},
                                                    {14, o.tuneAdaptive},
                                                    {15, o.ids},
                                                    {16, o.maskPass}})) {
        for (const glm::dvec2& offsetPx : shot.subSamplePositionsPx)
            neighbours_.push_back(rsaaNeighbours(offsetPx, o.quadrant));
    }

  private:
    void record(Current& current, Image& out) override {
        Recorder& recorder = current.recorder();
        if (shifts_.empty()) recorder.upload(fitted(shifts_, bytesOf(shiftsPx_).size()), bytesOf(shiftsPx_));
        recorder.upload(fitted(neighbourBuffer_, bytesOf(neighbours_).size()), bytesOf(neighbours_));
        const Image& mask = maskPass_ ? current[Input::mask] : unread(Format::r32ui);
        recorder.dispatch(shader_, current.width(), current.height(),
                          bindings(current, out, {read(mask), memory(shifts_), memory(neighbourBuffer_)}),
                          push(current.frame()));
    }

    bool maskPass_;
    std::vector<float> shiftsPx_;
    std::vector<RsaaNeighbours> neighbours_;
    Shader shader_;
    Buffer shifts_, neighbourBuffer_;
};
}  // namespace

std::vector<Form> rsaaForms() {
    return {{"rsaa", [](Session& s, const Params& p, const ShotInfo& shot) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<RsaaForm>(s, p, shot, RsaaOptions(p));
             }}};
}

}  // namespace aa::gpu
