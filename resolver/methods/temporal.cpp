#include "methods/temporal.h"

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
    frames_ = fresh ? 0 : frames_ + 1;
    in.history = fresh ? nullptr : planes_[current_].row(0);
    in.next = planes_[1 - current_].row(0);
}

void ColourHistory::end() {
    current_ = 1 - current_;
    planes_[current_].fillBorder();
}

namespace temporal {

ParamSpec dilationParam(std::string_view def, std::string_view source) {
    return choiceParam(
        "dilation", def, {"closest3x3", "closestX", "longest3x3", "none"},
        "whose motion a pixel takes: nearest to the camera in 3x3, of centre and diagonals, longest, own", source);
}
ParamSpec historyFilterParam(std::string_view def, std::string_view source) {
    return choiceParam("history", def, {"bilinear", "catmullRom", "catmullRom5"},
                       "filter that reads the history: 2x2, 4x4, 4x4 without corners", source);
}
ParamSpec neighbourhoodParam(std::string_view def, std::string_view source) {
    return choiceParam("neighbourhood", def, {"rounded", "3x3", "plus"},
                       "window of the colour box: mean of 3x3 and plus, 3x3, plus", source);
}
ParamSpec clipTargetParam(std::string_view def, std::string_view source) {
    return choiceParam("clipTarget", def, {"aabbCentre", "mean", "current", "clamp"},
                       "point toward which history is clipped; clamp: per channel instead", source);
}
ParamSpec warmupParam() {
    return choiceParam("warmup", "none", {"none", "ramp"},
                       "frames after a reset: none keeps the feedback, ramp averages the first frames evenly",
                       "methods/06 s.6.0; none is the protocol of seed 000");
}
ParamSpec outsideParam() {
    return choiceParam("outside", "reject", {"reject", "clamp"},
                       "history position outside the image: take the current colour, or the history's edge",
                       "methods/06 s.6.3");
}
ParamSpec sharpenParam(std::string_view def, std::string_view source) {
    return choiceParam("sharpen", def, {"none", "xu", "norm"},
                       "sharpening of the output, never fed back: plus-shaped kernel with neighbours -1 or -1/4",
                       source);
}
ParamSpec kMinParam(std::string_view def, std::string_view source) {
    return realParam("kmin", def, 0, 1, "weight of history where its luminance differs most", source);
}
ParamSpec kMaxParam(std::string_view def, std::string_view source) {
    return realParam("kmax", def, 0, 1, "weight of history where its luminance is that of the current colour", source);
}
void requireOrdered(std::string_view method, const Params& p) {
    if (p.real("kmin") > p.real("kmax"))
        throw UsageError(std::string(method) + ": expected kmin <= kmax, found kmin=" + p.all().find("kmin")->second +
                         " and kmax=" + p.all().find("kmax")->second);
}

Dilation dilation(const Params& p) { return Dilation(p.choiceIndex("dilation")); }
HistoryFilter historyFilter(const Params& p) { return HistoryFilter(p.choiceIndex("history")); }
Neighbourhood neighbourhood(const Params& p) { return Neighbourhood(p.choiceIndex("neighbourhood")); }
ClipTarget clipTarget(const Params& p) { return ClipTarget(p.choiceIndex("clipTarget")); }
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

float feedbackCeiling(const Params& p, int framesSinceReset) {
    return p.choice("warmup") == "ramp" ? 1.0f - 1.0f / float(framesSinceReset + 1) : 1.0f;
}

}  // namespace temporal

ExpectedDepth expectedDepth(const Frame& frame) {
    ExpectedDepth e;
    if (!frame.camera || !frame.previousCamera || frame.reset) return e;
    const Camera &now = *frame.camera, &before = *frame.previousCamera;
    const bool perspective = now.kind == "perspective";
    if (now.kind != before.kind || (!perspective && now.kind != "orthographic")) return e;
    // View position of the sample at pixel position p: clip x = P00 X + P20 Z + P30, and w = -Z or 1. The sample lies
    // at p + jitter. Z = -depth.
    const glm::dmat4& P = now.projection;
    const glm::dmat4 toPrevious = before.view * glm::inverse(now.view);
    const double ndc[2][3] = {{2.0 / frame.width, 0, 2.0 * frame.jitterPx.x / frame.width - 1},
                              {0, -2.0 / frame.height, 1 - 2.0 * frame.jitterPx.y / frame.height}};
    // Row vectors over (p.x, p.y, 1): X = depth * perDepth + constant.
    glm::dvec3 perDepth[2], constant[2];
    for (int i = 0; i < 2; i++) {
        const double scale = P[i][i];
        if (scale == 0) return e;
        const glm::dvec3 n(ndc[i][0], ndc[i][1], ndc[i][2]), unit(0, 0, 1);
        perDepth[i] = (perspective ? n + unit * P[2][i] : unit * P[2][i]) / scale;
        constant[i] = (perspective ? unit * -P[3][i] : n - unit * P[3][i]) / scale;
    }
    // Previous depth = -(row 2 of toPrevious) . (X, Y, -depth, 1).
    const double rx = toPrevious[0][2], ry = toPrevious[1][2], rz = toPrevious[2][2], rw = toPrevious[3][2];
    const glm::dvec3 d = -(rx * perDepth[0] + ry * perDepth[1]) + glm::dvec3(0, 0, rz);
    const glm::dvec3 c = -(rx * constant[0] + ry * constant[1]) - glm::dvec3(0, 0, rw);
    e.known = true;
    for (int i = 0; i < 3; i++) e.perDepth[i] = float(d[i]), e.constant[i] = float(c[i]);
    return e;
}

void sharpenEncoded(const RgbaPlane& blend, SharpenKernel kernel, const Exec& exec, Rgb& out) {
    const SharpenArgs args{blend.row(0), view(out), blend.stride(), blend.width(),
                           kernel == SharpenKernel::xu ? 1.0f : 0.25f};
    runKernel(temporalKernelsFor(exec.isa).sharpen, exec, args, blend.height());
}

TemporalDebug TemporalDebugLayers::begin(int width, int height) {
    if (motionX_.width() != width || motionX_.height() != height) {
        for (Rgb* image : {&boxLow_, &boxHigh_}) *image = Rgb(width, height);
        for (PlaneF* plane : {&motionX_, &motionY_, &rejection_, &clipAmount_, &feedback_})
            *plane = PlaneF(width, height);
    }
    TemporalDebug d;
    d.motionXPx = motionX_.row(0), d.motionYPx = motionY_.row(0);
    d.rejection = rejection_.row(0);
    for (size_t c = 0; c < 3; c++) d.boxLow[c] = boxLow_.c[c].row(0), d.boxHigh[c] = boxHigh_.c[c].row(0);
    d.clipAmount = clipAmount_.row(0), d.feedback = feedback_.row(0);
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
