// The sharpening that uncharted and master show their blend with: a last pass, shaders/temporal/sharpen_history.comp.
#pragma once
#include "gpu/forms/temporal/temporal_form.h"
#include "methods/temporal/temporal.h"

namespace aa::gpu {

class HistorySharpening {
  public:
    explicit HistorySharpening(SharpenKernel kernel) {
        if (kernel != SharpenKernel::none) shader_ = Shader("temporal/sharpen_history", {{10, sharpenGain(kernel)}});
    }
    // False: the method writes what is shown by itself.
    bool wanted() const { return !shader_.name().empty(); }
    void record(Current& current, const Image& blend, Image& out) {
        if (!wanted()) return;
        const struct { int32_t width, height; } size{blend.width(), blend.height()};
        const Binding images[] = {read(blend), written(out)};
        current.recorder().dispatch(shader_, blend.width(), blend.height(), images, size);
    }

  private:
    Shader shader_;
};

}  // namespace aa::gpu
