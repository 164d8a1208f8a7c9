#include "methods/spatial/mlaa.h"

#include "methods/method.h"
#include "methods/spatial/edge_bits.h"
#include "methods/spatial/smaa_kernels.h"

namespace aa {
namespace {

constexpr Choice<MlaaRule> kRules[] = {
    {"maxdiff", MlaaRule::maxdiff}, {"msb4", MlaaRule::msb4}, {"luma", MlaaRule::luma}};
constexpr Choice<MlaaHeights> kHeights[] = {{"half", MlaaHeights::half}, {"colour", MlaaHeights::colour}};

class Mlaa : public Method {
  public:
    explicit Mlaa(const Params& p)
        : rule_(p.chosen("edges", kRules)),
          heights_(p.chosen("heights", kHeights)),
          simultaneous_(p.flag("simultaneous")),
          areas_(9 * kMlaaTabled * kMlaaTabled * 2) {
        Exec exec;
        exec.parallel = false;
        runKernel(mlaaKernelsFor(exec).areas, exec, MlaaAreaArgs{areas_.data()}, 9);
    }
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        findEdges(frame.colorEncoded, exec);
        const size_t pixels = size_t(width_) * size_t(height_);
        if (keepDebugLayers) {
            for (auto* weights : {&topWeights_, &leftWeights_}) weights->assign(2 * pixels, 0);
            for (auto* shapes : {&topShapes_, &leftShapes_}) shapes->assign(pixels, 0);
        }
        const auto debug = [&](std::vector<float>& plane) { return keepDebugLayers ? plane.data() : nullptr; };
        const size_t blocks = (size_t(height_) + kMlaaBlockRows - 1) / kMlaaBlockRows;
        const long scratchSize = 3 * (2 * width_ + 2);
        scratch_.resize(size_t(scratchSize) * blocks);
        columns_.resize(size_t(width_) * blocks);
        const MlaaBlendArgs args{
            {top_.row(0), left_.row(0), top_.stride(), 1, out.stride(), debug(topWeights_), debug(topShapes_)},
            {leftByColumn_.row(0), topByColumn_.row(0), leftByColumn_.stride(), out.stride(), 1, debug(leftWeights_),
             debug(leftShapes_)},
            areas_.data(),
            view(frame.colorEncoded),
            view(out),
            scratch_.data(),
            columns_.data(),
            scratchSize,
            out.stride(),
            width_,
            height_,
            heights_,
            simultaneous_};
        runKernel(mlaaKernelsFor(exec).blend, exec, args, int(blocks), 1);
    }
    size_t stateBytes() const override {
        return top_.bytes() + left_.bytes() + topByColumn_.bytes() + leftByColumn_.bytes() +
               (scratch_.size() + areas_.size()) * sizeof(float) + columns_.size() * sizeof(MlaaLine);
    }
    std::vector<DebugLayer> debugLayers() const override {
        if (!keepDebugLayers) return {};
        DebugLayer edges{"edges", std::vector<PlaneF>(3, PlaneF(width_, height_))};  // left, top
        DebugLayer top{"weights.top", edges.planes}, left{"weights.left", edges.planes};
        DebugLayer shapes{"shapes", edges.planes};  // of left and top edges: 1 L, 2 Z, 3 U
        for (int y = 0; y < height_; y++)
            for (int x = 0; x < width_; x++) {
                const size_t k = size_t(y) * size_t(width_) + size_t(x);
                edges.planes[0].at(x, y) = left_.at(x, y);
                edges.planes[1].at(x, y) = top_.at(x, y);
                shapes.planes[0].at(x, y) = leftShapes_[k];
                shapes.planes[1].at(x, y) = topShapes_[k];
                for (size_t i = 0; i < 2; i++) {
                    left.planes[i].at(x, y) = leftWeights_[2 * k + i];
                    top.planes[i].at(x, y) = topWeights_[2 * k + i];
                }
            }
        return {edges, top, left, shapes};
    }

  private:
    void findEdges(const Rgb& encoded, const Exec& exec) {
        width_ = encoded.width();
        height_ = encoded.height();
        for (BitPlane* plane : {&top_, &left_}) plane->resize(width_, height_, 64);
        for (BitPlane* plane : {&topByColumn_, &leftByColumn_}) plane->resize(height_, width_, 64);
        const MlaaEdgeArgs args{view(encoded), top_.row(0), left_.row(0), encoded.stride(),
                                top_.stride(), width_,      rule_};
        runKernel(mlaaKernelsFor(exec).edges, exec, args, height_);
        for (auto [from, to] : {std::pair{&top_, &topByColumn_}, {&left_, &leftByColumn_}}) {
            from->clearBorder();  // nothing crosses a line outside the image
            runKernel(smaaKernelsFor(exec).transpose, exec,
                      SmaaTransposeArgs{from->row(0), to->row(0), from->stride(), to->stride(), height_},
                      (width_ + 7) / 8);
            to->clearBorder();
        }
    }
    MlaaRule rule_;
    MlaaHeights heights_;
    bool simultaneous_;
    int width_ = 0, height_ = 0;
    BitPlane top_, left_, topByColumn_, leftByColumn_;
    std::vector<float> areas_, scratch_;
    std::vector<MlaaLine> columns_;
    std::vector<float> topWeights_, leftWeights_, topShapes_, leftShapes_;  // debug
};

}  // namespace

MethodDescriptor mlaaDescriptor() {
    return {
        .id = "mlaa",
        .title = "MLAA",
        .family = "spatial",
        .summary = "Finds L, Z and U shapes of edges and blends by the area under their silhouette.",
        .source = "[Reshetov 2009]",
        .passes = Pass::color,
        .input = Space::encoded,
        .output = Space::encoded,
        .params = {choiceParam("edges", "maxdiff", kRules,
                               "difference that separates pixels: a channel by 1/16, the 4 highest bits of a channel, "
                               "or luma by 0.1",
                               "decisions 42; msb4: [Reshetov 2009]"),
                   choiceParam("heights", "half", kHeights,
                               "where the silhouette meets an edge that crosses a line's end: its middle, or where the "
                               "blended colours of both sides agree",
                               "colour: [Reshetov 2009]; half is ours"),
                   flagParam("simultaneous", false,
                             "vertical lines blend the original colours too, not what horizontal lines left",
                             "[Reshetov 2009]; on is ours")},
        .create = [](const Params& p, const ShotInfo&) { return std::make_unique<Mlaa>(p); },
        .reachPx = kAnyReachPx};  // lines of any length
}

}  // namespace aa
