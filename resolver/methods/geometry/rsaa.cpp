#include "methods/geometry/rsaa.h"

#include <algorithm>
#include <optional>

#include "image/error.h"
#include "methods/geometry/rsaa_lut_data.h"
#include "methods/geometry/rsaa_options.h"
#include "methods/geometry/subsample_geometry.h"
#include "methods/method.h"

namespace aa {
namespace {

constexpr double kMaskPassFloor = 0.2;  // decisions 32; blender_addon/aa_resolve/passes/surface_mask.py

constexpr Choice<Dissimilarity> kMeasures[] = {
    {"sadp", Dissimilarity::sadp}, {"depth", Dissimilarity::depth}, {"normal", Dissimilarity::normal}};
constexpr Choice<RsaaTraining> kTrainings[] = {{"all", RsaaTraining::all}, {"halfPlanes", RsaaTraining::halfPlanes}};

// Whether computing the masks would give the mask pass, which was made by the defaults.
bool asTheMaskPass(const RsaaOptions& o, const Params& p) {
    return o.measure == Dissimilarity::sadp && p.real("sadpFloor") == kMaskPassFloor && o.adaptive && o.ids;
}
}  // namespace

RsaaOptions::RsaaOptions(const Params& p)
    : measure(p.chosen("measure", kMeasures)),
      floor(p.realf(measure == Dissimilarity::sadp    ? "sadpFloor"
                    : measure == Dissimilarity::depth ? "depthFloor"
                                                      : "normalFloor")),
      adaptive(p.choice("clustering") == "adaptive"),
      tuning(p.choice("tuning") != "off"),
      tuneAdaptive(p.choice("tuning") == "adaptive"),
      quadrant(p.choice("neighbours") == "quadrant"),
      ids(p.flag("ids")),
      maskPass(p.choice("mask") == "pass" || (p.choice("mask") == "auto" && asTheMaskPass(*this, p))),
      training(p.chosen("training", kTrainings)) {}

std::vector<float> rsaaOffsets(const std::vector<glm::dvec2>& positionsPx, RsaaTraining training) {
    const size_t samples = positionsPx.size();
    const auto shipped = shippedRsaaEntries(samples);
    if (training == RsaaTraining::all && !shipped.empty() && positionsPx == d3dPattern(samples))
        return rsaaTable(samples, shipped);
    return rsaaTable(samples, learnRsaa(positionsPx, training));
}

RsaaNeighbours rsaaNeighbours(glm::vec2 offsetPx, bool quadrant) {
    const int sx = offsetPx.x < 0 ? -1 : 1, sy = offsetPx.y < 0 ? -1 : 1;
    if (quadrant) return {{{sx, 0}, {0, sy}, {sx, sy}}, 3};
    static const glm::ivec2 axisFirst[] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    const auto distance2 = [&](glm::ivec2 n) {
        const float dx = offsetPx.x - float(n.x), dy = offsetPx.y - float(n.y);
        return dx * dx + dy * dy;
    };
    const glm::ivec2 nearest =
        *std::min_element(std::begin(axisFirst), std::end(axisFirst),
                          [&](glm::ivec2 a, glm::ivec2 b) { return distance2(a) < distance2(b); });
    return {{{nearest.x, nearest.y}}, 1};
}

namespace {
class RsaaMethod : public Method {
  public:
    RsaaMethod(const RsaaOptions& options, const std::vector<glm::dvec2>& positionsPx)
        : options_(options), offsetsPx_(rsaaOffsets(positionsPx, options.training)) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        RsaaArgs a{};
        a.color = view(frame.colorLinear), a.out = view(out);
        a.stride = out.stride(), a.width = frame.width, a.height = frame.height;
        a.samples = int(frame.subSamples.size()), a.offsetsPx = offsetsPx_.data();
        a.measure = options_.measure, a.floor = options_.floor, a.adaptive = options_.adaptive;
        a.tuning = options_.tuning, a.tuneAdaptive = options_.tuneAdaptive;
        if (options_.maskPass) a.maskPass = frame.subSampleMask.row(0);
        const GeometryArgs notRead{};
        a.geometry = &notRead;
        std::optional<GeometryViews> geometry;
        std::vector<RsaaNeighbours> neighbours;
        if (options_.readsGeometry()) {
            geometry.emplace(frame, options_.needs(), "rsaa:measure=sadp");
            for (int k = 0; k < a.samples; k++)
                neighbours.push_back(rsaaNeighbours(frame.subSamplePositionsPx[size_t(k)], options_.quadrant));
            a.geometry = &geometry->args(), a.neighbours = neighbours.data();
        }
        if (keepDebugLayers) keepLayers(frame, a);
        runKernel(rsaaKernelsFor(exec).resolve, exec, a, frame.height);
    }
    size_t stateBytes() const override { return offsetsPx_.size() * sizeof(float); }
    std::vector<DebugLayer> debugLayers() const override { return layers_; }

