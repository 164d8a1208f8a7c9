#include "gpu/stages.h"

#include <string>

#include "gpu/forms.h"
#include "methods/sharpen.h"
#include "methods/stage.h"

namespace aa::gpu {
namespace {

// One that has a single image of its own.
class ImageStage : public DeviceStage {
  public:
    explicit ImageStage(Session& session) : session_(session) {}
    size_t stateBytes() const override { return shown_.empty() ? 0 : shown_.bytes(); }

  protected:
    struct Size {
        int32_t width, height;
    };
    // An image like `image`, whose contents the stage replaces.
    Image& fitted(const Image& image, Image& own) {
        if (own.empty() || own.width() != image.width() || own.height() != image.height())
            own = Image(session_.device(), image.width(), image.height(), session_.colour());
        return own;
    }
    Image& shown(const Image& image) { return fitted(image, shown_); }
    static Size sizeOf(const Image& image) { return {image.width(), image.height()}; }

  private:
    Session& session_;
    Image shown_;
};

class SharpenStage : public ImageStage {
  public:
    SharpenStage(Session& session, const std::string& filter, Space space)
        : ImageStage(session),
          shader_("stages/sharpen",
                  {{10, sharpenByName(filter)},
                   {11, space == Space::encoded ? SharpenRange::display : SharpenRange::neighbourhood}}) {}
    const Image& record(Current& current, const Image& image, const Image*) override {
        Image& sharpened = shown(image);
        const Binding images[] = {read(image), written(sharpened)};
        current.recorder().dispatch(shader_, image.width(), image.height(), images, sizeOf(image));
        return sharpened;
    }

  private:
    Shader shader_;
};

class FillStage : public ImageStage {
  public:
    FillStage(Session& session, const MethodSpec& filler, Space space, const ShotInfo& shot) : ImageStage(session) {
        const Form* form = findForm(filler.method->id);
        if (!form)
            throw UsageError("--device: stage 'fill': '" + std::string(filler.method->id) +
                             "' has no shader; use --device cpu");
        filler_ = form->create(session, filler.params(), shot);
        const int conversion = filler.outputSpace() == space ? 0 : space == Space::encoded ? 1 : 2;
        shader_ = Shader("stages/fill", {{10, conversion}});
    }
    bool needsRejection() const override { return true; }
    size_t stateBytes() const override {
        return ImageStage::stateBytes() + filler_->stateBytes() + (fill_.empty() ? 0 : fill_.bytes());
    }
    // Always runs the filling method: that no pixel was rejected is known to the device alone.
    const Image& record(Current& current, const Image& image, const Image* rejection) override {
        if (!rejection) return image;
        filler_->record(current, fitted(image, fill_));
        const DisplayArgs display = displayArgs(current.frame().display);
        const struct {
            Size size;
            float scale;
            int32_t toneMap;
            uint32_t srgb;
        } push{sizeOf(image), display.scale, display.toneMap, display.srgb};
        Image& filled = shown(image);
        const Binding images[] = {read(image), read(fill_), read(*rejection), written(filled)};
        current.recorder().dispatch(shader_, image.width(), image.height(), images, push);
        return filled;
    }

  private:
    std::unique_ptr<GpuMethod> filler_;
    Image fill_;
    Shader shader_;
};

class MotionBlurStage : public ImageStage {
  public:
    MotionBlurStage(Session& session, float scale)
        : ImageStage(session), shader_("stages/motion_blur", {{10, scale}}) {}
    const Image& record(Current& current, const Image& image, const Image*) override {
        Image& blurred = shown(image);
        const Binding images[] = {read(image), read(current[Input::motion]), written(blurred)};
        current.recorder().dispatch(shader_, image.width(), image.height(), images, sizeOf(image));
        return blurred;
    }

  private:
    Shader shader_;
};
}  // namespace

std::unique_ptr<DeviceStage> makeStage(Session& session, const StageSpec& stage, const MethodSpec& method,
                                       const ShotInfo& shot) {
    const std::string_view name = stage.stage->value.name;
    if (name == "sharpen") return std::make_unique<SharpenStage>(session, stage.value, method.outputSpace());
    if (name == "fill")
        return std::make_unique<FillStage>(session, parseMethod(stage.value), method.outputSpace(), shot);
    if (name == "motionBlur") return std::make_unique<MotionBlurStage>(session, float(numberOf(stage.value)));
    throw UsageError("--device: stage '" + std::string(name) + "' has no shader; use --device cpu");
}

}  // namespace aa::gpu
