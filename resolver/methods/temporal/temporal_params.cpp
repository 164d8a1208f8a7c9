#include "methods/temporal/temporal_params.h"

#include "image/error.h"

namespace aa::temporal {
namespace {
constexpr Choice<Luminance> kLuminances[] = {{"quarter", Luminance::quarter},
                                             {"bt709", Luminance::bt709},
                                             {"bt601", Luminance::bt601},
                                             {"inside", Luminance::inside}};
constexpr Choice<Dilation> kDilations[] = {{"closest3x3", Dilation::closest3x3},
                                           {"closestX", Dilation::closestX},
                                           {"longest3x3", Dilation::longest3x3},
                                           {"none", Dilation::none}};
constexpr Choice<HistoryFilter> kHistoryFilters[] = {{"bilinear", HistoryFilter::bilinear},
                                                     {"catmullRom", HistoryFilter::catmullRom},
                                                     {"catmullRom5", HistoryFilter::catmullRom5}};
constexpr Choice<Neighbourhood> kNeighbourhoods[] = {
    {"rounded", Neighbourhood::rounded}, {"3x3", Neighbourhood::box3x3}, {"plus", Neighbourhood::plus}};
constexpr Choice<ClipTarget> kClipTargets[] = {{"aabbCentre", ClipTarget::aabbCentre},
                                               {"mean", ClipTarget::mean},
                                               {"current", ClipTarget::current},
                                               {"clamp", ClipTarget::clamp}};
constexpr Choice<HistoryFormat> kHistoryBits[] = {
    {"32f", HistoryFormat::float32}, {"16f", HistoryFormat::half}, {"8", HistoryFormat::byte}};
constexpr Choice<SharpenKernel> kSharpenKernels[] = {
    {"none", SharpenKernel::none}, {"xu", SharpenKernel::xu}, {"norm", SharpenKernel::norm}};
}  // namespace

ParamSpec unjitterParam(bool def, std::string_view source) {
    return flagParam("unjitter", def, "read the current frame at the pixel centre less the jitter, bilinear", source);
}
ParamSpec luminanceParam(std::string_view def, std::string_view source, std::string_view onlyWhen) {
    return choiceParam("luminance", def, kLuminances,
                       "luminance of displayed colours: weights 1/4 1/2 1/4, BT.709, BT.601, 0.22 0.707 0.071", source,
                       onlyWhen);
}
ParamSpec dilationParam(std::string_view def, std::string_view source) {
    return choiceParam(
        "dilation", def, kDilations,
        "whose motion a pixel takes: nearest to the camera in 3x3, of centre and diagonals, longest, own", source);
}
ParamSpec historyFilterParam(std::string_view def, std::string_view source) {
    return choiceParam("history", def, kHistoryFilters, "filter that reads the history: 2x2, 4x4, 4x4 without corners",
                       source);
}
ParamSpec historyClampParam() {
    return flagParam("historyClamp", true,
                     "hold what Catmull-Rom reads in the range of the four central texels, and >= 0; off: as published",
                     "conventions 9", "history=catmullRom|catmullRom5");
}
ParamSpec neighbourhoodParam(std::string_view def, std::string_view source) {
    return choiceParam("neighbourhood", def, kNeighbourhoods,
                       "window of the colour box: mean of 3x3 and plus, 3x3, plus", source);
}
ParamSpec clipTargetParam(std::string_view def, std::string_view source) {
    return choiceParam("clipTarget", def, kClipTargets,
                       "point toward which history is clipped; clamp: per channel instead", source);
}
ParamSpec warmupParam() {
    return choiceParam("warmup", "none", {"none", "ramp"},
                       "frames after a reset: none keeps the feedback, ramp averages the first frames evenly",
                       "conventions 7; none is the protocol of [Oliveros 2018, 4.2.1]");
}
ParamSpec historyBitsParam(Space space) {
    const bool codes = space == Space::encoded;
    const std::string_view help =
        codes ? "how colours are kept between frames: float, or rounded to binary16 or to 8 bits as on a graphics "
                "processor"
              : "how colours are kept between frames: float, or rounded to binary16 as on a graphics processor";
    ParamSpec bits = choiceParam("historyBits", "32f", kHistoryBits, help, "conventions 8");
    if (!codes) std::erase(bits.choices, "8");
    return bits;
}
ParamSpec ditherParam(Space space) {
    return flagParam("dither", false, "round up or down by chance, so that a slow history does not stall",
                     "[Pedersen 2016]; conventions 8",
                     space == Space::encoded ? "historyBits=16f|8" : "historyBits=16f");
}
ParamSpec outsideParam() {
    return choiceParam("outside", "reject", {"reject", "clamp"},
                       "history position outside the image: take the current colour, or the history's edge",
                       "ours; [Pedersen 2016] has clamp");
}
ParamSpec sharpenParam(std::string_view def, std::string_view source) {
    return choiceParam("sharpen", def, kSharpenKernels,
                       "sharpening of the output, never fed back: plus-shaped kernel with neighbours -1 or -1/4",
                       source);
}
ParamSpec kMinParam(std::string_view def, std::string_view source) {
    return realParam("kmin", def, 0, 1, "weight of history where its luminance differs most", source);
}
ParamSpec kMaxParam(std::string_view def, std::string_view source) {
    return realParam("kmax", def, 0, 1, "weight of history where its luminance is that of the current colour", source);
}
ParamSpec depthToleranceParam(std::string_view onlyWhen) {
    return realParam("depthTolerance", "0.08", 0, 10,
                     "a surface is new where the last frame shows one nearer by more than this share of its depth; 1 "
                     "and more: nowhere",
                     "[Stejmar n.d., 4.4.1]", onlyWhen);
}
ParamSpec bothSidesParam(std::string_view onlyWhen) {
    return flagParam("bothSides", false, "reject nearer surfaces too, not only hidden ones", "decisions 19", onlyWhen);
}
ParamSpec magnificationParam(std::string_view def, std::string_view source) {
    return choiceParam("magnification", def, {"off", "0.5", "1"},
                       "reject where one previous sample would be enlarged: its centre is farther than this share of "
                       "the footprint",
                       source);
}
ParamSpec countAtParam(std::string_view source, std::string_view onlyWhen) {
    return choiceParam("countAt", "pixel", {"pixel", "reprojected"},
                       "where the sample count of the last frame is read: at this pixel, or where its surface was",
                       source, onlyWhen);
}
void requireOrdered(std::string_view method, const Params& p) {
    if (p.real("kmin") > p.real("kmax"))
        throw UsageError(std::string(method) + ": expected kmin <= kmax, found kmin=" + p.all().find("kmin")->second +
                         " and kmax=" + p.all().find("kmax")->second);
}

Dilation dilation(const Params& p) { return p.chosen("dilation", kDilations); }
HistoryFilter historyFilter(const Params& p) {
    const HistoryFilter filter = p.chosen("history", kHistoryFilters);
    if (p.flag("historyClamp")) return filter;
    return filter == HistoryFilter::catmullRom ? HistoryFilter::catmullRomFree : HistoryFilter::catmullRom5Free;
}
Neighbourhood neighbourhood(const Params& p) { return p.chosen("neighbourhood", kNeighbourhoods); }
ClipTarget clipTarget(const Params& p) { return p.chosen("clipTarget", kClipTargets); }
Luminance luminance(const Params& p) { return p.chosen("luminance", kLuminances); }
SharpenKernel sharpenKernel(const Params& p) { return p.chosen("sharpen", kSharpenKernels); }
HistoryStorage historyStorage(const Params& p) { return {p.chosen("historyBits", kHistoryBits), p.flag("dither")}; }
RejectionTest rejectionTest(const Params& p) {
    const std::string& scale = p.choice("magnification");
    return {p.realf("depthTolerance"), scale == "off" ? 0.0f : float(numberOf(scale)), p.flag("bothSides")};
}
bool countAtPixel(const Params& p) { return p.choice("countAt") == "pixel"; }
PassSet dilationPasses(const Params& p) {
    const Dilation d = dilation(p);
    return d == Dilation::closest3x3 || d == Dilation::closestX ? PassSet(Pass::depth) : PassSet{};
}

float feedbackCeiling(const Params& p, int framesSinceReset) {
    return p.choice("warmup") == "ramp" ? 1.0f - 1.0f / float(framesSinceReset + 1) : 1.0f;
}

}  // namespace aa::temporal
