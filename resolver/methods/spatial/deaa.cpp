#include "methods/spatial/deaa.h"

#include "image/error.h"
#include "methods/method.h"
#include "methods/spatial/edge_plane.h"

namespace aa {
namespace {

class Deaa : public Method {
  public:
    Deaa(const Params& p, const ShotInfo& shot) {
        args_.fitTolerance = p.real("fitTolerance");
        args_.maxLengthPx = p.real("maxLength");
        args_.sameColour = p.real("sameColour");
        for (const auto& o : shot.subSamplePositionsPx) xPx_.push_back(o.x), yPx_.push_back(o.y);
        args_.xPx = xPx_.data();
        args_.yPx = yPx_.data();
        args_.sampleCount = int(xPx_.size());
        setNormalMatrix(args_);
    }
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        std::vector<RgbIn> samples;
        for (const auto& s : frame.subSamples) samples.push_back(view(s.colorLinear));
        edges_.resize(frame.width, frame.height, 16);
        args_.samples = samples.data();
        args_.edges = edges_.row(0);
        args_.edgesOut = edges_.row(0);
        args_.out = view(out);
        args_.stride = out.stride();
        args_.edgeStride = edges_.stride();
        args_.width = frame.width;
        if (keepDebugLayers) {
            applied_ = PlaneF(frame.width, frame.height);
            args_.applied = applied_.row(0);
        }
        const auto& kernels = deaaKernelsFor(exec);
        runKernel(kernels.mark, exec, args_, frame.height);
        edges_.clearBesideTheRows();
        runKernel(kernels.filter, exec, args_, frame.height);
    }
    size_t stateBytes() const override { return edges_.bytes(); }
    std::vector<DebugLayer> debugLayers() const override {
        if (!keepDebugLayers) return {};
        PlaneF edges(applied_.width(), applied_.height());
        for (int y = 0; y < edges.height(); y++)
            for (int x = 0; x < edges.width(); x++) edges.at(x, y) = edges_.row(y)[x] ? 1.0f : 0.0f;
        return {{"edges", {edges}}, {"filtered", {applied_}}};
    }

  private:
    DeaaArgs args_{};
    std::vector<double> xPx_, yPx_;
    EdgePlane edges_;
    PlaneF applied_;
};

}  // namespace

void setNormalMatrix(DeaaArgs& args) {
    double mx = 0, my = 0, xx = 0, xy = 0, yy = 0;
    const double n = 9 * double(args.sampleCount);
    for (int k = 0; k < args.sampleCount; k++) mx += 9 * args.xPx[k] / n, my += 9 * args.yPx[k] / n;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            for (int k = 0; k < args.sampleCount; k++) {
                const double dx = args.xPx[k] + i - mx, dy = args.yPx[k] + j - my;
                xx += dx * dx, xy += dx * dy, yy += dy * dy;
            }
    const double determinant = xx * yy - xy * xy;
    if (!(determinant > 1e-9)) return;
    args.invXX = yy / determinant, args.invXY = -xy / determinant, args.invYY = xx / determinant;
}

MethodDescriptor deaaDescriptor() {
    return {
        .id = "deaa",
        .title = "Directionally adaptive edge AA",
        .family = "spatial",
        .summary = "Integrates the sub-samples of 3x3 pixels along the isolines of a fitted plane.",
        .source = "[Iourcha 2009], reconstructed",
        .passes = Pass::subsampleColor,
        .params = {realParam("fitTolerance", "0.3", 0, 1, "rms of the plane fit, relative to the window's luma range",
                             "ours: a clean edge through 3x3 pixels fits to 0.15-0.29"),
                   realParam("maxLength", "3", 1, 3, "length of the integration rectangle along the isolines, px",
                             "[Iourcha 2009]"),
                   realParam("sameColour", "0.01", 0, 1, "samples within this linear difference are one surface",
                             "ours")},
        .create = [](const Params& p, const ShotInfo& shot) -> std::unique_ptr<Method> {
            const size_t n = shot.subSamplePositionsPx.size();
            if (n < 2 || n > size_t(kDeaaMaxSamples))
                throw InputError("deaa: expected 2 to 16 shaded sub-samples per pixel, the shot's manifest lists " +
                                 std::to_string(n) + "; export the shot for deaa");
            return std::make_unique<Deaa>(p, shot);
        },
        .reachPx = 2};
}

}  // namespace aa
