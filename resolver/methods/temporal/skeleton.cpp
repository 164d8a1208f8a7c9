#include "methods/temporal/skeleton.h"

#include <utility>

#include "methods/method.h"
#include "methods/temporal/temporal.h"

namespace aa {
namespace {

class TemporalSkeleton : public Method {
  public:
    explicit TemporalSkeleton(const Params& params) : params_(params) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        TemporalSkeletonArgs args{};
        args.in = temporal::frameView(frame, frame.colorLinear);  // linear because .input below is not encoded
        if (params_.flag("unjitter")) temporal::unjitter(frame, args.in);
        args.in.out = view(out);
        // Drops the history when frame.reset is set; args.in.history is null then.
        history_.begin(frame, "temporalSkeleton", args.in);
        args.in.debug = debug_.begin(*this, frame.width, frame.height);

        // Our own history: two planes that swap roles, because a kernel that reads the last frame anywhere must not
        // write over it. A reset needs nothing: without args.in.history the kernel writes every count afresh.
        if (count_[0].width() != frame.width || count_[0].height() != frame.height)
            for (PlaneF& plane : count_) plane = PlaneF(frame.width, frame.height);
        args.count = count_[0].row(0);
        args.nextCount = count_[1].row(0);
        args.mostSamples = params_.realf("mostSamples");

        temporal::runTemporal(temporalSkeletonKernelsFor(exec).resolve, exec, args);  // un-jitters on the way

        history_.end({}, exec);
        std::swap(count_[0], count_[1]);
        count_[0].fillBorder();  // a position on the picture's edge rounds to a pixel beyond it
    }
    size_t stateBytes() const override { return history_.bytes() + count_[0].bytes() + count_[1].bytes(); }
    const PlaneF* rejection() const override { return debug_.rejection(); }
    std::vector<DebugLayer> debugLayers() const override {
        std::vector<DebugLayer> layers = debug_.layers();
        if (keepDebugLayers) layers.push_back({"sampleCount", {count_[0]}});
        return layers;
    }

  private:
    Params params_;
    ColourHistory history_;
    PlaneF count_[2];  // of the last frame; of the one being resolved
    TemporalDebugLayers debug_;
};

}  // namespace

MethodDescriptor temporalSkeletonDescriptor() {
    return {
        .id = "temporalSkeleton",
        .title = "Temporal skeleton",
        .family = "temporal",
        .summary = "Running mean along the motion, clamped to the 3x3 neighbourhood, exponential in the end.",
        .source = "an example",  // a key of docs/sources.md: [Karis 2014]
        .passes = Pass::color | Pass::motion,
        .temporal = true,
        // Parameters that several methods share are declared once, in temporal.h. Every temporal method offers
        // `unjitter` (conventions 7.0).
        .params = {realParam("mostSamples", "10", 1, 1000,
                             "samples from which on the mean is exponential; 10: the history weighs 0.9", "an example"),
                   temporal::unjitterParam(false, "conventions 7.0")},
        .create = [](const Params& p, const ShotInfo&) { return std::make_unique<TemporalSkeleton>(p); }};
}
}  // namespace aa
