#include "methods/reference/ssaa.h"

#include "image/error.h"
#include "methods/method.h"

namespace aa {
namespace {

class Ssaa : public Method {
  public:
    explicit Ssaa(bool encoded) : encoded_(encoded) {}
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        std::vector<RgbIn> samples;
        for (const auto& s : frame.subSamples) samples.push_back(view(s.colorLinear));
        const SsaaArgs args{samples.data(), int(samples.size()),       view(out), out.stride(), frame.width,
                            encoded_,       displayArgs(frame.display)};
        runKernel(ssaaKernelsFor(exec).mean, exec, args, frame.height);
    }

  private:
    bool encoded_;
};

}  // namespace

MethodDescriptor ssaaDescriptor() {
    return {.id = "ssaa",
            .title = "Supersampling",
            .family = "reference",
            .summary = "Mean of the shaded sub-samples: a box filter one pixel wide.",
            .source = "[Leler 1980]",
            .passes = Pass::subsampleColor,
            .params = {averagedSpaceParam()},
            .create = [](const Params& p, const ShotInfo& shot) -> std::unique_ptr<Method> {
                if (shot.subSamplePositionsPx.empty())
                    throw InputError(
                        "ssaa: averages sub-samples, and the shot's manifest lists no sub-sample positions; export the "
                        "shot for ssaa");
                return std::make_unique<Ssaa>(p.choice("space") == "encoded");
            },
            .outputSpace = averagedSpace};
}
}  // namespace aa
