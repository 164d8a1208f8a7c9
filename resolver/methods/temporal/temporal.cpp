#include "methods/temporal/temporal.h"

#include <cmath>

namespace aa {

namespace temporal {

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
void unjitter(const Frame& frame, TemporalIn& in, ExpectedDepth& e, const uint32_t*& objectId) {
    unjitter(frame, in);
    const glm::ivec2 texel = unjitteredTexel(frame);
    e = readBeside(e, texel);
    if (objectId) objectId += ptrdiff_t(texel.y) * in.stride + texel.x;
}
void unjitter(const Rgb& in, glm::dvec2 jitterPx, const Exec& exec, Rgb& out) {
    fitted(out, in.width(), in.height());
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
ExpectedDepth readBeside(ExpectedDepth e, glm::ivec2 texels) {
    e.perDepth[2] += e.perDepth[0] * float(texels.x) + e.perDepth[1] * float(texels.y);
    e.constant[2] += e.constant[0] * float(texels.x) + e.constant[1] * float(texels.y);
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
    const auto fit = [&](PlaneF& plane) { return fitted(plane, width, height).row(0); };
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
