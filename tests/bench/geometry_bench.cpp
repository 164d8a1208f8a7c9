// Geometry-aware methods at 1920x1080, one thread, in ns per pixel. Target: rsaa of 8 sub-samples at most 10. Planes
// are read from memory, 160 bytes per pixel where the masks are computed: a busy machine shows its bandwidth, not the
// kernel.
//
// The frame is a synthetic interior: walls of several angles, 40 boxes and 60 thin bars before them, sky above.
// "edgeShare" is the share of pixels with sub-samples on more than one surface: rendered scenes show 3 to 10 %.
#include <benchmark/benchmark.h>

#include <cmath>

#include "methods/driver.h"
#include "shot/patterns.h"

namespace aa {
namespace {

constexpr int kWidth = 1920, kHeight = 1080;

struct Surface {
    float depthView, normal[3], color;
    uint32_t id;
};
// Planes facing the camera with small tilts: depth by the plane's equation along the pixel's ray.
Surface onPlane(double x, double y, double distance, double tiltX, double tiltY, uint32_t id) {
    const double length = std::sqrt(1 + tiltX * tiltX + tiltY * tiltY);
    const double n[3] = {tiltX / length, tiltY / length, 1 / length};
    const double rayX = (2 * x / kWidth - 1) * kWidth / (2.0 * kHeight), rayY = (1 - 2 * y / kHeight) / 2;
    const double z = -distance / (n[0] * rayX + n[1] * rayY - n[2]);
    return {float(z), {float(n[0]), float(n[1]), float(n[2])}, 0.1f * float(1 + id % 9), id};
}
Surface surfaceAt(double x, double y) {
    for (int i = 0; i < 60; i++) {  // bars, most about a pixel wide
        const double along = 0.02 * (i - 30), offset = x - 30.0 * i - along * y - 17;
        if (offset > 0 && offset < 0.6 + 0.15 * (i % 9) && y > 100 + 12 * (i % 20) && y < 420 + 11 * i)
            return onPlane(x, y, 3 + 0.01 * i, 0, 0, 100 + uint32_t(i));
    }
    for (int i = 0; i < 40; i++) {  // boxes, two visible faces each
        const double u = x - (40.0 + 47 * i), v = y - (300 + 53 * ((i * 11) % 13)) - 0.12 * u * ((i % 5) - 2);
        if (u > 0 && u < 70 && v > 0 && v < 90)
            return onPlane(x, y, 5 + 0.05 * i, u < 40 ? 0.6 : -0.8, 0, 10 + uint32_t(i));
    }
    if (y < 200 + 0.05 * x) return {1e10f, {0, 0, 0}, 0.9f, 0};
    return y < 700 - 0.1 * x ? onPlane(x, y, 12, 0.2, 0, 1) : onPlane(x, y, 2.2, 0, 4, 2);
}

struct TestFrame {
    Frame frame;
    double edgeShare = 0;
};
const TestFrame& testFrame(int samples) {
    static std::map<int, TestFrame> frames;
    TestFrame& t = frames[samples];
    Frame& f = t.frame;
    if (f.width) return t;
    f.width = kWidth, f.height = kHeight;
    Camera camera;
    camera.projection = glm::dmat4(0.0);
    camera.projection[0][0] = 2.0 * kHeight / kWidth, camera.projection[1][1] = 2.0;
    camera.projection[2][2] = -1.002, camera.projection[2][3] = -1.0, camera.projection[3][2] = -0.2002;
    f.camera = camera;
    f.colorLinear = f.normalWorld = Rgb(kWidth, kHeight);
    f.depthView = PlaneF(kWidth, kHeight);
    f.edgeXPx = f.edgeYPx = PlaneF(kWidth, kHeight, 0.5f);
    f.objectId = f.subSampleMask = PlaneU(kWidth, kHeight);
    f.subSamplePositionsPx = patternPositionsPx("d3d" + std::to_string(samples));
    f.subSamples.resize(size_t(samples));
    for (auto& s : f.subSamples)
        s = {PlaneF(kWidth, kHeight), Rgb(kWidth, kHeight), PlaneU(kWidth, kHeight), Rgb(kWidth, kHeight)};
    const auto put = [](const Surface& s, PlaneF& z, Rgb& n, PlaneU& id, Rgb& color, int x, int y) {
        z.at(x, y) = s.depthView, id.at(x, y) = s.id;
        for (size_t c = 0; c < 3; c++) n.c[c].at(x, y) = s.normal[c], color.c[c].at(x, y) = s.color;
    };
    const uint32_t full = (1u << samples) - 1u;
    size_t edges = 0;
    for (int y = 0; y < kHeight; y++)
        for (int x = 0; x < kWidth; x++) {
            const Surface centre = surfaceAt(x + 0.5, y + 0.5);
            put(centre, f.depthView, f.normalWorld, f.objectId, f.colorLinear, x, y);
            uint32_t mask = 0;
            for (size_t k = 0; k < f.subSamples.size(); k++) {
                const glm::dvec2 p = f.subSamplePositionsPx[k];
                const Surface s = surfaceAt(x + 0.5 + p.x, y + 0.5 + p.y);
                SubSample& sub = f.subSamples[k];
                put(s, sub.depthView, sub.normalWorld, sub.objectId, sub.colorLinear, x, y);
                mask |= uint32_t(s.id == centre.id && s.normal[0] == centre.normal[0]) << k;
            }
            f.subSampleMask.at(x, y) = mask;
            edges += mask != full;
            if (mask != full) f.edgeXPx.at(x, y) = 0.3f;
        }
    t.edgeShare = double(edges) / (double(kWidth) * kHeight);
    for (Rgb* i : {&f.colorLinear, &f.normalWorld}) i->fillBorder();
    for (PlaneF* p : {&f.depthView, &f.edgeXPx, &f.edgeYPx}) p->fillBorder();
    f.objectId.fillBorder();
    return t;
}

void resolveFrame(benchmark::State& state, const char* text, int samples) {
    const TestFrame& t = testFrame(samples);
    const auto method = parseMethod(text).create(
        {.width = kWidth, .height = kHeight, .subSamplePositionsPx = t.frame.subSamplePositionsPx});
    Rgb out(kWidth, kHeight);
    Exec exec;
    exec.parallel = false;
    for (auto _ : state) method->resolve(t.frame, exec, out);
    // seconds per iteration * 1e9 / pixels
    state.counters["ns/px"] = benchmark::Counter(
        double(kWidth) * kHeight * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    state.counters["edgeShare"] = t.edgeShare;
}
BENCHMARK_CAPTURE(resolveFrame, rsaa8, "rsaa", 8);
BENCHMARK_CAPTURE(resolveFrame, rsaa8_computed, "rsaa:mask=geometry", 8);
BENCHMARK_CAPTURE(resolveFrame, rsaa8_computedNoIds, "rsaa:ids=off", 8);
BENCHMARK_CAPTURE(resolveFrame, rsaa8_computedUntuned, "rsaa:mask=geometry,tuning=off", 8);
BENCHMARK_CAPTURE(resolveFrame, rsaa8_computedDepth, "rsaa:measure=depth,ids=off", 8);
BENCHMARK_CAPTURE(resolveFrame, rsaa8_untuned, "rsaa:tuning=off", 8);
BENCHMARK_CAPTURE(resolveFrame, noaa, "noaa", 8);
BENCHMARK_CAPTURE(resolveFrame, ssaa8, "ssaa", 8);
BENCHMARK_CAPTURE(resolveFrame, msaa8, "msaa", 8);
BENCHMARK_CAPTURE(resolveFrame, csaa8, "csaa", 8);
BENCHMARK_CAPTURE(resolveFrame, dmsaa8, "dmsaa", 8);
BENCHMARK_CAPTURE(resolveFrame, sbaa8, "sbaa", 8);
BENCHMARK_CAPTURE(resolveFrame, sraa4, "sraa", 4);
BENCHMARK_CAPTURE(resolveFrame, rsaa4, "rsaa", 4);
BENCHMARK_CAPTURE(resolveFrame, rsaa4_computed, "rsaa:mask=geometry", 4);
BENCHMARK_CAPTURE(resolveFrame, gbaa, "gbaa", 4);
BENCHMARK_CAPTURE(resolveFrame, d2e, "d2e", 4);

}  // namespace
}  // namespace aa
