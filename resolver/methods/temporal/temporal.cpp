#include "methods/temporal/temporal.h"

#include <cmath>

#include "image/error.h"

namespace aa {

void ColourHistory::begin(const Frame& frame, std::string_view method, TemporalIn& in) {
    const bool fits = planes_[0].width() == frame.width && planes_[0].height() == frame.height;
    const bool fresh = frame.reset || frames_ < 0;
    if (!fresh && !fits)
        throw InputError(std::string(method) + ": frame " + std::to_string(frame.number) + " is " +
                         std::to_string(frame.width) + "x" + std::to_string(frame.height) + ", its history is " +
                         std::to_string(planes_[0].width()) + "x" + std::to_string(planes_[0].height()) +
                         "; set `reset` on the frame where the size changes");
    if (!fits)
        for (auto& p : planes_) p = RgbaPlane(frame.width, frame.height);
    if (!fresh && storage_.format != HistoryFormat::float32) narrow();
    frames_ = fresh ? 0 : frames_ + 1;
    frameNumber_ = uint32_t(frame.number);
    in.history = fresh ? nullptr : planes_[current_].row(0);
    in.next = planes_[1 - current_].row(0);
}

void ColourHistory::end(const HistoryStorage& storage, const Exec& exec) {
    current_ = 1 - current_;
    planes_[current_].fillBorder();
    storage_ = storage, exec_ = exec;
}

void ColourHistory::narrow() {
    RgbaPlane& kept = planes_[current_];
    const NarrowHistoryArgs args{kept.row(0),     kept.stride(),   kept.width(),
                                 storage_.format, storage_.dither, frameNumber_};
    runKernel(temporalKernelsFor(exec_).narrow, exec_, args, kept.height());
    kept.fillBorder();
}

namespace temporal {
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
    const std::string_view help =
        "how colours are kept between frames: float, or rounded to binary16 or to 8 bits as on a graphics processor";
    ParamSpec bits = choiceParam("historyBits", "32f", kHistoryBits, help, "conventions 8");
    if (space == Space::linear) std::erase(bits.choices, "8");
    return bits;
}
ParamSpec ditherParam() {
    return flagParam("dither", false, "round up or down by chance, so that a slow history does not stall",
                     "[Pedersen 2016]; conventions 8", "historyBits=16f|8");
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
    return {p.realf("depthTolerance"), scale == "off" ? 0.0f : std::stof(scale), p.flag("bothSides")};
}
bool countAtPixel(const Params& p) { return p.choice("countAt") == "pixel"; }
PassSet dilationPasses(const Params& p) {
    const Dilation d = dilation(p);
    return d == Dilation::closest3x3 || d == Dilation::closestX ? PassSet(Pass::depth) : PassSet{};
}

TemporalIn frameView(const Frame& frame, const Rgb& color) {
    TemporalIn in;
    in.color = view(color);
    in.depthView = frame.depthView.empty() ? nullptr : frame.depthView.row(0);
    in.motionXPx = frame.motionXPx.row(0);
    in.motionYPx = frame.motionYPx.row(0);
    in.stride = color.stride();
    in.width = frame.width;
    in.height = frame.height;
    in.jitterXPx = float(frame.jitterPx.x);
    in.jitterYPx = float(frame.jitterPx.y);
    return in;
}

glm::ivec2 unjitteredTexel(const Frame& frame) {
    return {int(std::floor(0.5 - frame.jitterPx.x)), int(std::floor(0.5 - frame.jitterPx.y))};
}
void unjitter(const Frame& frame, TemporalIn& in) {
    const glm::ivec2 texel = unjitteredTexel(frame);
    const ptrdiff_t offset = ptrdiff_t(texel.y) * in.stride + texel.x;
    if (in.depthView) in.depthView += offset;
    in.motionXPx += offset, in.motionYPx += offset;
    in.readXPx = -in.jitterXPx, in.readYPx = -in.jitterYPx;
    in.jitterXPx = in.jitterYPx = 0;
}
ExpectedDepth moved(ExpectedDepth e, glm::ivec2 texel) {
    e.perDepth[2] += e.perDepth[0] * float(texel.x) + e.perDepth[1] * float(texel.y);
    e.constant[2] += e.constant[0] * float(texel.x) + e.constant[1] * float(texel.y);
    return e;
}
void unjitter(const Rgb& in, glm::dvec2 jitterPx, const Exec& exec, Rgb& out) {
    if (out.width() != in.width() || out.height() != in.height()) out = Rgb(in.width(), in.height());
    const int stride = in.stride();
    const UnjitterArgs all{view(in), view(out), stride, kBorderX, -float(jitterPx.x), -float(jitterPx.y)};
    const auto fn = rowsOf(temporalKernelsFor(exec).unjitter, exec.precision);
    forRows(exec, in.height(), [&](int y0, int y1) {
        UnjitterArgs a = all;
        for (float*& p : a.out.c) p += ptrdiff_t(y0) * stride - kBorderX;
        fn(a, y0, y1);
    });
    out.fillBorder();
}

UnjitteredRows::UnjitteredRows(const TemporalIn& in, const Exec& exec, int rows)
    : args_{in.color, {}, in.stride, kBorderX, in.readXPx, in.readYPx},
      run_(rowsOf(temporalKernelsFor(exec).unjitter, exec.precision)),
      rows_(rows > 0 ? size_t(rows) + 2 : 0),
      scratch_(int(3 * rows_ + 1) / 2, in.stride) {}  // scratch rows are of double
RgbIn UnjitteredRows::around(int y0, int y1) {
    UnjitterArgs a = args_;
    float* const memory = static_cast<float*>(scratch_.local());
    const size_t stride = size_t(a.stride), channel = rows_ * stride;
    for (size_t c = 0; c < 3; c++) a.out.c[c] = memory + c * channel;
    run_(a, y0 - 1, y1 + 1);
    // Pixel (0, 0) of a plane of which only these rows exist: outside of the memory, so an integer until it is used.
    RgbIn colour{};
    for (size_t c = 0; c < 3; c++) {
        const auto first = reinterpret_cast<intptr_t>(a.out.c[c] + kBorderX);
        const auto back = intptr_t(y0 - 1) * intptr_t(stride) * intptr_t(sizeof(float));
        colour.c[c] = reinterpret_cast<const float*>(first - back);
    }
    return colour;
}

float feedbackCeiling(const Params& p, int framesSinceReset) {
    return p.choice("warmup") == "ramp" ? 1.0f - 1.0f / float(framesSinceReset + 1) : 1.0f;
}

}  // namespace temporal

