// Spatial methods at 1080p on one thread: ns per pixel and per edge pixel. `--benchmark_filter=smaa` picks methods.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include "methods/method.h"
#include "methods/spec.h"

namespace {
using namespace aa;

// Triangles, thin wires and a checkered floor in perspective, point-sampled: 8-18 % of the pixels lie on edges.
Rgb scene(int width, int height) {
    std::mt19937 random(1);
    auto uniform = [&](double lo, double hi) { return lo + (hi - lo) * (random() * (1.0 / 4294967296.0)); };
    Rgb image(width, height);
    const double horizon = 0.45 * height;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            double v = 0.35 + 0.3 * y / height;
            if (y > horizon) {
                const double z = 0.5 * height / (y + 0.5 - horizon), u = (x - 0.5 * width) / width * z * 6;
                v = (int(std::floor(u)) + int(std::floor(z * 3))) & 1 ? 0.7 : 0.25;
            }
            for (size_t c = 0; c < 3; c++) image.c[c].at(x, y) = float(v * (c == 2 ? 0.9 : 1));
        }
    for (int k = 0; k < 380; k++) {
        const bool wire = k >= 220;
        double px[3], py[3];
        px[0] = uniform(0, width), py[0] = uniform(0, height);
        const double size = wire ? 500 : uniform(10, 90), angle = uniform(0, 6.2831853);
        px[1] = px[0] + size * std::cos(angle), py[1] = py[0] + size * std::sin(angle);
        const double thickness = wire ? uniform(0.6, 2.5) : uniform(10, 90);
        px[2] = px[0] - thickness * std::sin(angle), py[2] = py[0] + thickness * std::cos(angle);
        float colour[3];
        for (float& c : colour) c = float(uniform(0, 1));
        const int x0 = std::max(0, int(std::min({px[0], px[1], px[2]}))),
                  x1 = std::min(width, int(std::max({px[0], px[1], px[2]})) + 2);
        const int y0 = std::max(0, int(std::min({py[0], py[1], py[2]}))),
                  y1 = std::min(height, int(std::max({py[0], py[1], py[2]})) + 2);
        auto side = [&](int i, double x, double y) {
            const int j = (i + 1) % 3;
            return (px[j] - px[i]) * (y - py[i]) - (py[j] - py[i]) * (x - px[i]) >= 0;
        };
        for (int y = y0; y < y1; y++)
            for (int x = x0; x < x1; x++)
                if (side(0, x + .5, y + .5) && side(1, x + .5, y + .5) && side(2, x + .5, y + .5))
                    for (size_t c = 0; c < 3; c++) image.c[c].at(x, y) = colour[c];
    }
    image.fillBorder();
    return image;
}
const Frame& benchFrame() {
    static const Frame frame = [] {
        Frame f;
        f.width = 1920, f.height = 1080;
        f.colorEncoded = scene(f.width, f.height);
        decode(f.colorEncoded, {}, {}, f.colorLinear);
        f.passes = Pass::color;
        return f;
    }();
    return frame;
}
double edgePixels(const Rgb& image) {  // luma differs by 0.1 from the pixel to the left or above
    double n = 0;
    for (int y = 0; y < image.height(); y++)
        for (int x = 0; x < image.width(); x++) {
            auto luma = [&](int i, int j) {
                return 0.2126f * image.c[0].at(i, j) + 0.7152f * image.c[1].at(i, j) + 0.0722f * image.c[2].at(i, j);
            };
            const float l = luma(x, y);
            n += std::abs(l - luma(x - 1, y)) >= 0.1f || std::abs(l - luma(x, y - 1)) >= 0.1f;
        }
    return n;
}
void spatial(benchmark::State& state, const char* spec) {
    const Frame& frame = benchFrame();
    static const double edges = edgePixels(frame.colorEncoded);
    const double pixels = double(frame.width) * frame.height;
    const auto method = parseMethod(spec).create({.width = frame.width, .height = frame.height, .isStatic = true});
    Exec exec;
    exec.parallel = false;
    Rgb out(frame.width, frame.height);
    for (auto _ : state) method->resolve(frame, exec, out);
    using benchmark::Counter;
    const auto perIteration = Counter::kIsIterationInvariantRate | Counter::kInvert;
    state.counters["s_per_px"] = Counter(pixels, perIteration);
    state.counters["s_per_edge_px"] = Counter(edges, perIteration);
    state.counters["edge_share"] = edges / pixels;
}
#define AA_BENCH(name, spec) BENCHMARK_CAPTURE(spatial, name, spec)->Unit(benchmark::kMillisecond)
AA_BENCH(noaa, "noaa");
AA_BENCH(fxaa311_12, "fxaa311:preset=12");
AA_BENCH(fxaa311_39, "fxaa311:preset=39");
AA_BENCH(fxaa1_5, "fxaa1:preset=5");
AA_BENCH(fxaacs, "fxaacs");
AA_BENCH(fxaaconsole, "fxaaconsole");
AA_BENCH(mlaa, "mlaa");
AA_BENCH(smaa_LOW, "smaa1x:preset=LOW");
AA_BENCH(smaa_MEDIUM, "smaa1x:preset=MEDIUM");
AA_BENCH(smaa_HIGH, "smaa1x:preset=HIGH");
AA_BENCH(smaa_ULTRA, "smaa1x:preset=ULTRA");
AA_BENCH(smaa_HIGH_colour, "smaa1x:preset=HIGH,edges=colour");
AA_BENCH(dlaa, "dlaa");
AA_BENCH(nfaa, "nfaa");
AA_BENCH(ssssaa, "ssssaa");
}  // namespace
