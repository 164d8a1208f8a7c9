// ns per pixel of the metrics at 1920 x 1080, one thread. Targets on AVX2: SSIM RGB <= 9, LDR-FLIP <= 23.
// AARESOLVE_BENCH_ISA=v2|v3|v4 chooses the instruction set.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdlib>
#include <string_view>

#include "metrics/cvvdp.h"
#include "metrics/flip.h"
#include "metrics/fourier.h"
#include "metrics/hdr_flip.h"
#include "metrics/metrics.h"

namespace aa {
namespace {
constexpr int kWidth = 1920, kHeight = 1080;

const Rgb& image(int which) {
    static const auto make = [](float phase) {
        Rgb i(kWidth, kHeight);
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < kHeight; y++)
                for (int x = 0; x < kWidth; x++)
                    i.c[c].at(x, y) =
                        0.5f + 0.49f * std::sin(0.001f * float(x * x % 7919) + 0.02f * float(y) + phase + float(c));
        i.fillBorder();
        return i;
    };
    static const Rgb images[2] = {make(0), make(0.1f)};
    return images[which];
}
template <class Metric>
void measure(benchmark::State& state, Metric metric) {
    Exec exec;
    exec.parallel = false;
    if (const char* isa = std::getenv("AARESOLVE_BENCH_ISA"))
        exec.isa = std::string_view(isa) == "v2" ? Isa::v2 : std::string_view(isa) == "v3" ? Isa::v3 : Isa::v4;
    image(0);
    for (auto _ : state) benchmark::DoNotOptimize(metric(image(0), image(1), exec));
    // seconds per iteration * 1e9 / pixels
    state.counters["ns/px"] = benchmark::Counter(
        double(kWidth) * kHeight * 1e-9, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK_CAPTURE(measure, squaredError, [](auto& t, auto& r, auto& e) { return squaredError(t, r, e).mse; });
BENCHMARK_CAPTURE(measure, relMse, [](auto& t, auto& r, auto& e) { return relMse(t, r, e); });
BENCHMARK_CAPTURE(measure, ssimLuma, [](auto& t, auto& r, auto& e) { return ssimLuma(t, r, e); });
BENCHMARK_CAPTURE(measure, ssimRgb, [](auto& t, auto& r, auto& e) { return ssimRgb(t, r, e); });
BENCHMARK_CAPTURE(measure, ssimMatlab3D, [](auto& t, auto& r, auto& e) { return ssimMatlab3D(t, r, e); });
BENCHMARK_CAPTURE(measure, flip, [](auto& t, auto& r, auto& e) { return flip(t, r, e); });
// Of a reference that other pictures were held against before, as in a run.
BENCHMARK_CAPTURE(measure, flipAgain, [](auto& t, auto& r, auto& e) {
    static const FlipReference reference(r, FlipReference::Values::encoded, e);
    return reference.flip(t, e);
});
BENCHMARK_CAPTURE(measure, hdrFlip, [](auto& t, auto& r, auto& e) { return hdrFlip(t, r, e); });
// A frame of a sequence at 30 per second: the reference's part, which all methods share, and a method's.
BENCHMARK_CAPTURE(measure, cvvdp, [](auto& t, auto& r, auto& e) {
    static const auto reference = cvvdp({.width = kWidth, .height = kHeight});
    static const auto test = reference->test();
    reference->add({r}, e);
    return test->add({t}, e)[0];
});
BENCHMARK_CAPTURE(measure, fourier, [](auto& t, auto& r, auto& e) { return fourierError(t, r, e).fmse; });
}  // namespace
}  // namespace aa