std::optional<ViewRays> viewRays(const Frame& frame) {
    if (!frame.camera) return {};
    const Camera& now = *frame.camera;
    const bool perspective = now.kind == "perspective";
    if (!perspective && now.kind != "orthographic") return {};
    // clip x = P00 X + P20 Z + P30 with Z = -depth, and w = depth or 1. The sample lies at p + jitter.
    const glm::dmat4& P = now.projection;
    const glm::dvec3 ndc[2] = {{2.0 / frame.width, 0, 2.0 * frame.jitterPx.x / frame.width - 1},
                               {0, -2.0 / frame.height, 1 - 2.0 * frame.jitterPx.y / frame.height}};
    const glm::dvec3 unit(0, 0, 1);
    ViewRays rays;
    for (int i = 0; i < 2; i++) {
        if (P[i][i] == 0) return {};
        rays.perDepth[i] = (perspective ? ndc[i] + unit * P[2][i] : unit * P[2][i]) / P[i][i];
        rays.constant[i] = (perspective ? unit * -P[3][i] : ndc[i] - unit * P[3][i]) / P[i][i];
    }
    return rays;
}

ExpectedDepth expectedDepth(const Frame& frame, const Camera& before) {
    ExpectedDepth e;
    const auto rays = viewRays(frame);
    if (!rays || frame.camera->kind != before.kind) return e;
    // Previous depth = -(row z of toPrevious) . (X, Y, -depth, 1).
    const glm::dmat4 toPrevious = before.view * glm::inverse(frame.camera->view);
    const double rx = toPrevious[0][2], ry = toPrevious[1][2], rz = toPrevious[2][2], rw = toPrevious[3][2];
    const glm::dvec3 d = -(rx * rays->perDepth[0] + ry * rays->perDepth[1]) + glm::dvec3(0, 0, rz);
    const glm::dvec3 c = -(rx * rays->constant[0] + ry * rays->constant[1]) - glm::dvec3(0, 0, rw);
    e.known = true;
    for (int i = 0; i < 3; i++) e.perDepth[i] = float(d[i]), e.constant[i] = float(c[i]);
    return e;
}
ExpectedDepth expectedDepth(const Frame& frame) {
    if (frame.reset || !frame.previousCamera) return {};
    return expectedDepth(frame, *frame.previousCamera);
}

float sharpenGain(SharpenKernel kernel) { return kernel == SharpenKernel::xu ? 1.0f : 0.25f; }
void sharpenEncoded(const RgbaPlane& blend, SharpenKernel kernel, const Exec& exec, Rgb& out) {
    const SharpenHistoryArgs args{blend.row(0), view(out), blend.stride(), blend.width(), sharpenGain(kernel)};
    runKernel(temporalKernelsFor(exec).sharpen, exec, args, blend.height());
}
void sharpenEncodedRow(const RgbaPlane& blend, SharpenKernel kernel, const Exec& exec, int y, Rgb& out) {
    const SharpenHistoryArgs args{blend.row(0), view(out), blend.stride(), blend.width(), sharpenGain(kernel)};
    rowsOf(temporalKernelsFor(exec).sharpen, exec.precision)(args, y, y + 1);
}

TemporalDebug TemporalDebugLayers::begin(const Method& method, int width, int height) {
    TemporalDebug d;
    if (!method.keepDebugLayers && !method.keepRejection) return d;
    const auto fit = [&](PlaneF& plane) {
        if (plane.width() != width || plane.height() != height) plane = PlaneF(width, height);
        return plane.row(0);
    };
    d.rejection = fit(rejection_);
    if (!method.keepDebugLayers) return d;
    d.motionXPx = fit(motionX_), d.motionYPx = fit(motionY_);
    for (size_t c = 0; c < 3; c++) d.boxLow[c] = fit(boxLow_.c[c]), d.boxHigh[c] = fit(boxHigh_.c[c]);
    d.clipAmount = fit(clipAmount_), d.feedback = fit(feedback_);
    return d;
}

std::vector<DebugLayer> TemporalDebugLayers::layers() const {
    if (motionX_.empty()) return {};
    return {{"motionDilatedX", {motionX_}},
            {"motionDilatedY", {motionY_}},
            {"rejection", {rejection_}},
            {"boxLow", {boxLow_.c[0], boxLow_.c[1], boxLow_.c[2]}},
            {"boxHigh", {boxHigh_.c[0], boxHigh_.c[1], boxHigh_.c[2]}},
            {"clipAmount", {clipAmount_}},
            {"feedback", {feedback_}}};
}

}  // namespace aa
