#include "methods/fxaa.h"

#include "methods/fxaa_kernels.h"
#include "methods/luma.h"

namespace aa {
namespace {

struct Preset {
    std::string_view name;
    std::vector<double> stepsPx;  // increments; the last is a jump whose end is never sampled
};
// FXAA 3.11, methods/02 s.2.1: 10-15 medium dither, 20-29 less dither, 39 no dither.
const std::vector<Preset>& presets311() {
    static const std::vector<Preset> presets = {
        {"10", {1.5, 3, 12}},
        {"11", {1, 1.5, 3, 12}},
        {"12", {1, 1.5, 2, 4, 12}},
        {"13", {1, 1.5, 2, 2, 4, 12}},
        {"14", {1, 1.5, 2, 2, 2, 4, 12}},
        {"15", {1, 1.5, 2, 2, 2, 2, 4, 12}},
        {"20", {1.5, 2, 8}},
        {"21", {1, 1.5, 2, 8}},
        {"22", {1, 1.5, 2, 2, 8}},
        {"23", {1, 1.5, 2, 2, 2, 8}},
        {"24", {1, 1.5, 2, 2, 2, 3, 8}},
        {"25", {1, 1.5, 2, 2, 2, 2, 4, 8}},
        {"26", {1, 1.5, 2, 2, 2, 2, 2, 4, 8}},
        {"27", {1, 1.5, 2, 2, 2, 2, 2, 2, 4, 8}},
        {"28", {1, 1.5, 2, 2, 2, 2, 2, 2, 2, 4, 8}},
        {"29", {1, 1.5, 2, 2, 2, 2, 2, 2, 2, 2, 4, 8}},
        {"39", {1, 1, 1, 1, 1, 1.5, 2, 2, 2, 2, 4, 8}},
    };
    return presets;
}
std::vector<std::string_view> presetNames(const std::vector<Preset>& presets) {
    std::vector<std::string_view> names;
    for (const auto& p : presets) names.push_back(p.name);
    return names;
}
void setDistances(FxaaArgs& args, const std::vector<double>& stepsPx) {
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
    FxaaArgs prepare(const Rgb& filtered, Rgb& out) {
        args_.luma = luma_.row(0);
        args_.in = view(filtered);
        args_.out = view(out);
        args_.stride = filtered.stride();
        args_.width = filtered.width();
        args_.height = filtered.height();
        if (keepDebugLayers) {
            for (PlaneF* p : {&orientation_, &negativePx_, &positivePx_, &shiftPx_})
                *p = PlaneF(filtered.width(), filtered.height());
            args_.orientation = orientation_.row(0);
            args_.negativePx = negativePx_.row(0);
            args_.positivePx = positivePx_.row(0);
            args_.shiftPx = shiftPx_.row(0);
        }
        return args_;
    }
    FxaaArgs args_{};
    PlaneF luma_;

  private:
    PlaneF orientation_, negativePx_, positivePx_, shiftPx_;
};

class Fxaa311 : public FxaaMethod {
  public:
    explicit Fxaa311(const Params& p) : linear_(p.choice("blendSpace") == "linear") {
        args_.edgeThreshold = p.realf("edgeThreshold");
        args_.edgeThresholdMin = p.realf("edgeThresholdMin");
        args_.subpix = p.real("subpix");
        setDistances(args_, presets311()[p.choiceIndex("preset")].stepsPx);
        const auto& luma = p.choice("luma");
        lumaKind_ = luma == "rec601" ? LumaKind::rec601 : luma == "green" ? LumaKind::green : LumaKind::sqrtLinear;
    }
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const bool lumaOfLinear = lumaKind_ == LumaKind::sqrtLinear;
        lumaPlane(lumaOfLinear ? frame.colorLinear : frame.colorEncoded, lumaKind_, exec, luma_);
        const FxaaArgs args = prepare(linear_ ? frame.colorLinear : frame.colorEncoded, out);
        runKernel(fxaaKernelsFor(exec.isa).fxaa311, exec, args, frame.height);
    }

  private:
    bool linear_;
    LumaKind lumaKind_;
};

}  // namespace

MethodDescriptor fxaa311Descriptor() {
    return {
        .id = "fxaa311",
        .title = "FXAA 3.11 Quality",
        .family = "spatial",
        .summary = "Finds the ends of each luma edge along its row or column and shifts the sample across it.",
        .source = "Lottes, FXAA 3.11; methods/02 s.2.1",
        .passes = Pass::color,
        .input = Space::encoded,
        .output = Space::encoded,
        .params = {choiceParam("preset", "12", presetNames(presets311()),
                               "search pattern: 10-15 medium dither, 20-29 less dither, 39 no dither", "FXAA 3.11"),
                   realParam("subpix", "0.75", 0, 1, "removal of sub-pixel aliasing, 0 off", "FXAA 3.11"),
                   realParam("edgeThreshold", "0.166", 0, 1,
                             "contrast that makes an edge, relative to the local maximum", "FXAA 3.11"),
                   realParam("edgeThresholdMin", "0.0833", 0, 1, "least luma contrast that makes an edge", "FXAA 3.11"),
                   choiceParam("luma", "rec601", {"rec601", "sqrtLin", "green"}, "luma that decides where edges are",
                               "FXAA 3.11"),
                   choiceParam("blendSpace", "encoded", {"encoded", "linear"}, "space in which pixels are blended",
                               "FXAA 3.11, author's advice")},
        .create = [](const Params& p, const ShotInfo&) { return std::make_unique<Fxaa311>(p); },
        .outputSpace =
            [](const Params& p) { return p.choice("blendSpace") == "linear" ? Space::linear : Space::encoded; },
        .reachPx = 30};  // methods/08 s.8.4
}
}  // namespace aa
