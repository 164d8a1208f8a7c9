#include "methods/temporal/fsr2n.h"

#include <algorithm>

#include "gpu/forms.h"
#include "gpu/forms/temporal/temporal_form.h"

namespace aa::gpu {
namespace {

// Bits of the depth 2^127, where nothing is known: farther than any.
constexpr float kNoDepthBits = 0x7f000000;

// Weights in fsr2n.comp.
struct Weights {
    float lanczos[9], still[9], moving[9], separation, power;
};

class Fsr2nForm : public TemporalForm {
  public:
    Fsr2nForm(Session& session, const Params& params, int jitterPeriod)
        : TemporalForm(session, params, "fsr2n", Space::linear), lockDecay_(1.0f / float(std::max(1, jitterPeriod))) {}

  private:
    void recordTemporal(Current& current, const TemporalPush& push, Image& out) override {
        const Params& p = params();
        if (shader_.name().empty()) {
            scatter_ = Shader("temporal/fsr2n_scatter", constants());
            shader_ = Shader(
                "temporal/fsr2n",
                constants(
                    {{10, p.realf("weight")}, {11, p.realf("boxScale")}, {12, p.flag("locks")}, {13, lockDecay_}}));
        }
        fitted(nearest_, push.width, push.height, Format::r32ui);
        for (Image& image : luma_.images) fitted(image, push.width, push.height, Session::value);

        Recorder& recorder = current.recorder();
        const std::vector<Binding> common = bindings(current, out);
        std::vector<Binding> images = common;
        if (!push.firstFrame) {
            recorder.clear(nearest_, {kNoDepthBits});
            images.push_back(written(nearest_));
            recorder.dispatch(scatter_, push.width, push.height, images, push);
        }
        Fsr2nArgs args{};
        setFsr2nFrame(args, current.frame(), push.jitterX, push.jitterY);
        Weights weights{{}, {}, {}, args.separation, args.power};
        std::copy_n(args.lanczos, 9, weights.lanczos);
        std::copy_n(args.still, 9, weights.still);
        std::copy_n(args.moving, 9, weights.moving);
        recorder.upload(fitted(weights_, sizeof(Weights)), std::as_bytes(std::span(&weights, 1)));
        images = common;
        images.insert(images.end(), {read(nearest_), read(luma_.previous()), written(luma_.next()), memory(weights_)});
        recorder.dispatch(shader_, push.width, push.height, images, push);
        luma_.swap();
    }
    float lockDecay_;
    bool showsBlend() const override { return true; }
    Shader scatter_, shader_;
    Image nearest_;
    TwoImages luma_;
    Buffer weights_;
};
}  // namespace

std::vector<Form> fsr2nForms() {
    return {{"fsr2n", [](Session& s, const Params& p, const ShotInfo& shot) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<Fsr2nForm>(s, p, shot.jitterPeriod);
             }}};
}

}  // namespace aa::gpu
