// Frames of a few planes seen by a perspective camera, with exact geometry at every sub-sample: for the tests of the
// geometry-aware methods.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/gtc/matrix_transform.hpp>

#include "methods/geometry/rsaa_learn.h"
#include "methods/method.h"
#include "methods/spec.h"

namespace aa::testing {

struct PlaneSurface {
    glm::dvec3 normalView{0, 0, 1};  // unit
    double distance = -5;            // n.P = distance in view space; camera at 0 looking along -z
    glm::vec3 color{1.0f};
    uint32_t objectId = 1;
};
// Which surface is seen at a pixel position; -1 is the background.
using Visible = std::function<int(double x, double y)>;

struct TestScene {
    std::vector<PlaneSurface> surfaces;
    Visible visible;
    glm::vec3 background{0.0f};
};

inline Camera testCamera(int w, int h) {
    Camera c;
    c.view = glm::rotate(glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(0, 1, 0)), -0.3, glm::dvec3(1, 0, 0)) *
             glm::translate(glm::dmat4(1.0), glm::dvec3(-12, 3, 40));
    c.projection = glm::perspective(0.8, double(w) / h, 0.1, 100.0);
    return c;
}

struct Hit {
    int surface;
    float depthView;
    glm::vec3 normalWorld, color;
    uint32_t objectId;
};
inline Hit trace(const TestScene& scene, const Camera& camera, int w, int h, double x, double y) {
    const int i = scene.visible(x, y);
    if (i < 0) return {i, 1e10f, glm::vec3(0.0f), scene.background, 0};
    const PlaneSurface& s = scene.surfaces[size_t(i)];
    const glm::dvec3 ray((2 * x / w - 1) / camera.projection[0][0], (1 - 2 * y / h) / camera.projection[1][1], -1);
    return {i, float(s.distance / glm::dot(s.normalView, ray)),
            glm::vec3(glm::transpose(glm::dmat3(camera.view)) * s.normalView), s.color, s.objectId};
}

// The mask pass names the samples on the surface that the centre sample sees: ideal masks.
inline Frame renderPlanes(const TestScene& scene, int w, int h, const std::vector<glm::dvec2>& positionsPx,
                          glm::dvec2 jitterPx = {0, 0}) {
    Frame f;
    f.width = w, f.height = h, f.jitterPx = jitterPx;
    f.camera = testCamera(w, h);
    f.colorLinear = f.normalWorld = Rgb(w, h);
    f.depthView = PlaneF(w, h);
    f.edgeXPx = f.edgeYPx = PlaneF(w, h, 0.5f);
    f.objectId = f.subSampleMask = PlaneU(w, h);
    f.subSamplePositionsPx = positionsPx;
    f.subSamples.resize(positionsPx.size());
    for (auto& s : f.subSamples) s = {PlaneF(w, h), Rgb(w, h), PlaneU(w, h), Rgb(w, h)};
    const auto put = [](const Hit& hit, PlaneF& z, Rgb& n, PlaneU& id, Rgb& color, int x, int y) {
        z.at(x, y) = hit.depthView, id.at(x, y) = hit.objectId;
        for (int c = 0; c < 3; c++) {
            n.c[size_t(c)].at(x, y) = hit.normalWorld[c];
            color.c[size_t(c)].at(x, y) = hit.color[c];
        }
    };
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const glm::dvec2 p = glm::dvec2(x + 0.5, y + 0.5) + jitterPx;
            const Hit centre = trace(scene, *f.camera, w, h, p.x, p.y);
            put(centre, f.depthView, f.normalWorld, f.objectId, f.colorLinear, x, y);
            for (size_t k = 0; k < positionsPx.size(); k++) {
                SubSample& s = f.subSamples[k];
                const Hit hit = trace(scene, *f.camera, w, h, p.x + positionsPx[k].x, p.y + positionsPx[k].y);
                put(hit, s.depthView, s.normalWorld, s.objectId, s.colorLinear, x, y);
                f.subSampleMask.at(x, y) |= uint32_t(hit.surface == centre.surface) << k;
            }
        }
    f.colorLinear.fillBorder(), f.normalWorld.fillBorder(), f.depthView.fillBorder(), f.objectId.fillBorder();
    f.edgeXPx.fillBorder(), f.edgeYPx.fillBorder();
    return f;
}

