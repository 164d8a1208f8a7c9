#include "methods/spatial/edge_blur.h"

#include "methods/method.h"
#include "methods/spatial/luma.h"
#include "methods/working.h"

namespace aa {
namespace {

class EdgeBlur : public Method {
  public:
    EdgeBlur(EdgeBlurArgs args, LumaKind kind, RowKernel<EdgeBlurArgs> EdgeBlurKernels::*kernel)
        : args_(args), kind_(kind), kernel_(kernel) {}
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const Rgb& in = frame.colorEncoded;
        const auto luma = luma_.take();
        lumaPlane(in, kind_, exec, *luma);
        args_.luma = luma->row(0);
        args_.in = view(in);
        args_.out = view(out);
        args_.stride = in.stride();
        args_.width = in.width();
        if (keepDebugLayers) {
            directionX_ = directionY_ = PlaneF(in.width(), in.height());
            args_.directionX = directionX_.row(0);
            args_.directionY = directionY_.row(0);
        }
        runKernel(edgeBlurKernelsFor(exec).*kernel_, exec, args_, in.height());
    }
    size_t stateBytes() const override { return luma_.bytes(); }
    std::vector<DebugLayer> debugLayers() const override {
        if (!keepDebugLayers) return {};
        return {{"direction.x", {directionX_}}, {"direction.y", {directionY_}}};
    }

  private:
    EdgeBlurArgs args_;
    LumaKind kind_;
    RowKernel<EdgeBlurArgs> EdgeBlurKernels::*kernel_;
    Working<PlaneF> luma_;
    PlaneF directionX_, directionY_;
};

}  // namespace

MethodDescriptor nfaaDescriptor() {
    return {.id = "nfaa",
            .title = "NFAA",
            .family = "spatial",
            .summary = "Averages five taps along the edge, as far apart as the luma gradient is steep.",
            .source = "[Styves n.d.], public port",
            .passes = Pass::color,
            .input = Space::encoded,
            .output = Space::encoded,
            .params = {intParam("scale", "1", 1, 3, "distance of the eight lumas, px", "public port"),
                       realParam("strength", "1", 0, 4, "length of the blur per gradient, px", "public port"),
                       realParam("longest", "3", 0.5, 5, "largest length of the blur, px", "conventions 11")},
            .create =
                [](const Params& p, const ShotInfo&) {
                    EdgeBlurArgs args{};
                    args.scalePx = p.integer("scale");
                    args.strength = p.realf("strength");
                    args.longestPx = p.realf("longest");
                    return std::make_unique<EdgeBlur>(args, LumaKind::nfaa, &EdgeBlurKernels::nfaa);
                },
            .reachPx = 6};  // bilinear taps at up to 5 px
}

MethodDescriptor ssssaaDescriptor() {
    return {.id = "ssssaa",
            .title = "Screen-space SSAA",
            .family = "spatial",
            .summary = "Averages five taps within a pixel along the edge where the luma gradient is strong.",
            .source = "reconstructed from the shader of that name",
            .passes = Pass::color,
            .input = Space::encoded,
            .output = Space::encoded,
            .params = {realParam("reach", "1.75", 0.5, 3, "distance of the four lumas, px", "public port: 1.8"),
                       realParam("threshold", "0.0625", 0.0009765625, 1, "least luma gradient that is blurred",
                                 "public port")},
            .create =
                [](const Params& p, const ShotInfo&) {
                    EdgeBlurArgs args{};
                    args.reachPx = p.realf("reach");
                    args.threshold = p.realf("threshold");
                    return std::make_unique<EdgeBlur>(args, LumaKind::rec709, &EdgeBlurKernels::ssssaa);
                },
            .reachPx = 4};  // lumas at up to 3 px, bilinear
}

}  // namespace aa
