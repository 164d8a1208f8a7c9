#include "methods/spatial/dlaa.h"

#include <algorithm>
#include <cmath>

#include "methods/method.h"
#include "methods/working.h"

namespace aa {
namespace {

constexpr int kStripRows = 32;  // of colours, strengths and lumas: 1.2 MB at 1080p

class Dlaa : public Method {
  public:
    explicit Dlaa(const Params& p) {
        args_.lambda = p.realf("lambda");
        args_.epsilon = p.realf("epsilon");
        args_.longThreshold = p.realf("longThreshold");
        args_.preserveHighlights = p.flag("preserveHighlights");
    }
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const Rgb& in = frame.colorEncoded;
        const auto edge = edge_.take(), luma = luma_.take();
        *edge = PlaneF::unset(in.width(), in.height()), *luma = PlaneF::unset(in.width(), in.height());
        strong_.resize(size_t((in.width() + 7) / 8) * size_t(in.height()));
        busy_.resize(strong_.size());
        // A short-edge strength above 0 needs a wide difference above 4 epsilon / lambda, and that is the sum of five
        // second differences. Rounding is far below a thousandth.
        const float busyAbove = args_.lambda > 0 ? 0.999f * 0.8f * args_.epsilon / args_.lambda : INFINITY;
        const DlaaEdgeArgs edges{view(in),    edge->row(0), luma->row(0), strong_.data(), busy_.data(),
                                 in.stride(), in.width(),   in.height(),  busyAbove};
        args_.in = view(in);
        args_.edge = edge->row(0);
        args_.luma = luma->row(0);
        args_.out = view(out);
        args_.stride = in.stride();
        args_.strong = strong_.data();
        args_.busy = busy_.data();
        args_.width = in.width();
        args_.height = in.height();
        if (keepDebugLayers) {
            shortMask_ = longMask_ = PlaneF(in.width(), in.height());
            args_.shortMask = shortMask_.row(0);
            args_.longMask = longMask_.row(0);
        }
        filterPicture(edges, exec);
        if (keepDebugLayers) edgeLayer_ = *edge;
    }
    size_t stateBytes() const override { return edge_.bytes() + luma_.bytes() + strong_.size() + busy_.size(); }
    std::vector<DebugLayer> debugLayers() const override {
        if (!keepDebugLayers) return {};
        return {{"edges", {edgeLayer_}}, {"mask.short", {shortMask_}}, {"mask.long", {longMask_}}};
    }

  private:
    void filterPicture(const DlaaEdgeArgs& edges, const Exec& exec) {
        const int height = edges.height;
        const auto& kernels = dlaaKernelsFor(exec);
        const auto filter = rowsOf(kernels.filter, exec.precision);
        if (exec.parallel) {
            runKernel(kernels.edges, exec, edges, height);
            // Larger blocks than usual: each counts the strong pixels of 17 rows first.
            forRows(
                exec, height, [&](int y0, int y1) { filter(args_, y0, y1); }, 64);
            return;
        }
        // Strip by strip, so that the filter finds in the cache what the edge pass read and wrote.
        for (int y = 0, filtered = 0; y < height; y += kStripRows) {
            const int found = std::min(y + kStripRows, height);
            const int ready = found == height ? found : std::max(0, found - kDlaaReach);
            rowsOf(kernels.edges, exec.precision)(edges, y, found);
            filter(args_, filtered, ready);
            filtered = ready;
        }
    }

    DlaaArgs args_{};
    Working<PlaneF> edge_, luma_;
    PlaneF edgeLayer_, shortMask_, longMask_;
    std::vector<uint8_t> strong_, busy_;
};

}  // namespace

MethodDescriptor dlaaDescriptor() {
    return {
        .id = "dlaa",
        .title = "DLAA",
        .family = "spatial",
        .summary = "Blurs along short edges and matches long ones to the blur along them.",
        .source = "[Andreev 2011], public ports",
        .passes = Pass::color,
        .input = Space::encoded,
        .output = Space::encoded,
        .params = {realParam("lambda", "3", 0, 10, "gain of the short-edge masks", "public port"),
                   realParam("epsilon", "0.1", 0, 1, "contrast below which short edges are left alone", "public port"),
                   realParam("longThreshold", "0.2", 0, 1, "by how much one direction must dominate a long edge",
                             "public port"),
                   flagParam("preserveHighlights", false, "keep pixels in the midst of strong edges", "public port")},
        .create = [](const Params& p, const ShotInfo&) { return std::make_unique<Dlaa>(p); },
        .reachPx = 9};  // 8 px along long edges, whose strength reads one px further
}

}  // namespace aa