// A straight line through the picture: surface 0 where nx x + ny y > r, surface 1 elsewhere.
struct Line {
    double nx, ny, r;
    bool has(double x, double y) const { return nx * x + ny * y > r; }
    Visible visible() const {
        return [l = *this](double x, double y) { return l.has(x, y) ? 0 : 1; };
    }
    // Area of pixel (px, py) on surface 0: the exact integral of a trapezoid (independent of the polygon clipper).
    double coverage(int px, int py) const {
        const double ax = std::abs(nx), ay = std::abs(ny);
        const double t = nx * (px + 0.5) + ny * (py + 0.5) - r;  // signed distance of the centre
        // Integral of the unit square's cross-section along the normal: a trapezoid of half-widths a >= b.
        const double a = (ax + ay) / 2, b = std::abs(ax - ay) / 2, height = 1 / std::max(ax, ay);
        const auto area = [&](double s) {  // of the part with coordinate < s along the normal
            if (s <= -a) return 0.0;
            if (s >= a) return 1.0;
            const double ramp = a - b, up = ramp > 0 ? ramp * height / 2 : 0;
            if (s < -b) return (s + a) * (s + a) * height / (2 * ramp);
            if (s <= b) return up + (s + b) * height;
            return 1 - (a - s) * (a - s) * height / (2 * ramp);
        };
        return area(t);
    }
};
inline const Line kLine{std::cos(0.4), std::sin(0.4), 22.3};  // in no special place
inline std::vector<Line> randomLines(int count, int w, int h) {
    std::vector<Line> lines;
    for (int i = 1; i <= count; i++) {  // 0 would pass exactly through pixel centres
        const double angle = 6.283185307179586 * std::fmod(0.5 + i * 0.7548776662466927, 1.0);  // R2 sequence
        const double shift = std::fmod(0.5 + i * 0.5698402909980532, 1.0) * 4 - 2;
        const double nx = std::cos(angle), ny = std::sin(angle);
        lines.push_back({nx, ny, nx * w / 2 + ny * h / 2 + shift});
    }
    return lines;
}
// White surface 0 before black surface 1, 4 and 9 units away, facing the camera, with different ids.
inline TestScene parallelPlanes(const Line& line) {
    return {{{{0, 0, 1}, -4, glm::vec3(1.0f), 1}, {{0, 0, 1}, -9, glm::vec3(0.0f), 2}}, line.visible()};
}

inline ShotInfo infoOf(const Frame& f) {
    ShotInfo s;
    s.width = f.width, s.height = f.height;
    s.subSamplePositionsPx = f.subSamplePositionsPx;
    return s;
}
inline Rgb resolved(const std::string& method, const Frame& f, const Exec& exec = {},
                    std::vector<DebugLayer>* layers = nullptr) {
    Rgb out(f.width, f.height, -1);
    const auto m = parseMethod(method).create(infoOf(f));
    m->keepDebugLayers = layers != nullptr;
    m->resolve(f, exec, out);
    if (layers) *layers = m->debugLayers();
    return out;
}
inline const PlaneF& layer(const std::vector<DebugLayer>& layers, std::string_view name) {
    return std::find_if(layers.begin(), layers.end(), [&](const auto& l) { return l.name == name; })->planes[0];
}

// PSNR gain over no anti-aliasing on pictures of one line each, over the pixels that the line cuts (conventions 14).
// `change` may alter the rendered frame.
inline double halfPlaneGainDb(const std::string& method, const std::vector<glm::dvec2>& positionsPx,
                              const std::function<void(Frame&, const Line&)>& change = {},
                              const std::function<bool(const Line&)>& wanted = {}) {
    double plain = 0, smooth = 0;
    const int size = 33;
    std::unique_ptr<Method> running;
    for (const Line& line : randomLines(150, size, size)) {
        if (wanted && !wanted(line)) continue;
        Frame f = renderPlanes(parallelPlanes(line), size, size, positionsPx);
        if (change) change(f, line);
        if (!running) running = parseMethod(method).create(infoOf(f));
        Rgb out(size, size);
        running->resolve(f, {}, out);
        for (int y = 1; y < size - 1; y++)
            for (int x = 1; x < size - 1; x++) {
                const double truth = line.coverage(x, y);
                if (truth <= 0 || truth >= 1) continue;
                plain += std::pow(double(f.colorLinear.c[0].at(x, y)) - truth, 2);
                smooth += std::pow(double(out.c[0].at(x, y)) - truth, 2);
            }
    }
    return 10 * std::log10(plain / smooth);
}

}  // namespace aa::testing
