#include "methods/geometry/msaa.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "image/error.h"
#include "methods/geometry/msaa_slots.h"
#include "methods/geometry/subsample_geometry.h"
#include "methods/method.h"
#include "methods/reference/resolve_filters.h"

namespace aa {
namespace {

double distance2(glm::dvec2 a, glm::dvec2 b) { return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y); }

// Which sub-samples hold a colour, then the rest. spread: the one farthest from the centre, then always the one
// farthest from those chosen.
std::vector<int> slotsFirst(const std::vector<glm::dvec2>& positionsPx, int slots, bool spread) {
    std::vector<int> order(positionsPx.size());
    std::iota(order.begin(), order.end(), 0);
    if (!spread) return order;
    const auto position = [&](int k) { return positionsPx[size_t(k)]; };
    for (auto chosen = order.begin(); chosen != order.begin() + slots; ++chosen) {
        const auto separation2 = [&](int k) {
            double nearest = chosen == order.begin() ? distance2(position(k), {}) : 4.0;
            for (auto c = order.begin(); c != chosen; ++c)
                nearest = std::min(nearest, distance2(position(k), position(*c)));
            return nearest;
        };
        std::iter_swap(chosen, std::max_element(chosen, order.end(),
                                                [&](int a, int b) { return separation2(a) < separation2(b); }));
    }
    return order;
}

CoverageSlots coverageSlots(std::string_view id, const Params& p, const std::vector<glm::dvec2>& positionsPx, int slots,
                            bool spread) {
    CoverageSlots s;
    s.slotsFirst = slotsFirst(positionsPx, slots, spread), s.slots = slots;
    const auto position = [&](int k) { return positionsPx[size_t(s.slotsFirst[size_t(k)])]; };
    if (p.choice("filter") != "box") {
        ResolveShape shape{.filter = chosenFilter(p), .diameterPx = p.real("diameter")};
        s.taps = resolveTaps(withOwnDiameter(shape), positionsPx, id);
        for (auto& tap : s.taps)
            tap.sample = int(std::find(s.slotsFirst.begin(), s.slotsFirst.end(), tap.sample) - s.slotsFirst.begin());
    }
    s.order.resize(positionsPx.size());
    std::iota(s.order.begin(), s.order.end(), 0);
    s.nearestSlot = s.order;
    for (int& nearest : s.nearestSlot) {
        const glm::dvec2 own = position(nearest);
        nearest = *std::min_element(s.order.begin(), s.order.begin() + slots, [&](int a, int b) {
            return distance2(position(a), own) < distance2(position(b), own);
        });
    }
    std::stable_sort(s.order.begin(), s.order.end(),
                     [&](int a, int b) { return distance2(position(a), {}) < distance2(position(b), {}); });
    return s;
}
}  // namespace

GeometryNeeds surfaceNeeds(const Params& p) {
    const bool surface = p.choice("key") == "surface";
    return {.depth = surface, .normals = surface, .ids = true, .colors = true, .camera = surface};
}

CoverageSlots msaaSlots(const Params& p, const std::vector<glm::dvec2>& positionsPx) {
    return coverageSlots("msaa", p, positionsPx, int(positionsPx.size()), false);
}
CoverageSlots csaaSlots(const Params& p, const std::vector<glm::dvec2>& positionsPx) {
    const int slots = p.integer("slots"), samples = int(positionsPx.size());
    if (slots > samples)
        throw UsageError("csaa: slots=" + std::to_string(slots) + ", and the shot has only " + std::to_string(samples) +
                         " sub-samples per pixel; choose at most that many");
    return coverageSlots("csaa", p, positionsPx, slots, p.choice("slotPositions") == "spread");
}

namespace {
class MsaaMethod : public Method {
  public:
    MsaaMethod(std::string_view id, const Params& p, CoverageSlots slots)
        : id_(id),
          slots_(std::move(slots)),
          needs_(surfaceNeeds(p)),
          centroid_(p.choice("shadingPosition") == "centroid"),
          encoded_(averagedSpace(p) == Space::encoded),
          inverseLuminance_(p.choice("resolve") == "inverseLuminance") {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const GeometryViews geometry(frame, needs_, id_ + ":key=surface");
        GeometryArgs permuted = geometry.args();
        std::vector<SubSampleArgs> samples;
        for (const int k : slots_.slotsFirst) samples.push_back(geometry.args().sample[k]);
        permuted.sample = samples.data();
        MsaaArgs a{.color = view(frame.colorLinear),
                   .copied = view(encoded_ ? frame.colorEncoded : frame.colorLinear),
                   .out = view(out),
                   .geometry = &permuted,
                   .rule = kSameSurface,
                   .slots = slots_.slots,
                   .order = slots_.order.data(),
                   .nearestSlot = slots_.nearestSlot.data(),
                   .byGeometry = needs_.normals,
                   .centroid = centroid_,
                   .encoded = encoded_,
                   .display = displayArgs(frame.display),
                   .inverseLuminance = inverseLuminance_,
                   .sampleColors = nullptr,
                   .surfacesLayer = nullptr,
                   .coverageLayer = nullptr};
        std::vector<RgbOut> sampleColors;
        if (!slots_.taps.empty()) {
            sampleColors_.resize(samples.size());
            for (Rgb& c : sampleColors_) {
                if (c.width() != frame.width || c.height() != frame.height) c = Rgb(frame.width, frame.height);
                sampleColors.push_back(view(c));
            }
            a.sampleColors = sampleColors.data();
        }
        layers_.clear();
        if (keepDebugLayers) {
            for (const char* layer : {"surfaces", "centreCoverage"})
                layers_.push_back({layer, {PlaneF(frame.width, frame.height)}});
            a.surfacesLayer = layers_[0].planes[0].row(0), a.coverageLayer = layers_[1].planes[0].row(0);
        }
        runKernel(msaaKernelsFor(exec).resolve, exec, a, frame.height);
        if (!slots_.taps.empty()) filter(exec, out);
    }
    size_t stateBytes() const override {
        size_t bytes = 0;
        for (const Rgb& c : sampleColors_) bytes += c.bytes();
        return bytes;
    }
    std::vector<DebugLayer> debugLayers() const override { return layers_; }

