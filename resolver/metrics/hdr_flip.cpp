#include "metrics/hdr_flip.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "metrics/flip.h"
#include "metrics/metric.h"

namespace aa {
namespace {
// (x^2 a + x b) / (x^2 c + x d + e): [Narkowicz 2016] of 0.6 x.
constexpr double kA = 0.36 * 2.51, kB = 0.6 * 0.03, kC = 0.36 * 2.43, kD = 0.6 * 0.59, kE = 0.14;
constexpr double kMostStops = 20;

// What is tone-mapped to 0.85.
double brightest() {
    constexpr double t = 0.85, a = kA - t * kC, b = kB - t * kD, c = -t * kE;
    const double middle = -b / (2 * a);
    return middle + std::sqrt(middle * middle - c / a);
}
void toneMapped(const Rgb& linear, double exposure, const Exec& exec, Rgb& shown) {
    const float scale = float(std::exp2(exposure));
    forRows(exec, linear.height(), [&](int y0, int y1) {
        for (size_t c = 0; c < 3; c++)
            for (int y = y0; y < y1; y++) {
                const float* in = linear.c[c].row(y);
                float* out = shown.c[c].row(y);
                for (int x = 0; x < linear.width(); x++) {
                    // 1e9 is shown as white and its square is finite; NaN becomes 0.
                    const float v = std::min(std::max(0.0f, in[x]) * scale, 1e9f);
                    const float mapped =
                        (v * v * float(kA) + v * float(kB)) / (v * v * float(kC) + v * float(kD) + float(kE));
                    out[x] = std::min(mapped, 1.0f);
                }
            }
    });
}
}  // namespace

ExposureRange exposureRange(const Rgb& reference) {
    std::vector<double> luminance;
    luminance.reserve(size_t(reference.width()) * size_t(reference.height()));
    for (int y = 0; y < reference.height(); y++)
        for (int x = 0; x < reference.width(); x++) {
            const auto at = [&](size_t c) { return double(reference.c[c].at(x, y)); };
            const double l = 0.2126 * at(0) + 0.7152 * at(1) + 0.0722 * at(2);
            if (std::isfinite(l)) luminance.push_back(l);
        }
    if (luminance.empty()) return {};
    const double most = *std::max_element(luminance.begin(), luminance.end());
    if (most <= 0) return {};
    const auto middle = luminance.begin() + ptrdiff_t(luminance.size() / 2);
    std::nth_element(luminance.begin(), middle, luminance.end());
    double median = *middle;
    if (median <= 0) {
        median = most;
        for (const double l : luminance)
            if (l > 0) median = std::min(median, l);
    }
    ExposureRange range{std::log2(brightest() / most), std::log2(brightest() / median), 0};
    range.stop = std::min(range.stop, range.start + kMostStops);
    range.count = std::max(2, int(std::ceil(range.stop - range.start)));
    return range;
}

double hdrFlip(const Rgb& test, const Rgb& reference, const Exec& exec, PlaneF* map, double pixelsPerDegree) {
    assert(test.width() == reference.width() && test.height() == reference.height());
    const int w = test.width(), h = test.height();
    const ExposureRange range = exposureRange(reference);
    Rgb shownTest(w, h), shownReference(w, h);
    PlaneF most(w, h), own(w, h);
    for (int i = 0; i < range.count; i++) {
        toneMapped(test, range.at(i), exec, shownTest);
        toneMapped(reference, range.at(i), exec, shownReference);
        flipOfLight(shownTest, shownReference, exec, &own, pixelsPerDegree);
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) most.at(x, y) = std::max(most.at(x, y), own.at(x, y));
    }
    double sum = 0;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) sum += double(most.at(x, y));
    most.fillBorder();
    if (map) *map = std::move(most);
    return sum / (double(w) * h);
}

Metric hdrFlipMetric() {
    return {.figures = {{"hdrFlip", "HDR-FLIP", "FLIP of linear light, the largest over exposures, mean"}},
            .space = ColourSpace::linear,
            .nsPerPixel = 200,
            .source = "[Andersson 2021]",
            .measure = [](const ImagePair& i, const Exec& exec) {
                return std::vector{hdrFlip(*i.testLinear, *i.referenceLinear, exec, nullptr, i.flipPixelsPerDegree)};
            }};
}

}  // namespace aa
