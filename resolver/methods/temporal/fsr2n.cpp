#include "methods/temporal/fsr2n.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "methods/method.h"
#include "methods/temporal/temporal.h"
#include "methods/working.h"

namespace aa {
namespace {

constexpr int kFsr2nRowsPerCall = 32;  // each converts two rows of its neighbours again

double lanczos2(double x) {
    if (x >= 2) return 0;
    const double t = std::numbers::pi * x;
    return x < 1e-9 ? 1 : 2 * std::sin(t) * std::sin(t / 2) / (t * t);
}
// Weights of the 3x3 samples by their distance from the pixel centre, normalised.
template <class Weight>
void fillWeights(float (&weights)[9], glm::dvec2 jitterPx, const Weight& of) {
    double w[9], sum = 0;
    for (int n = 0; n < 9; n++) sum += w[n] = of(std::hypot(n % 3 - 1 + jitterPx.x, n / 3 - 1 + jitterPx.y));
    for (int n = 0; n < 9; n++) weights[n] = float(w[n] / sum);
}
// Length of the ray through the picture's corner against that through its centre: 1 without perspective.
double cornerStretch(const Frame& frame) {
    if (!frame.camera || frame.camera->kind != "perspective") return 1;
    const double px = frame.camera->projection[0][0], py = frame.camera->projection[1][1];
    return px > 0 && py > 0 ? std::sqrt(1 + 1 / (px * px) + 1 / (py * py)) : 1;
}

class Fsr2n : public Method {
  public:
    Fsr2n(const Params& params, int jitterPeriod)
        : params_(params), lockDecay_(1.0f / float(std::max(1, jitterPeriod))) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const Params& p = params_;
        const Fsr2nKernels& kernels = fsr2nKernelsFor(exec);
        Fsr2nArgs args{};
        args.in = temporal::frameView(frame, frame.colorLinear);
        if (p.flag("unjitter")) temporal::unjitter(frame, args.in);
        args.in.out = view(out);
        history_.begin(frame, "fsr2n", args.in);
        args.in.feedbackCeiling = temporal::feedbackCeiling(p, history_.framesSinceReset());
        args.in.dilation = Dilation::closest3x3;
        const auto nearest = nearest_.take();
        *nearest = PlaneF::unset(frame.width, frame.height);
        if (args.in.history) {
            for (int y = 0; y < frame.height; y++) std::fill(nearest->row(y), nearest->row(y) + frame.width, kNoDepth);
            runKernel(kernels.scatter, exec, Fsr2nScatterArgs{args.in, nearest->row(0), exec.parallel}, frame.height);
            nearest->fillBorder();
        }
        args.nearest = nearest->row(0);
        args.previousLuma = luma_.previous().row(0);
        args.nextLuma = luma_.next().row(0);
        setFsr2nFrame(args, frame, args.in.jitterXPx, args.in.jitterYPx);
        args.weight = p.realf("weight");
        args.boxScale = p.realf("boxScale");
        args.lockDecay = lockDecay_;
        args.locks = p.flag("locks");
        args.in.debug = debug_.begin(*this, frame.width, frame.height);
        if (keepDebugLayers) {
            args.debugDepthClip = fitted(depthClip_, frame.width, frame.height).row(0);
            args.debugLock = fitted(lock_, frame.width, frame.height).row(0);
        }
        temporal::runTemporal(kernels.resolve, exec, args, kFsr2nRowsPerCall, kFsr2nScratchRows);
        history_.end({}, exec);
    }
    size_t stateBytes() const override { return history_.bytes() + nearest_.bytes(); }
    const PlaneF* rejection() const override { return debug_.rejection(); }
    std::vector<DebugLayer> debugLayers() const override {
        std::vector<DebugLayer> layers = debug_.layers();
        if (!lock_.empty()) {
            layers.push_back({"depthClip", {depthClip_}});
            layers.push_back({"lock", {lock_}});
        }
        return layers;
    }

  private:
    Params params_;
    float lockDecay_;
    ColourHistory history_;
    Kept<PlaneF> luma_{history_};
    Working<PlaneF> nearest_;
    TemporalDebugLayers debug_;
    PlaneF depthClip_, lock_;
};
}  // namespace

void setFsr2nFrame(Fsr2nArgs& args, const Frame& frame, float jitterXPx, float jitterYPx) {
    const glm::dvec2 jitterPx{jitterXPx, jitterYPx};
    fillWeights(args.lanczos, jitterPx, lanczos2);
    fillWeights(args.still, jitterPx, [](double d) { return std::exp(-2 * d * d); });
    fillWeights(args.moving, jitterPx, [](double d) { return std::exp(-3 * d * d); });
    const double diagonalPx = std::hypot(frame.width, frame.height);
    args.separation = float(1.37e-5 * cornerStretch(frame) * diagonalPx);            // FSR 2
    args.power = float(1 + 2 * std::min(1.0, diagonalPx / std::hypot(1920, 1080)));  // FSR 2 has 2203, its rounding
}

MethodDescriptor fsr2nDescriptor() {
    return {
        .id = "fsr2n",
        .title = "FSR2-like accumulation at native resolution",
        .family = "temporal",
        .summary = "Depth clip by scattered depth, locked thin features, Lanczos filters, tone-mapped blend.",
        .source = "[AMD 2022], not identical to it",
        .passes = Pass::color | Pass::depth | Pass::motion,
        .temporal = true,
        .params = {temporal::unjitterParam(false, "conventions 7.0; the filter of the current frame knows its jitter"),
                   realParam("weight", "0.1", 0.001, 1, "weight of the current colour against 1 of the history",
                             "[AMD 2022]: 0.1 is where its limit of 10 times the weight is neutral"),
                   realParam("boxScale", "1", 1, 20,
                             "half width of the colour box at rest, in standard deviations; 1 in motion",
                             "[AMD 2022]: up to 20 when it upscales much, at native resolution its least"),
                   flagParam("locks", true, "keep the history of one-pixel ridges outside the colour box",
                             "[AMD 2022]"),
                   temporal::warmupParam()},
        .create = [](const Params& p, const ShotInfo& shot) { return std::make_unique<Fsr2n>(p, shot.jitterPeriod); }};
}
}  // namespace aa
