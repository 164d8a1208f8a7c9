#include "methods/spatial/fxaa.h"
#include "methods/spatial/fxaa_base.h"

namespace aa {
namespace {

struct Fxaa1Preset {
    float threshold, thresholdMin;
    int steps, acceleration;
    double cap;
    bool cross;
};
// [Lottes 2009]. Presets above 3 only lengthen the search.
constexpr Choice<Fxaa1Preset> kFxaa1Presets[] = {
    {"0", {1.f / 4, 1.f / 12, 2, 4, 2.0 / 3, true}},   {"1", {1.f / 8, 1.f / 16, 4, 3, 3.0 / 4, false}},
    {"2", {1.f / 8, 1.f / 24, 8, 2, 3.0 / 4, false}},  {"3", {1.f / 8, 1.f / 24, 16, 1, 3.0 / 4, false}},
    {"4", {1.f / 8, 1.f / 24, 24, 1, 3.0 / 4, false}}, {"5", {1.f / 8, 1.f / 24, 32, 1, 3.0 / 4, false}},
};

class Fxaa1 : public FxaaMethod {
  public:
    explicit Fxaa1(const Params& p) : args_(fxaa1Args(p)) {}
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const Lumas lumas = findLuma(frame.colorEncoded, LumaKind::redGreen, exec);
        prepare(args_, lumas, frame.colorEncoded, out);
        runKernel(fxaaVariantKernelsFor(exec).fxaa1, exec, args_, frame.height);
    }

  private:
    Fxaa1Args args_;
};

class FxaaCs : public FxaaMethod {
  public:
    explicit FxaaCs(const Params& p) : args_(fxaaCsArgs(p)), linear_(p.choice("blendSpace") == "linear") {}
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const Lumas lumas = findLuma(frame.colorLinear, shownLuma(LumaKind::log2Linear, frame.display), exec);
        transposeLuma(lumas, frame.width, frame.height, exec);
        prepare(args_, lumas, linear_ ? frame.colorLinear : frame.colorEncoded, out);
        runKernel(fxaaVariantKernelsFor(exec).fxaaCs, exec, args_, frame.height);
    }

  private:
    FxaaCsArgs args_;
    bool linear_;
};

class FxaaConsole : public FxaaMethod {
  public:
    explicit FxaaConsole(const Params& p) : args_(fxaaConsoleArgs(p)) {}
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const Lumas lumas = findLuma(frame.colorEncoded, LumaKind::rec601, exec);
        prepare(args_, lumas, frame.colorEncoded, out);
        runKernel(fxaaVariantKernelsFor(exec).console, exec, args_, frame.height);
    }
    std::vector<DebugLayer> debugLayers() const override {
        if (!keepDebugLayers) return {};
        // Direction of the taps, and 1 where the outer ones count.
        return {{"taps", {negativePx_, positivePx_, shiftPx_}}};
    }

  private:
    FxaaConsoleArgs args_;
};

}  // namespace

Fxaa1Args fxaa1Args(const Params& p) {
    const Fxaa1Preset& preset = p.chosen("preset", kFxaa1Presets);
    Fxaa1Args args{};
    args.edgeThreshold = preset.threshold;
    args.edgeThresholdMin = preset.thresholdMin;
    args.steps = preset.steps;
    args.acceleration = preset.acceleration;
    args.subpixCap = preset.cap;
    args.subpixTrim = 0.25;
    args.crossLowPass = preset.cross;
    return args;
}
FxaaCsArgs fxaaCsArgs(const Params& p) {
    FxaaCsArgs args{};
    args.edgeThreshold = 0;
    args.edgeThresholdMin = p.realf("contrastThreshold");
    args.subpix = p.real("subpixelRemoval");
    if (p.choice("preset") == "25")
        setDistances(args, {1, 1.5, 2, 2, 2, 2, 4, 8});
    else
        setDistances(args, {1, 1, 1, 1, 1, 1.5, 2, 2, 2, 2, 4, p.choice("longest") == "36.5" ? 18.0 : 8.0});
    return args;
}
FxaaConsoleArgs fxaaConsoleArgs(const Params& p) {
    FxaaConsoleArgs args{};
    args.edgeThreshold = p.realf("edgeThreshold");
    args.edgeThresholdMin = p.realf("edgeThresholdMin");
    args.reachPx = p.real("reach");
    args.sharpness = p.real("sharpness");
    return args;
}

