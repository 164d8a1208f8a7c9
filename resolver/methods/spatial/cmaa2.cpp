#include "methods/spatial/cmaa2.h"

#include "methods/method.h"
#include "methods/spatial/edge_plane.h"
#include "methods/spatial/luma.h"
#include "methods/working.h"

namespace aa {
namespace {

// Thresholds of CMAA2 v2.3; custom has a parameter of its own.
constexpr Choice<float> kPresets[] = {
    {"LOW", 0.15f}, {"MEDIUM", 0.10f}, {"HIGH", 0.07f}, {"ULTRA", 0.05f}, {"custom", 0}};
}  // namespace

Cmaa2Settings cmaa2Settings(const Params& p) {
    const bool sharp = p.flag("sharp");
    Cmaa2Settings s;
    s.threshold = p.choice("preset") == "custom" ? p.realf("threshold") : p.chosen("preset", kPresets);
    s.localContrast = sharp ? 0.15f : 0.10f;
    s.blend.simpleBlur = sharp ? 0.07 : 0.10;
    s.blend.dampening = sharp ? 0.11 : 0.15;
    s.blend.fadeFrom = sharp ? 1.15 : 1.30;
    s.blend.fadePerEdge = sharp ? 1.0 / 8 : 1.0 / 10;
    s.blend.symmetryCorrection = p.real("symmetryCorrection");
    s.blend.longestPx = p.integer("maxLine");
    return s;
}

namespace {
class Cmaa2 : public Method {
  public:
    explicit Cmaa2(const Params& p) : settings_(cmaa2Settings(p)), linear_(p.choice("blendSpace") == "linear") {}
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        width_ = frame.width;
        height_ = frame.height;
        findEdges(frame, exec);
        const Rgb& in = linear_ ? frame.colorLinear : frame.colorEncoded;
        Cmaa2BlendArgs args = settings_.blend;
        prepare(args, in, out);
        const auto& kernels = cmaa2KernelsFor(exec);
        runKernel(kernels.rows, exec, args, height_);
        sortByColumn();
        args.columnStart = columnStart_.data();
        args.columnRows = columnRows_.data();
        runKernel(kernels.columns, exec, args, width_);
        runKernel(kernels.normalise, exec, args, height_);
    }
    size_t stateBytes() const override {
        return luma_.bytes() + edges_.bytes() + all_.bytes() + (stored_.size() + verticals_.size()) * sizeof(uint16_t) +
               (verticalCount_.size() + columnStart_.size() + columnRows_.size()) * sizeof(int);
    }
    std::vector<DebugLayer> debugLayers() const override {
        if (!keepDebugLayers) return {};
        DebugLayer edges{"edges", std::vector<PlaneF>(3, PlaneF(width_, height_))};  // right, bottom, blurred
        for (int y = 0; y < height_; y++)
            for (int x = 0; x < width_; x++) {
                edges.planes[0].at(x, y) = all_.row(y)[x] & kCmaaRight ? 1.0f : 0.0f;
                edges.planes[1].at(x, y) = all_.row(y)[x] & kCmaaBottom ? 1.0f : 0.0f;
                const bool blurred = stored_[size_t(y) * size_t(width_) + size_t(x)] & kCmaaBlurred;
                edges.planes[2].at(x, y) = blurred ? 1.0f : 0.0f;
            }
        // shapes: 1, 2 horizontal lines (2: inverted), 3, 4 vertical ones; lengths of their arms, px.
        return {edges, {"blur", {blur_}}, {"shapes", {shape_, lengthLeft_, lengthRight_}}};
    }

