// resolve: reconstruction filters over the sub-samples of a neighbourhood [Pettineo 2012].
//
// out = sum w c / sum w over all sub-samples within the filter's radius r = diameter / 2, w = f(|dx| / r) f(|dy| / r),
// colours clamped to >= 0 before, the result after. Linear light, offsets in px from the output pixel's centre.
// quincunx: half of the centre sample and an eighth of each of the four corner samples, which the pixel shares with its
// neighbours [NVIDIA 2001]; the pattern quincunx only.
#pragma once
#include "methods/method.h"
#include "methods/reference/resolve_filters_kernels.h"

namespace aa {

enum class ResolveFilter {
    box,
    tent,
    gaussian,
    smoothstep,
    bspline,
    mitchell,
    catmullRom,
    cubic,
    blackmanHarris,
    sinc,
    lanczos,
    quincunx
};
struct ResolveShape {
    ResolveFilter filter = ResolveFilter::box;
    double diameterPx = 1, sigma = 0.5, b = 0, c = 0.5;
    bool textbookSinc = false;  // zeros at whole pixels instead of every half pixel
    int lobes = 2;              // lanczos
};
// f of the filter at x = |offset| / radius, 0 <= x <= 1.
double filterWeight(const ResolveShape& shape, double x);
// All sub-samples in the footprint, nearest first, weights normalised to 1 (the box where they sum to less than 1e-5).
// Throws InputError when quincunx meets another pattern; `reader` names the method for the message.
std::vector<ResolveTap> resolveTaps(const ResolveShape& shape, const std::vector<glm::dvec2>& samplePositionsPx,
                                    std::string_view reader = "resolve");
// The choice of a filter, and the shape with its own diameter (box 1, lanczos 2 lobes, others 2) where that is 0.
ParamSpec filterParam(std::string_view source);
ResolveFilter chosenFilter(const Params& p);
ResolveShape withOwnDiameter(ResolveShape shape);
// The shape that the parameters of resolve say.
ResolveShape resolveShape(const Params& p);

MethodDescriptor resolveDescriptor();

}  // namespace aa
