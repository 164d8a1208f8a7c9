// Temporal methods at 1920x1080, one thread, in ns per pixel (the budget is 15; 30 for asaa, t2msaa, fsr2n).
//
// The frame is synthetic and aliased on purpose: discs, thin bars and a checker floor under a pan, with discs that move
// on their own, so that the history is read at fractional and at differing positions.
#include <benchmark/benchmark.h>

#include <cmath>

#include "methods/driver.h"

namespace aa {
namespace {

constexpr int kWidth = 1920, kHeight = 1080;

struct Surface {
    float color[3], depthView, motionXPx, motionYPx;
    uint32_t id;
};
Surface surfaceAt(double x, double y, int number) {
    const double u = x - 1.7 * number, v = y - 0.4 * number;  // pan
    for (int i = 0; i < 12; i++) {                            // discs with their own motion
        const double cx = 150 + i * 150 + 3.1 * number * (i % 3), cy = 200 + 60 * ((i * 7) % 11);
        if ((x - cx) * (x - cx) + (y - cy) * (y - cy) < 45 * 45)
            return {{0.9f, 0.1f * float(i % 7), 0.2f}, 3 + 0.1f * float(i), 3.1f * float(i % 3), 0, 10 + uint32_t(i)};
    }
    if (std::fmod(u * 0.97 + v * 0.23 + 4000, 61.0) < 1.3) return {{0.1f, 0.1f, 0.12f}, 6, 1.7f, 0.4f, 2};
    if (v > 540) {
        const bool dark = (int(std::floor(u / 23)) + int(std::floor(v / 17))) & 1;
        return {{dark ? 0.05f : 0.7f, dark ? 0.06f : 0.6f, 0.3f}, float(4000 / (v - 400)), 1.7f, 0.4f, 3};
    }
    return {{0.3f, 0.5f, 0.9f}, 1e10f, 1.7f, 0.4f, 0};
}

Frame syntheticFrame(int number, PassSet passes, const std::vector<glm::dvec2>& subSamplesPx) {
    const double jitter[4][2] = {{-0.25, 0.125}, {0.25, -0.375}, {-0.375, -0.125}, {0.125, 0.375}};
    const bool sampled = passes.hasAnyOf(Pass::subsamples | Pass::subsampleColor);
    Frame f;
    f.number = number;
    f.width = kWidth, f.height = kHeight;
    f.reset = number == 0;
    f.jitterPx = {jitter[number % 4][0], jitter[number % 4][1]};
    f.passes = passes;
    Camera camera;  // perspective, near 0.1, far 100
    camera.projection = glm::dmat4(0.0);
    camera.projection[0][0] = 2.0 * kHeight / kWidth, camera.projection[1][1] = 2.0;
    camera.projection[2][2] = -1.002, camera.projection[2][3] = -1.0, camera.projection[3][2] = -0.2002;
    f.camera = camera;
    if (!f.reset) f.previousCamera = camera;
    f.colorLinear = f.albedoLinear = Rgb(kWidth, kHeight);
    f.depthView = f.motionXPx = f.motionYPx = PlaneF(kWidth, kHeight);
    f.objectId = PlaneU(kWidth, kHeight);
    f.subSamplePositionsPx = subSamplesPx;
    f.subSamples.resize(sampled ? subSamplesPx.size() : 0);
    for (auto& s : f.subSamples) {
        s.depthView = PlaneF(kWidth, kHeight);
        s.colorLinear = Rgb(kWidth, kHeight);
        s.objectId = PlaneU(kWidth, kHeight);
    }
    for (int y = 0; y < kHeight; y++)
        for (int x = 0; x < kWidth; x++) {
            const Surface p = surfaceAt(x + 0.5 + f.jitterPx.x, y + 0.5 + f.jitterPx.y, number);
            for (size_t c = 0; c < 3; c++) f.colorLinear.c[c].at(x, y) = f.albedoLinear.c[c].at(x, y) = p.color[c];
            f.depthView.at(x, y) = p.depthView;
            f.motionXPx.at(x, y) = p.motionXPx, f.motionYPx.at(x, y) = p.motionYPx;
            f.objectId.at(x, y) = p.id;
            for (size_t s = 0; s < f.subSamples.size(); s++) {
                const Surface t = surfaceAt(x + 0.5 + subSamplesPx[s].x, y + 0.5 + subSamplesPx[s].y, number);
                for (size_t c = 0; c < 3; c++) f.subSamples[s].colorLinear.c[c].at(x, y) = t.color[c];
                f.subSamples[s].depthView.at(x, y) = t.depthView;
                f.subSamples[s].objectId.at(x, y) = t.id;
            }
        }
    for (Rgb* i : {&f.colorLinear, &f.albedoLinear}) i->fillBorder();
    for (PlaneF* p : {&f.depthView, &f.motionXPx, &f.motionYPx}) p->fillBorder();
    f.objectId.fillBorder();
    for (auto& s : f.subSamples) s.colorLinear.fillBorder(), s.depthView.fillBorder(), s.objectId.fillBorder();
    encodeFrame(f, {}, {});
    return f;
}

void resolveFrames(benchmark::State& state, const std::string& text) {
    const MethodSpec spec = parseMethod(text);
    const std::vector<glm::dvec2> subSamplesPx = {{0.25, 0.25}, {-0.25, -0.25}};
    std::vector<Frame> frames;
    for (int n = 0; n < 3; n++) frames.push_back(syntheticFrame(n, spec.passes(), subSamplesPx));
    const ShotInfo shot{.width = kWidth,
                        .height = kHeight,
                        .jitterPeriod = 4,
                        .frameCount = 1000,
                        .subSamplePositionsPx = subSamplesPx};
    const auto method = spec.create(shot);
    Rgb out(kWidth, kHeight);
    Exec exec;
    exec.parallel = false;
    method->resolve(frames[0], exec, out);
    size_t n = 0;
    for (auto _ : state) method->resolve(frames[1 + n++ % 2], exec, out);
    state.counters["perPixel"] = benchmark::Counter(
        double(kWidth) * kHeight, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
    state.counters["stateMB"] = double(method->stateBytes()) / (1024.0 * 1024.0);
}

const bool registered = [] {
    for (const auto& m : registry())
        if (m.family == "temporal")
            benchmark::RegisterBenchmark(("temporal/" + std::string(m.id)).c_str(),
                                         [id = std::string(m.id)](benchmark::State& s) { resolveFrames(s, id); })
                ->Unit(benchmark::kMillisecond)
                ->MinTime(0.3);
    return true;
}();

}  // namespace
}  // namespace aa