  private:
    void findEdges(const Frame& frame, const Exec& exec) {
        const auto luma = luma_.take();
        lumaPlane(frame.colorLinear, shownLuma(LumaKind::linearOfSqrt, frame.display), exec, *luma);
        edges_.resize(width_, height_, 4);
        all_.resize(width_, height_, 4);
        const auto& kernels = cmaa2KernelsFor(exec);
        runKernel(kernels.edges, exec,
                  Cmaa2EdgeArgs{luma->row(0), edges_.row(0), luma->stride(), edges_.stride(), width_,
                                settings_.threshold, settings_.localContrast},
                  height_);
        edges_.clearBesideTheRows();
        runKernel(kernels.join, exec, Cmaa2JoinArgs{edges_.row(0), all_.row(0), edges_.stride(), width_}, height_);
    }
    void prepare(Cmaa2BlendArgs& args, const Rgb& in, Rgb& out) {
        stored_.resize(size_t(width_) * size_t(height_));
        verticals_.resize(stored_.size());
        verticalCount_.resize(size_t(height_));
        args.edges = all_.row(0);
        args.in = view(in);
        args.out = view(out);
        args.stored = stored_.data();
        args.verticals = verticals_.data();
        args.verticalCount = verticalCount_.data();
        args.stride = in.stride();
        args.edgeStride = all_.stride();
        args.width = width_;
        if (!keepDebugLayers) return;
        blur_ = shape_ = lengthLeft_ = lengthRight_ = PlaneF(width_, height_);
        args.blur = blur_.row(0);
        args.shape = shape_.row(0);
        args.lengthLeft = lengthLeft_.row(0);
        args.lengthRight = lengthRight_.row(0);
    }
    // Vertical lines write along columns: one column, one thread, from the top.
    void sortByColumn() {
        columnStart_.assign(size_t(width_) + 1, 0);
        forEachVertical([&](int x, int) { columnStart_[size_t(x) + 1]++; });
        for (size_t x = 0; x < size_t(width_); x++) columnStart_[x + 1] += columnStart_[x];
        columnRows_.resize(size_t(columnStart_.back()));
        std::vector<int> next(columnStart_.begin(), columnStart_.end() - 1);
        forEachVertical([&](int x, int y) { columnRows_[size_t(next[size_t(x)]++)] = y; });
    }
    template <class Visit>
    void forEachVertical(const Visit& visit) const {
        for (int y = 0; y < height_; y++)
            for (int k = 0; k < verticalCount_[size_t(y)]; k++)
                visit(int(verticals_[size_t(y) * size_t(width_) + size_t(k)]), y);
    }
    Cmaa2Settings settings_;
    bool linear_;
    int width_ = 0, height_ = 0;
    Working<PlaneF> luma_;
    EdgePlane edges_, all_;
    std::vector<uint16_t> stored_, verticals_;
    std::vector<int> verticalCount_, columnStart_, columnRows_;
    PlaneF blur_, shape_, lengthLeft_, lengthRight_;
};

}  // namespace

MethodDescriptor cmaa2Descriptor() {
    return {.id = "cmaa2",
            .title = "CMAA2",
            .family = "spatial",
            .summary = "Blurs the corners of edges a little and blends along lines that step from row to row.",
            .source = "[Strugar 2018]",
            .passes = Pass::color,
            .input = Space::encoded,
            .output = Space::linear,
            .params = {choiceParam("preset", "HIGH", kPresets,
                                   "luma difference that makes an edge: 0.15, 0.10, 0.07, 0.05", "[Strugar 2018]"),
                       realParam("threshold", "0.07", 0.0009765625, 1, "luma difference that makes an edge",
                                 "[Strugar 2018]", "preset=custom"),
                       flagParam("sharp", false, "less blur of corners and of short lines", "[Strugar 2018]"),
                       intParam("maxLine", "86", 4, 256, "longest arm of a line, px", "[Strugar 2018]"),
                       realParam("symmetryCorrection", "0.22", 0, 0.5,
                                 "shortening of the ramp on arms of odd length, px", "[Strugar 2018]"),
                       choiceParam("blendSpace", "linear", {"linear", "encoded"}, "space in which pixels are blended",
                                   "[Strugar 2018], sRGB reads")},
            .create = [](const Params& p, const ShotInfo&) { return std::make_unique<Cmaa2>(p); },
            .outputSpace =
                [](const Params& p) { return p.choice("blendSpace") == "linear" ? Space::linear : Space::encoded; },
            .reachPx = 134};  // blends 43 px along an arm that was traced 86 px, and edges read 2 px around them
}

}  // namespace aa
