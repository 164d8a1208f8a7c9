#include "methods/geometry/gpaa.h"

#include <algorithm>
#include <cmath>

#include "methods/method.h"

namespace aa {
namespace {

// The segments that may touch each row, in list order.
struct SegmentsOfRows {
    std::vector<uint32_t> first, segment;  // those of row y: segment[first[y]..first[y + 1]]

    void build(const std::vector<EdgeSegment>& segments, glm::dvec2 jitterPx, int width, int height) {
        first.assign(size_t(height) + 1, 0);
        const auto forRowsOf = [&](const EdgeSegment& s, const auto& fn) {
            // A pixel at most: half of one across the segment, half of one beyond its end.
            const auto [left, right] = std::minmax({double(s.x0), double(s.x1)});
            const auto [top, bottom] = std::minmax({double(s.y0), double(s.y1)});
            const double from = std::max(0.0, std::ceil(top - jitterPx.y - 1.5)),
                         to = std::min(double(height - 1), std::floor(bottom - jitterPx.y + 0.5));
            if (!(left - jitterPx.x - 1 <= width && right - jitterPx.x + 1 >= 0 && from <= to)) return;
            for (int y = int(from); y <= int(to); y++) fn(size_t(y));
        };
        for (const auto& s : segments) forRowsOf(s, [&](size_t y) { first[y + 1]++; });
        for (size_t y = 0; y < size_t(height); y++) first[y + 1] += first[y];
        segment.resize(first.back());
        std::vector<uint32_t> next(first.begin(), first.end() - 1);
        for (size_t i = 0; i < segments.size(); i++)
            forRowsOf(segments[i], [&](size_t y) { segment[next[y]++] = uint32_t(i); });
    }
    size_t bytes() const { return (first.size() + segment.size()) * sizeof(uint32_t); }
};

class Gpaa : public Method {
  public:
    explicit Gpaa(const Params& p)
        : depthTest_(p.choice("depthTest") != "off"),
          farther_(p.choice("depthTest") == "farther"),
          keepNearest_(p.choice("keep") == "nearest"),
          depthLimit_(float(1 + p.real("depthBias"))) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        if (shiftXPx_.width() != frame.width || shiftXPx_.height() != frame.height)
            shiftXPx_ = shiftYPx_ = PlaneF(frame.width, frame.height);
        rows_.build(frame.segments, frame.jitterPx, frame.width, frame.height);
        const GpaaArgs a{.color = view(frame.colorLinear),
                         .out = view(out),
                         .depthView = depthTest_ ? frame.depthView.row(0) : nullptr,
                         .stride = out.stride(),
                         .width = frame.width,
                         .segments = frame.segments.data(),
                         .firstOfRow = rows_.first.data(),
                         .ofRow = rows_.segment.data(),
                         .jitterXPx = float(frame.jitterPx.x),
                         .jitterYPx = float(frame.jitterPx.y),
                         .perspective = !frame.camera || frame.camera->kind != "orthographic",
                         .farther = farther_,
                         .keepNearest = keepNearest_,
                         .depthLimit = depthLimit_,
                         .shiftXPx = shiftXPx_.row(0),
                         .shiftYPx = shiftYPx_.row(0)};
        runKernel(gpaaKernelsFor(exec).resolve, exec, a, frame.height);
    }
    size_t stateBytes() const override { return shiftXPx_.bytes() + shiftYPx_.bytes() + rows_.bytes(); }
    std::vector<DebugLayer> debugLayers() const override {
        if (!keepDebugLayers) return {};
        return {{"offsetXPx", {shiftXPx_}}, {"offsetYPx", {shiftYPx_}}};
    }

  private:
    bool depthTest_, farther_, keepNearest_;
    float depthLimit_;
    SegmentsOfRows rows_;
    PlaneF shiftXPx_, shiftYPx_;
};

}  // namespace

MethodDescriptor gpaaDescriptor() {
    return {
        .id = "gpaa",
        .title = "Geometric post-process anti-aliasing",
        .family = "geometry",
        .summary = "Draws the edges of the geometry over the picture and blends what they cross.",
        .source = "[Persson 2011]",
        .passes = Pass::color | Pass::segments,
        .params = {choiceParam("keep", "last", {"last", "nearest"},
                               "of several edges in a pixel: the last in the list, or the one nearest to the centre",
                               "[Persson 2011]; nearest is ours"),
                   choiceParam("depthTest", "pixel", {"pixel", "farther", "off"},
                               "hidden edges: behind the pixel, behind it and its neighbour beyond, or none",
                               "[Persson 2011]; farther is ours"),
                   realParam("depthBias", "0.001", 0, 10, "an edge this much behind, relative, is not hidden", "ours",
                             "depthTest=pixel|farther")},
        .create = [](const Params& p, const ShotInfo&) -> std::unique_ptr<Method> { return std::make_unique<Gpaa>(p); },
        .morePasses = [](const Params& p) { return p.choice("depthTest") == "off" ? PassSet{} : PassSet(Pass::depth); },
        .reachPx = 2};
}
}  // namespace aa
