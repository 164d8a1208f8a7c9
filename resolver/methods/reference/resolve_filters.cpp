#include "methods/reference/resolve_filters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "image/error.h"
#include "shot/patterns.h"

namespace aa {
namespace {
constexpr double kPi = std::numbers::pi;

double cubicWeight(double b, double c, double t) {  // [Mitchell 1988]
    if (t < 1) return ((12 - 9 * b - 6 * c) * t * t * t + (-18 + 12 * b + 6 * c) * t * t + 6 - 2 * b) / 6;
    if (t < 2)
        return ((-b - 6 * c) * t * t * t + (6 * b + 30 * c) * t * t - (12 * b + 48 * c) * t + 8 * b + 24 * c) / 6;
    return 0;
}
double sincWeight(double u) { return u < 1e-3 ? 1 : std::sin(kPi * u) / (kPi * u); }
}  // namespace

double filterWeight(const ResolveShape& s, double x) {
    const double radius = s.diameterPx / 2;
    switch (s.filter) {
        case ResolveFilter::box:
            return 1;
        case ResolveFilter::tent:
            return 1 - x;
        case ResolveFilter::gaussian:
            return std::exp(-x * x / (2 * s.sigma * s.sigma));
        case ResolveFilter::smoothstep:
            return 1 - x * x * (3 - 2 * x);
        case ResolveFilter::bspline:
            return cubicWeight(1, 0, 2 * x);
        case ResolveFilter::mitchell:
            return cubicWeight(1.0 / 3, 1.0 / 3, 2 * x);
        case ResolveFilter::catmullRom:
            return cubicWeight(0, 0.5, 2 * x);
        case ResolveFilter::cubic:
            return cubicWeight(s.b, s.c, 2 * x);
        case ResolveFilter::blackmanHarris: {
            const double t = 1 - x;
            return std::clamp(0.35875 - 0.48829 * std::cos(kPi * t) + 0.14128 * std::cos(2 * kPi * t) -
                                  0.01168 * std::cos(3 * kPi * t),
                              0.0, 1.0);
        }
        case ResolveFilter::sinc:
            return sincWeight((s.textbookSinc ? 1 : 2) * x * radius);
        case ResolveFilter::lanczos:
            return sincWeight(x * radius) * sincWeight(x * radius / s.lobes);
        case ResolveFilter::quincunx:  // no function of the distance
            break;
    }
    return 0;
}

namespace {
std::vector<ResolveTap> quincunxTaps(const std::vector<glm::dvec2>& positions, std::string_view reader) {
    if (positions != patternPositionsPx("quincunx"))
        throw InputError(std::string(reader) + ": filter=quincunx reads the sub-sample pattern quincunx (the centre " +
                         "and one corner), and the shot has another one; export it with that pattern");
    return {{0, 0, 0, 0.5f}, {0, 0, 1, 0.125f}, {1, 0, 1, 0.125f}, {0, 1, 1, 0.125f}, {1, 1, 1, 0.125f}};
}
}  // namespace

std::vector<ResolveTap> resolveTaps(const ResolveShape& shape, const std::vector<glm::dvec2>& positions,
                                    std::string_view reader) {
    if (shape.filter == ResolveFilter::quincunx) return quincunxTaps(positions, reader);
    struct Candidate {
        ResolveTap tap;
        double weight, distance;
    };
    std::vector<Candidate> found;
    const double radius = shape.diameterPx / 2;
    const int reach = int(std::ceil(radius));
    double sum = 0;
    for (int j = -reach; j <= reach; j++)
        for (int i = -reach; i <= reach; i++)
            for (size_t k = 0; k < positions.size(); k++) {
                const double dx = std::abs(i + positions[k].x), dy = std::abs(j + positions[k].y);
                if (dx > radius || dy > radius) continue;
                const double w = filterWeight(shape, dx / radius) * filterWeight(shape, dy / radius);
                if (w == 0) continue;
                found.push_back({{i, j, int(k), 0}, w, dx * dx + dy * dy});
                sum += w;
            }
    if (std::abs(sum) < 1e-5) {  // nothing in the footprint, or lobes that cancel: the box
        found.clear();
        for (size_t k = 0; k < positions.size(); k++) found.push_back({{0, 0, int(k), 0}, 1, 0});
        sum = double(positions.size());
    }
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.distance < b.distance; });
    std::vector<ResolveTap> taps;
    for (auto& f : found) {
        f.tap.weight = float(f.weight / sum);
        taps.push_back(f.tap);
    }
    return taps;
}