  private:
    void filter(const Exec& exec, Rgb& out) {
        std::vector<RgbIn> samples;
        for (Rgb& c : sampleColors_) {
            c.fillBorder();
            samples.push_back(view(std::as_const(c)));
        }
        const ResolveArgs args{.samples = samples.data(),
                               .sampleCount = int(samples.size()),
                               .taps = slots_.taps.data(),
                               .tapCount = int(slots_.taps.size()),
                               .inverseLuminance = false,
                               .luminanceScale = 1,
                               .out = view(out),
                               .stride = out.stride(),
                               .width = out.width()};
        runKernel(resolveKernelsFor(exec).resolve, exec, args, out.height());
        if (encoded_) clampToDisplay(exec, out);
    }
    // Filters with negative weights leave the range of displayed values.
    static void clampToDisplay(const Exec& exec, Rgb& out) {
        forRows(exec, out.height(), [&](int y0, int y1) {
            for (auto& channel : out.c)
                for (int y = y0; y < y1; y++)
                    for (int x = 0; x < out.width(); x++) channel.at(x, y) = std::clamp(channel.at(x, y), 0.0f, 1.0f);
        });
    }

    std::string id_;
    CoverageSlots slots_;
    GeometryNeeds needs_;
    bool centroid_, encoded_, inverseLuminance_;
    std::vector<Rgb> sampleColors_;  // what the filter reads: the colour of every sub-sample's surface
    std::vector<DebugLayer> layers_;
};

std::vector<ParamSpec> surfaceParams() {
    return {choiceParam("key", "surface", {"surface", "object"}, "what is shaded once: a surface, or a whole object",
                        "ours: no triangle ids are exported"),
            choiceParam("shadingPosition", "centre", {"centre", "centroid"},
                        "where a partly covered surface is shaded when it covers the centre", "ours"),
            filterParam("[Akeley 1993]; other filters: [Pettineo 2012]"),
            realParam("diameter", "0", 0, 8, "of the filter, px; 0: its own (lanczos 4, others 2)", "[Pettineo 2012]",
                      "filter=tent|gaussian|smoothstep|bspline|mitchell|catmullRom|cubic|blackmanHarris|sinc|lanczos"),
            choiceParam("resolve", "linear", {"linear", "inverseLuminance"},
                        "weights of the colours: 1, or 1 / (1 + luminance)", "conventions 4", "filter=box"),
            averagedSpaceParam()};
}

}  // namespace

MethodDescriptor msaaDescriptor() {
    return {.id = "msaa",
            .title = "Multisampling",
            .family = "geometry",
            .summary = "Every surface in a pixel is shaded once and weighted by the sub-samples that it covers.",
            .source = "[Akeley 1993]",
            .passes = Pass::color,
            .params = surfaceParams(),
            .create = [](const Params& p, const ShotInfo& shot) -> std::unique_ptr<Method> {
                requireSubSamples(shot.subSamplePositionsPx, "msaa", size_t(kMsaaMaxSamples));
                return std::make_unique<MsaaMethod>("msaa", p, msaaSlots(p, shot.subSamplePositionsPx));
            },
            .morePasses = [](const Params& p) { return surfaceNeeds(p).passes(); },
            .outputSpace = averagedSpace,
            .reachPx = 5,  // the widest filter's radius and a pixel
            .publishedMemory = {{2, 39.6, "[Stejmar n.d., table 5.6]"},
                                {4, 91, "[Stejmar n.d., table 5.6]"},
                                {8, 209.6, "[Stejmar n.d., table 5.6]"}}};
}

MethodDescriptor csaaDescriptor() {
    MethodDescriptor d = msaaDescriptor();
    d.id = "csaa";
    d.title = "Coverage sampling";
    d.summary = "Multisampling with fewer stored colours than coverage samples.";
    d.source = "[Young 2006]";
    d.publishedMemory = {};
    const std::vector<ParamSpec> slotParams = {
        intParam("slots", "4", 1, kMsaaMaxSamples, "sub-samples that hold a colour: 8x and 16x have 4, the Q modes 8",
                 "[Young 2006]"),
        choiceParam("slotPositions", "first", {"first", "spread"},
                    "the first sub-samples of the pattern, or those farthest apart",
                    "ours: the real positions are undisclosed")};
    for (ParamSpec& p : d.params)
        if (p.name == "filter") std::erase(p.choices, "quincunx");  // two sub-samples: nothing to leave out
    d.params.insert(d.params.begin(), slotParams.begin(), slotParams.end());
    d.create = [](const Params& p, const ShotInfo& shot) -> std::unique_ptr<Method> {
        requireSubSamples(shot.subSamplePositionsPx, "csaa", size_t(kMsaaMaxSamples));
        return std::make_unique<MsaaMethod>("csaa", p, csaaSlots(p, shot.subSamplePositionsPx));
    };
    return d;
}
}  // namespace aa
