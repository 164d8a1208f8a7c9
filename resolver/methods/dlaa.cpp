#include "methods/dlaa.h"

#include "methods/dlaa_kernels.h"

namespace aa {
namespace {

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
        if (edge_.width() != in.width() || edge_.height() != in.height()) edge_ = PlaneF(in.width(), in.height());
        strong_.resize(size_t((in.width() + 7) / 8) * size_t(in.height()));
        const auto& kernels = dlaaKernelsFor(exec.isa);
        runKernel(kernels.edges, exec, DlaaEdgeArgs{view(in), edge_.row(0), strong_.data(), in.stride(), in.width()},
                  in.height());
        edge_.fillBorder();
        args_.in = view(in);
        args_.edge = edge_.row(0);
        args_.out = view(out);
        args_.stride = in.stride();
        args_.strong = strong_.data();
        args_.width = in.width();
        args_.height = in.height();
        if (keepDebugLayers) {
            shortMask_ = longMask_ = PlaneF(in.width(), in.height());
            args_.shortMask = shortMask_.row(0);
            args_.longMask = longMask_.row(0);
        }
        // Larger blocks than usual: each counts the strong pixels of 17 rows first.
        const auto& filter = kernels.filter;
        const auto fn = exec.precision == Precision::fast     ? filter.fast
                        : exec.precision == Precision::scalar ? filter.scalar
                                                              : filter.oracle;
        forRows(
            exec, in.height(), [&](int y0, int y1) { fn(args_, y0, y1); }, 64);
    }
    size_t stateBytes() const override { return edge_.bytes() + strong_.size(); }
    std::vector<DebugLayer> debugLayers() const override {
        if (!keepDebugLayers) return {};
        return {{"edges", {edge_}}, {"mask.short", {shortMask_}}, {"mask.long", {longMask_}}};
    }

  private:
    DlaaArgs args_{};
    PlaneF edge_, shortMask_, longMask_;
    std::vector<uint8_t> strong_;
};

}  // namespace

MethodDescriptor dlaaDescriptor() {
    return {
        .id = "dlaa",
        .title = "DLAA",
        .family = "spatial",
        .summary = "Blurs along short edges and matches long ones to the blur along them.",
        .source = "Andreev 2011 (public ports); methods/04 s.4.1",
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
