#include "methods/mlaa.h"

#include "methods/edge_plane.h"
#include "methods/mlaa_kernels.h"

namespace aa {
namespace {

class Mlaa : public Method {
  public:
    explicit Mlaa(const Params& p) : rule_(MlaaRule(p.choiceIndex("edges"))) {}
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        findEdges(frame.colorEncoded, exec);
        findWeights(exec);
        const MlaaBlendArgs args{edges_.row(0), topWeights_.data(), leftWeights_.data(), view(frame.colorEncoded),
                                 view(out),     out.stride(),       edges_.stride(),     width_,
                                 height_};
        runKernel(mlaaKernelsFor(exec.isa).blend, exec, args, height_);
    }
    size_t stateBytes() const override {
        return edges_.bytes() + transposed_.bytes() + (topWeights_.size() + leftWeights_.size()) * sizeof(float);
    }
    std::vector<DebugLayer> debugLayers() const override {
        if (!keepDebugLayers) return {};
        DebugLayer edges{"edges", std::vector<PlaneF>(3, PlaneF(width_, height_))};  // left, top
        DebugLayer top{"weights.top", edges.planes}, left{"weights.left", edges.planes};
        DebugLayer shapes{"shapes", edges.planes};  // of left and top edges: 1 L, 2 Z, 3 U
        for (int y = 0; y < height_; y++)
            for (int x = 0; x < width_; x++) {
                const uint8_t e = edges_.row(y)[x];
                const size_t k = size_t(y) * size_t(width_) + size_t(x);
                if (e & kEdgeLeft) {
                    edges.planes[0].at(x, y) = 1;
                    shapes.planes[0].at(x, y) = leftShapes_[k];
                    for (size_t i = 0; i < 2; i++) left.planes[i].at(x, y) = leftWeights_[2 * k + i];
                }
                if (e & kEdgeTop) {
                    edges.planes[1].at(x, y) = 1;
                    shapes.planes[1].at(x, y) = topShapes_[k];
                    for (size_t i = 0; i < 2; i++) top.planes[i].at(x, y) = topWeights_[2 * k + i];
                }
            }
        return {edges, top, left, shapes};
    }

  private:
    void findEdges(const Rgb& encoded, const Exec& exec) {
        width_ = encoded.width();
        height_ = encoded.height();
        edges_.resize(width_, height_, 16);
        transposed_.resize(height_, width_, 16);
        const MlaaEdgeArgs args{view(encoded), edges_.row(0), encoded.stride(), edges_.stride(), width_, rule_};
        runKernel(mlaaKernelsFor(exec.isa).edges, exec, args, height_);
        edges_.clearBesideTheRows();  // nothing crosses a line outside the image
    }
    void findWeights(const Exec& exec) {
        const size_t pixels = size_t(width_) * size_t(height_);
        topWeights_.resize(2 * pixels);
        leftWeights_.resize(2 * pixels);
        if (keepDebugLayers) topShapes_.resize(pixels), leftShapes_.resize(pixels);
        transposed_.clear();
        const auto& kernel = mlaaKernelsFor(exec.isa).weights;
        MlaaWeightArgs args{edges_.row(0),
                            transposed_.row(0),
                            topWeights_.data(),
                            keepDebugLayers ? topShapes_.data() : nullptr,
                            1,
                            width_,
                            edges_.stride(),
                            transposed_.stride(),
                            width_};
        runKernel(kernel, exec, args, height_);
        args.edges = transposed_.row(0);
        args.edgeStride = transposed_.stride();
        args.width = height_;
        args.transposed = nullptr;
        args.weights = leftWeights_.data();
        args.shapes = keepDebugLayers ? leftShapes_.data() : nullptr;
        args.weightAlong = width_;
        args.weightAcross = 1;
        runKernel(kernel, exec, args, width_);
    }
    MlaaRule rule_;
    int width_ = 0, height_ = 0;
    EdgePlane edges_, transposed_;
    std::vector<float> topWeights_, leftWeights_, topShapes_, leftShapes_;
};

}  // namespace

MethodDescriptor mlaaDescriptor() {
    return {
        .id = "mlaa",
        .title = "MLAA",
        .family = "spatial",
        .summary = "Finds L, Z and U shapes of edges and blends by the area under their silhouette.",
        .source = "Reshetov 2009; methods/03 s.3.1",
        .passes = Pass::color,
        .input = Space::encoded,
        .output = Space::encoded,
        .params = {choiceParam("edges", "maxdiff", {"maxdiff", "msb4", "luma"},
                               "difference that separates pixels: a channel by 1/16, the 4 highest bits of a channel, "
                               "or luma by 0.1",
                               "methods/11 #42; msb4: Reshetov 2009")},
        .create = [](const Params& p, const ShotInfo&) { return std::make_unique<Mlaa>(p); }};
}

}  // namespace aa