MethodDescriptor fxaa1Descriptor() {
    return {
        .id = "fxaa1",
        .title = "FXAA 1",
        .family = "spatial",
        .summary = "White-paper FXAA: exhaustive search of both edge ends, 3x3 low-pass against sub-pixel aliasing.",
        .source = "[Lottes 2009]",
        .passes = Pass::color,
        .input = Space::encoded,
        .output = Space::encoded,
        .params = {choiceParam("preset", "3", kFxaa1Presets, "thresholds and search length; above 3 only longer",
                               "[Lottes 2009]")},
        .create = [](const Params& p, const ShotInfo&) { return std::make_unique<Fxaa1>(p); },
        .reachPx = 36,  // preset 5 reads 32 px along the edge and its neighbours
        .publishedMemory = {{0, 0, "[Stejmar n.d., table 5.6]"}}};
}

MethodDescriptor fxaaCsDescriptor() {
    return {
        .id = "fxaacs",
        .title = "FXAA for compute shaders",
        .family = "spatial",
        .summary = "FXAA with log-luma decisions and a blend with one neighbour in linear light.",
        .source = "[Stanard n.d.]",
        .passes = Pass::color,
        .input = Space::encoded,
        .output = Space::linear,
        .params = {choiceParam("preset", "25", {"25", "39"}, "search pattern", "[Stanard n.d.]"),
                   choiceParam("longest", "26.5", {"26.5", "36.5"}, "distance of the last, unsampled step, px",
                               "decisions 38", "preset=39"),
                   realParam("contrastThreshold", "0.175", 0.01, 1, "least range of log luma that makes an edge",
                             "[Stanard n.d.]"),
                   realParam("subpixelRemoval", "0.5", 0, 1, "removal of sub-pixel aliasing, 0 off", "[Stanard n.d.]"),
                   choiceParam("blendSpace", "linear", {"linear", "encoded"}, "space in which pixels are blended",
                               "[Stanard n.d.]")},
        .create = [](const Params& p, const ShotInfo&) { return std::make_unique<FxaaCs>(p); },
        .outputSpace =
            [](const Params& p) { return p.choice("blendSpace") == "linear" ? Space::linear : Space::encoded; },
        .reachPx = 30,  // as fxaa311
        .publishedMemory = {{0, 9.9, "[Stejmar n.d., table 5.6]"}}};
}

MethodDescriptor fxaaConsoleDescriptor() {
    return {.id = "fxaaconsole",
            .title = "FXAA 3.11 Console",
            .family = "spatial",
            .summary = "Four taps along the local edge direction, found from the luma of the pixel's corners.",
            .source = "[Lottes 2011], console path",
            .passes = Pass::color,
            .input = Space::encoded,
            .output = Space::encoded,
            .params = {realParam("reach", "0.5", 0.1, 1, "distance of the inner taps, px; 0.33 is sharper",
                                 "[Lottes 2011]"),
                       realParam("sharpness", "8", 1, 16, "how soon the outer taps reach 4 px; 4 softer, 2 very soft",
                                 "[Lottes 2011]"),
                       realParam("edgeThreshold", "0.125", 0, 1, "contrast that makes an edge, relative to the maximum",
                                 "[Lottes 2011]"),
                       realParam("edgeThresholdMin", "0.05", 0.01, 1, "least luma contrast that makes an edge",
                                 "[Lottes 2011]")},
            .create = [](const Params& p, const ShotInfo&) { return std::make_unique<FxaaConsole>(p); },
            .reachPx = 6};  // outer taps at 4 px, bilinear
}

}  // namespace aa