  private:
    void keepLayers(const Frame& frame, RsaaArgs& a) {
        layers_.clear();
        for (const char* layer : {"mask", "tunedMask", "dissimilarity", "offsetXPx", "offsetYPx"})
            layers_.push_back({layer, {PlaneF(frame.width, frame.height)}});
        a.maskLayer = layers_[0].planes[0].row(0), a.tunedLayer = layers_[1].planes[0].row(0);
        a.dissimilarityLayer = layers_[2].planes[0].row(0);
        a.offsetXLayer = layers_[3].planes[0].row(0), a.offsetYLayer = layers_[4].planes[0].row(0);
    }

    RsaaOptions options_;
    std::vector<float> offsetsPx_;
    std::vector<DebugLayer> layers_;
};

}  // namespace

MethodDescriptor rsaaDescriptor() {
    return {
        .id = "rsaa",
        .title = "Resampling anti-aliasing",
        .family = "geometry",
        .summary =
            "Fetches the colour beside the pixel centre, at an offset learned for its mask of sub-samples on other "
            "surfaces.",
        .source = "[Reshetov 2012]",
        .passes = Pass::color,
        .params = {choiceParam("measure", "sadp", kMeasures, "dissimilarity of two geometry samples",
                               "[Reshetov 2012, slides 24-27]"),
                   realParam("sadpFloor", "0.2", 0.001, 2, "below this SADP everything is one surface", "decisions 32",
                             "measure=sadp"),
                   realParam("depthFloor", "0.02", 0.0001, 2, "below this relative depth everything is one surface",
                             "decisions 32", "measure=depth"),
                   realParam("normalFloor", "0.1", 0.001, 2, "below this 1 - cosine everything is one surface",
                             "decisions 32", "measure=normal"),
                   choiceParam("clustering", "adaptive", {"adaptive", "threshold"},
                               "similar or different by one k-means iteration, or by the floor alone",
                               "[Reshetov 2012, slides 20-22]; decisions 32", "mask=auto|geometry"),
                   choiceParam(
                       "tuning", "on", {"on", "off", "adaptive"},
                       "drop different sub-samples that no neighbour shows; adaptive: nearer than half of the own "
                       "dissimilarity counts as shown",
                       "[Reshetov 2012, slides 32-33]; decisions 34"),
                   choiceParam("neighbours", "quadrant", {"quadrant", "nearest"},
                               "who may show it: the three pixels on the sub-sample's side, or the one nearest to it",
                               "ours: nearest costs 1.8 dB on isolated edges", "tuning=on|adaptive"),
                   choiceParam("mask", "auto", {"auto", "geometry", "pass"},
                               "computed here, or the shot's mask pass; auto: the pass where both are the same",
                               "ours"),
                   flagParam("ids", true, "sub-samples on another object are different whatever their geometry",
                             "ours: the shot's mask pass does so"),
                   choiceParam("training", "all", kTrainings, "what the offsets were learned from", "decisions 33")},
        .create = [](const Params& p, const ShotInfo& shot) -> std::unique_ptr<Method> {
            requireSubSamples(shot.subSamplePositionsPx, "rsaa", size_t(kRsaaMaxSamples));
            return std::make_unique<RsaaMethod>(RsaaOptions(p), shot.subSamplePositionsPx);
        },
        .morePasses =
            [](const Params& p) {
                const RsaaOptions o(p);
                const PassSet passes = o.needs().passes();
                return o.maskPass ? passes | Pass::subsampleMask : passes;
            },
        .reachPx = 2};
}
}  // namespace aa
