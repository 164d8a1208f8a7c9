// What the FXAA variants share on the host: the luma plane, debug planes and search patterns.
#pragma once
#include "methods/fxaa_kernels.h"
#include "methods/luma.h"
#include "methods/method.h"

namespace aa {

struct FxaaPreset {
    std::string_view name;
    std::vector<double> stepsPx;  // increments; the last is a jump whose end is never sampled
};
inline std::vector<std::string_view> presetNames(const std::vector<FxaaPreset>& presets) {
    std::vector<std::string_view> names;
    for (const auto& p : presets) names.push_back(p.name);
    return names;
}
inline void setDistances(FxaaArgs& args, const std::vector<double>& stepsPx) {
    double sumPx = 0;
    args.steps = 0;
    for (const double step : stepsPx) args.distanceHalfPx[args.steps++] = int(2 * (sumPx += step));
}

// What every variant keeps: the luma plane and, on request, what it found at each edge pixel.
class FxaaMethod : public Method {
  public:
    size_t stateBytes() const override { return luma_.bytes(); }
    std::vector<DebugLayer> debugLayers() const override {
        if (!keepDebugLayers) return {};
        // Gold: horizontal; blue: vertical (methods/02 s.2.2).
        std::vector<PlaneF> colour(3, PlaneF(orientation_.width(), orientation_.height()));
        for (int y = 0; y < orientation_.height(); y++)
            for (int x = 0; x < orientation_.width(); x++) {
                const bool horizontal = orientation_.at(x, y) == 1, vertical = orientation_.at(x, y) == 2;
                colour[0].at(x, y) = horizontal ? 1.0f : 0.0f;
                colour[1].at(x, y) = horizontal ? 0.84f : 0.0f;
                colour[2].at(x, y) = vertical ? 1.0f : 0.0f;
            }
        return {{"edges", std::move(colour)}, {"search", {negativePx_, positivePx_, shiftPx_}}};
    }

  protected:
    // Points `args` at this frame's planes.
    void prepare(FxaaArgs& args, const Rgb& filtered, Rgb& out) {
        args.luma = luma_.row(0);
        args.in = view(filtered);
        args.out = view(out);
        args.stride = filtered.stride();
        args.width = filtered.width();
        args.height = filtered.height();
        if (keepDebugLayers) {
            for (PlaneF* p : {&orientation_, &negativePx_, &positivePx_, &shiftPx_})
                *p = PlaneF(filtered.width(), filtered.height());
            args.orientation = orientation_.row(0);
            args.negativePx = negativePx_.row(0);
            args.positivePx = positivePx_.row(0);
            args.shiftPx = shiftPx_.row(0);
        }
    }
    PlaneF luma_;

  private:
    PlaneF orientation_, negativePx_, positivePx_, shiftPx_;
};

}  // namespace aa
