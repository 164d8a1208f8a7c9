#include "methods/spatial/fxaa.h"

#include "methods/method.h"
#include "methods/spatial/fxaa_base.h"

namespace aa {
namespace {

// [Lottes 2011]: 10-15 medium dither, 20-29 less dither, 39 no dither.
const std::vector<FxaaPreset>& presets311() {
    static const std::vector<FxaaPreset> presets = {
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
class Fxaa311 : public FxaaMethod {
  public:
    explicit Fxaa311(const Params& p)
        : args_(fxaa311Args(p)), linear_(p.choice("blendSpace") == "linear"), lumaKind_(fxaa311Luma(p)) {}
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const bool lumaOfLinear = lumaKind_ == LumaKind::sqrtLinear;
        const Lumas lumas =
            findLuma(lumaOfLinear ? frame.colorLinear : frame.colorEncoded, shownLuma(lumaKind_, frame.display), exec);
        transposeLuma(lumas, frame.width, frame.height, exec);
        prepare(args_, lumas, linear_ ? frame.colorLinear : frame.colorEncoded, out);
        runKernel(fxaaKernelsFor(exec).fxaa311, exec, args_, frame.height);
    }

  private:
    FxaaArgs args_;
    bool linear_;
    LumaKind lumaKind_;
};

}  // namespace

FxaaArgs fxaa311Args(const Params& p) {
    FxaaArgs args{};
    args.edgeThreshold = p.realf("edgeThreshold");
    args.edgeThresholdMin = p.realf("edgeThresholdMin");
    args.subpix = p.real("subpix");
    setDistances(args, presets311()[p.choiceIndex("preset")].stepsPx);
    return args;
}
LumaKind fxaa311Luma(const Params& p) {
    const auto& luma = p.choice("luma");
    return luma == "rec601" ? LumaKind::rec601 : luma == "green" ? LumaKind::green : LumaKind::sqrtLinear;
}

MethodDescriptor fxaa311Descriptor() {
    return {
        .id = "fxaa311",
        .title = "FXAA 3.11 Quality",
        .family = "spatial",
        .summary = "Finds the ends of each luma edge along its row or column and shifts the sample across it.",
        .source = "[Lottes 2011]",
        .passes = Pass::color,
        .input = Space::encoded,
        .output = Space::encoded,
        .params = {choiceParam("preset", "12", presetNames(presets311()),
                               "search pattern: 10-15 medium dither, 20-29 less dither, 39 no dither", "[Lottes 2011]"),
                   realParam("subpix", "0.75", 0, 1, "removal of sub-pixel aliasing, 0 off", "[Lottes 2011]"),
                   realParam("edgeThreshold", "0.166", 0, 1,
                             "contrast that makes an edge, relative to the local maximum", "[Lottes 2011]"),
                   realParam("edgeThresholdMin", "0.0833", 0, 1, "least luma contrast that makes an edge",
                             "[Lottes 2011]"),
                   choiceParam("luma", "rec601", {"rec601", "sqrtLin", "green"}, "luma that decides where edges are",
                               "[Lottes 2011]"),
                   choiceParam("blendSpace", "encoded", {"encoded", "linear"}, "space in which pixels are blended",
                               "[Lottes 2011], author's advice")},
        .create = [](const Params& p, const ShotInfo&) { return std::make_unique<Fxaa311>(p); },
        .outputSpace =
            [](const Params& p) { return p.choice("blendSpace") == "linear" ? Space::linear : Space::encoded; },
        .reachPx = 30};  // conventions 12
}
}  // namespace aa
