#include "methods/temporal/t2msaa.h"

#include <algorithm>

#include "gpu/forms.h"
#include "gpu/forms/temporal/temporal_form.h"
#include "image/colour.h"
#include "methods/temporal/temporal.h"

namespace aa::gpu {
namespace {

// Samples in t2msaa.comp.
struct Samples {
    int32_t layers[2];
    float readX, readY;
    float displayScale;
    int32_t toneMap;
    uint32_t srgb;
};

class T2msaaForm : public TemporalForm {
  public:
    T2msaaForm(Session& session, const Params& params) : TemporalForm(session, params, "t2msaa", Space::linear) {}

  private:
    void recordTemporal(Current& current, const TemporalPush& push, Image& out) override {
        const Params& p = params();
        const Frame& frame = current.frame();
        if (shader_.name().empty()) {
            const RejectionTest test = temporal::rejectionTest(p);
            shader_ = Shader("temporal/t2msaa", constants({{10, p.choice("space") == "encoded"},
                                                           {11, p.choice("velocity") == "fractional"},
                                                           {12, temporal::countAtPixel(p)},
                                                           {13, test.depthTolerance},
                                                           {14, test.magnification},
                                                           {15, test.bothSides}}));
        }
        for (TwoImages* kept : {&depth_, &count_})
            for (Image& image : kept->images) fitted(image, push.width, push.height, Session::value);

        const auto pair = t2msaaSamples(frame, p.real("offset"), history().framesSinceReset());
        const DisplayArgs display = displayArgs(frame.display);
        Samples samples{
            {int32_t(pair[0]), int32_t(pair[1])}, 0, 0, display.scale, display.toneMap, uint32_t(display.srgb)};
        if (p.flag("unjitter")) {
            // Their mean lies here from the pixel's centre.
            const auto& at = frame.subSamplePositionsPx;
            const glm::dvec2 placePx = frame.jitterPx + 0.5 * (at[pair[0]] + at[pair[1]]);
            samples.readX = -float(placePx.x), samples.readY = -float(placePx.y);
        }
        Recorder& recorder = current.recorder();
        recorder.upload(fitted(samples_, sizeof(Samples)), std::as_bytes(std::span(&samples, 1)));
        std::vector<Binding> images = bindings(current, out);
        images.insert(images.end(),
                      {read(current[Input::subColour]), read(current[Input::subDepth]), read(depth_.previous()),
                       written(depth_.next()), read(count_.previous()), written(count_.next()), memory(samples_)});
        // As the kernel's host has it: the expectation stays the pixel's own, also where un-jittering moves the texel.
        TemporalPush own = push;
        const ExpectedDepth expected = expectedDepth(frame);
        std::copy_n(expected.perDepth, 3, own.perDepth);
        std::copy_n(expected.constant, 3, own.constant);
        recorder.dispatch(shader_, push.width, push.height, images, own);
        depth_.swap();
        count_.swap();
    }
    bool showsBlend() const override { return true; }
    Shader shader_;
    TwoImages depth_, count_;
    Buffer samples_;
};
}  // namespace

std::vector<Form> t2msaaForms() {
    return {{"t2msaa", [](Session& s, const Params& p, const ShotInfo&) -> std::unique_ptr<GpuMethod> {
                 return std::make_unique<T2msaaForm>(s, p);
             }}};
}

}  // namespace aa::gpu