constexpr Choice<ResolveFilter> kFilters[] = {{"box", ResolveFilter::box},
                                              {"tent", ResolveFilter::tent},
                                              {"gaussian", ResolveFilter::gaussian},
                                              {"smoothstep", ResolveFilter::smoothstep},
                                              {"bspline", ResolveFilter::bspline},
                                              {"mitchell", ResolveFilter::mitchell},
                                              {"catmullRom", ResolveFilter::catmullRom},
                                              {"cubic", ResolveFilter::cubic},
                                              {"blackmanHarris", ResolveFilter::blackmanHarris},
                                              {"sinc", ResolveFilter::sinc},
                                              {"lanczos", ResolveFilter::lanczos},
                                              {"quincunx", ResolveFilter::quincunx}};
ResolveFilter chosenFilter(const Params& p) { return p.chosen("filter", kFilters); }
ParamSpec filterParam(std::string_view source) {
    return choiceParam("filter", "box", kFilters, "shape of the filter; quincunx needs its own pattern", source);
}

ResolveShape withOwnDiameter(ResolveShape shape) {
    if (shape.diameterPx == 0)
        shape.diameterPx = shape.filter == ResolveFilter::box       ? 1
                           : shape.filter == ResolveFilter::lanczos ? 2.0 * shape.lobes
                                                                    : 2;
    return shape;
}

ResolveShape resolveShape(const Params& p) {
    ResolveShape shape;
    shape.filter = chosenFilter(p);
    shape.sigma = p.real("sigma");
    shape.b = p.real("b");
    shape.c = p.real("c");
    shape.lobes = p.integer("lobes");
    shape.textbookSinc = p.choice("sincZeros") == "pixel";
    shape.diameterPx = p.real("diameter");
    return withOwnDiameter(shape);
}

namespace {
class Resolve : public Method {
  public:
    Resolve(const Params& p, const ShotInfo& shot) {
        taps_ = resolveTaps(resolveShape(p), shot.subSamplePositionsPx);
        inverseLuminance_ = p.flag("inverseLuminance");
        luminanceScale_ = float(std::exp2(p.real("exposure")));
    }
    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        std::vector<RgbIn> samples;
        for (const auto& s : frame.subSamples) samples.push_back(view(s.colorLinear));
        const ResolveArgs args{samples.data(),  int(samples.size()), taps_.data(), int(taps_.size()), inverseLuminance_,
                               luminanceScale_, view(out),           out.stride(), frame.width};
        runKernel(resolveKernelsFor(exec).resolve, exec, args, frame.height);
    }

  private:
    std::vector<ResolveTap> taps_;
    bool inverseLuminance_;
    float luminanceScale_;
};
}  // namespace

MethodDescriptor resolveDescriptor() {
    return {
        .id = "resolve",
        .title = "Resolve filters",
        .family = "reference",
        .summary = "A reconstruction filter over the shaded sub-samples of the pixel and its neighbours.",
        .source = "[Pettineo 2012]",
        .passes = Pass::subsampleColor,
        .params = {filterParam("[Pettineo 2012]"),
                   realParam("diameter", "0", 0, 8, "px; 0: the filter's own (box 1, lanczos 2 * lobes, others 2)",
                             "[Pettineo 2012]",
                             "filter=box|tent|gaussian|smoothstep|bspline|mitchell|catmullRom|cubic|blackmanHarris|"
                             "sinc|lanczos"),
                   realParam("sigma", "0.5", 0.05, 4, "width in radii", "[Pettineo 2012]", "filter=gaussian"),
                   realParam("b", "0.3333", 0, 1, "B of the cubic", "[Mitchell 1988]", "filter=cubic"),
                   realParam("c", "0.3333", 0, 1, "C of the cubic", "[Mitchell 1988]", "filter=cubic"),
                   choiceParam("sincZeros", "halfPixel", {"halfPixel", "pixel"}, "where the sinc crosses zero first",
                               "[Pettineo 2012]; pixel: textbook", "filter=sinc"),
                   intParam("lobes", "2", 1, 4, "lobes of the window", "textbook", "filter=lanczos"),
                   flagParam("inverseLuminance", false, "weigh samples by 1 / (1 + luminance)", "[Pettineo 2012]"),
                   realParam("exposure", "0", -10, 10, "EV applied to that luminance", "[Pettineo 2012]",
                             "inverseLuminance=on")},
        .create = [](const Params& p, const ShotInfo& shot) -> std::unique_ptr<Method> {
            if (shot.subSamplePositionsPx.empty())
                throw InputError(
                    "resolve: filters sub-samples, and the shot's manifest lists no sub-sample positions; export "
                    "the shot "
                    "for resolve");
            return std::make_unique<Resolve>(p, shot);
        }};
}

}  // namespace aa
