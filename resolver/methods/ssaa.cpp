#include "methods/ssaa.h"

#include "image/error.h"
#include "methods/ssaa_kernels.h"

namespace aa {
namespace {

class Ssaa : public Method {
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        std::vector<RgbIn> samples;
        for (const auto& s : frame.subSamples) samples.push_back(view(s.colorLinear));
        const SsaaArgs args{samples.data(), int(samples.size()), view(out), out.stride(), frame.width};
        runKernel(ssaaKernelsFor(exec.isa).mean, exec, args, frame.height);
    }
};

}  // namespace

MethodDescriptor ssaaDescriptor() {
    return {.id = "ssaa",
            .title = "Supersampling",
            .family = "reference",
            .summary = "Mean of the shaded sub-samples: a box filter one pixel wide, in linear light.",
            .source = "Leler 1980; methods/01 s.1.2",
            .passes = Pass::subsamples | Pass::subsampleColor,
            .create = [](const Params&, const ShotInfo& shot) -> std::unique_ptr<Method> {
                if (shot.subSamplePositionsPx.empty())
                    throw InputError(
                        "ssaa: averages sub-samples, and the shot's manifest lists no sub-sample positions; export the "
                        "shot for ssaa");
                return std::make_unique<Ssaa>();
            }};
}
}  // namespace aa
