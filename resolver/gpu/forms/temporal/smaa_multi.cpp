#include "gpu/forms.h"
#include "gpu/forms/spatial/smaa_form.h"
#include "methods/temporal/history.h"

namespace aa::gpu {
namespace {

// SMAA of one or two samples per frame, mixed with the frame before where the speed agrees.
class SmaaTemporalForm : public SmaaForm {
  public:
    SmaaTemporalForm(Session& session, const Params& p, std::string_view id)
        : SmaaForm(session, p),
          id_(id),
          pixels1080_(p.choice("velocityUnit") == "px1080"),
          unjitter_(p.flag("unjitter")),
          shader_("temporal/smaa_resolve", {{10, p.flag("reproject")}, {11, p.realf("rejection")}, {12, unjitter_}}) {}

  protected:
    // The frame, anti-aliased, and its motion blended with the same weights.
    virtual void recordFrame(Current& current, Blended out) = 0;

  private:
    void record(Current& current, Image& out) override {
        const Frame& frame = current.frame();
        history_.begin(frame, id_);
        for (Image& image : colour_.images) fitted(image, frame.width, frame.height, session().colour());
        for (Image& image : velocity_.images) fitted(image, frame.width, frame.height, velocityFormat());
        Image& resolved = unjitter_ ? fitted(jittered_, frame.width, frame.height, session().colour()) : colour_.next();
        recordFrame(current, {&resolved, &velocity_.next()});
        struct {
            int32_t width, height;
            float scaleX, scaleY, readX, readY;
            uint32_t firstFrame;
        } push{frame.width,
               frame.height,
               pixels1080_ ? 1.0f / 1080 : 1.0f / float(frame.width),
               pixels1080_ ? 1.0f / 1080 : 1.0f / float(frame.height),
               -float(frame.jitterPx.x),
               -float(frame.jitterPx.y),
               history_.fresh()};
        const Binding images[] = {read(resolved),
                                  read(colour_.previous()),
                                  read(velocity_.next()),
                                  read(velocity_.previous()),
                                  read(current[Input::motion]),
                                  written(unjitter_ ? colour_.next() : out),
                                  written(out)};
        current.recorder().dispatch(shader_, push.width, push.height, images, push);
        history_.end();
        colour_.swap(), velocity_.swap();
    }
    std::string_view id_;
    bool pixels1080_, unjitter_;
    Shader shader_;
    History history_;  // counts frames and checks their size
    TwoImages colour_, velocity_;
    Image jittered_;
};

class SmaaT2xForm : public SmaaTemporalForm {
  public:
    SmaaT2xForm(Session& session, const Params& params) : SmaaTemporalForm(session, params, "smaaT2x") {}

  private:
    void recordFrame(Current& current, Blended out) override {
        findEdges(current, needsEncoded() ? &current[Input::encoded] : nullptr, current.frame().jitterPx);
        blend(current, current[linear() ? Input::colour : Input::encoded], out);
    }
};

class Smaa4xForm : public SmaaTemporalForm {
  public:
    Smaa4xForm(Session& session, const Params& params, const ShotInfo& shot)
        : SmaaTemporalForm(session, params, "smaa4x"), shot_(shot), samples_(smaa4xSamples(shot)) {}

  private:
    void recordFrame(Current& current, Blended out) override {
        blendTwo(current, shot_, samples_[current.frame().number % 2 == 0 ? 0 : 1], out);
    }
    ShotInfo shot_;
    std::array<SmaaSamples, 2> samples_;  // of even and of odd frames
};
}  // namespace

std::vector<Form> smaaMultiForms() {
    return {{"smaaT2x",
             [](Session& s, const Params& p, const ShotInfo&) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<SmaaT2xForm>(s, p);
             }},
            {"smaa4x", [](Session& s, const Params& p, const ShotInfo& shot) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<Smaa4xForm>(s, p, shot);
             }}};
}

}  // namespace aa::gpu
