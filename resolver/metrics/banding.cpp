#include "metrics/banding.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "metrics/metric.h"

namespace aa {
namespace {
constexpr int kReach = 12;      // px on each side: three sigma
constexpr double kSigmaPx = 4;  // of a step of 8 px and more, most is left
constexpr float kLeastSpan = 0.5f / 255, kMostSpan = 4.0f / 255;

std::array<double, 2 * kReach + 1> gaussian() {
    std::array<double, 2 * kReach + 1> taps;
    double sum = 0;
    for (int i = -kReach; i <= kReach; i++)
        sum += taps[size_t(i + kReach)] = std::exp(-0.5 * i * i / (kSigmaPx * kSigmaPx));
    for (double& t : taps) t /= sum;
    return taps;
}

// One row's window sums along x: least and most of R, and the blurred error.
struct Along {
    std::vector<float> least, most;
    std::vector<double> blurred;
};
struct RowSums {
    double banding = 0, grain = 0, count = 0;
};
}  // namespace

Banding banding(const Rgb& test, const Rgb& reference, const Exec& exec) {
    const int w = test.width(), h = test.height();
    if (w <= 2 * kReach || h <= 2 * kReach) return {};
    const auto taps = gaussian();
    std::vector<Along> along(
        size_t(h), {std::vector<float>(size_t(w)), std::vector<float>(size_t(w)), std::vector<double>(size_t(w))});
    std::vector<RowSums> sums(along.size());
    for (size_t c = 0; c < 3; c++) {
        const auto error = [&](int x, int y) { return double(test.c[c].at(x, y)) - double(reference.c[c].at(x, y)); };
        forRows(exec, h, [&](int y0, int y1) {
            for (int y = y0; y < y1; y++) {
                const float* r = reference.c[c].row(y);
                Along& to = along[size_t(y)];
                for (int x = kReach; x < w - kReach; x++) {
                    const auto [least, most] = std::minmax_element(r + x - kReach, r + x + kReach + 1);
                    to.least[size_t(x)] = *least, to.most[size_t(x)] = *most;
                    double sum = 0;
                    for (int i = -kReach; i <= kReach; i++) sum += taps[size_t(i + kReach)] * error(x + i, y);
                    to.blurred[size_t(x)] = sum;
                }
            }
        });
        forRows(exec, h, [&](int y0, int y1) {
            for (int y = std::max(y0, kReach); y < std::min(y1, h - kReach); y++)
                for (int x = kReach; x < w - kReach; x++) {
                    const size_t at = size_t(x);
                    float least = INFINITY, most = -INFINITY;
                    double blurred = 0;
                    for (int i = -kReach; i <= kReach; i++) {
                        const Along& row = along[size_t(y + i)];
                        least = std::min(least, row.least[at]), most = std::max(most, row.most[at]);
                        blurred += taps[size_t(i + kReach)] * row.blurred[at];
                    }
                    if (!(most - least >= kLeastSpan && most - least <= kMostSpan)) continue;
                    const double rest = error(x, y) - blurred;
                    RowSums& row = sums[size_t(y)];
                    row.banding += blurred * blurred, row.grain += rest * rest, row.count++;
                }
        });
    }
    RowSums all;
    for (const RowSums& row : sums) all.banding += row.banding, all.grain += row.grain, all.count += row.count;
    if (all.count == 0) return {};
    return {255 * std::sqrt(all.banding / all.count), 255 * std::sqrt(all.grain / all.count),
            all.count / (3.0 * w * h)};
}

Metric bandingMetric() {
    return {.figures = {{"banding", "banding",
                         "steps on slow gradients, RMS in 8-bit codes; the truth must not be rounded"},
                        {"grain", "grain", "noise on slow gradients, RMS in 8-bit codes"}},
            .nsPerPixel = 200,
            .source = "decisions 54",
            .measure = [](const ImagePair& i, const Exec& exec) {
                const Banding b = banding(i.testEncoded, i.referenceEncoded, exec);
                return std::vector{b.banding, b.grain};
            }};
}

}  // namespace aa
