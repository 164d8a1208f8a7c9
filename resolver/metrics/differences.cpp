#include "metrics/differences.h"

#include <cassert>
#include <cmath>
#include <numeric>

#include "metrics/measure.h"

namespace aa {
namespace {
// Sum over the pixels of a channel, row by row.
template <class Value>
double sumOf(int height, const Exec& exec, const Value& ofRow) {
    std::vector<double> rows(static_cast<size_t>(height));
    forRows(exec, height, [&](int y0, int y1) {
        for (int y = y0; y < y1; y++) rows[size_t(y)] = ofRow(y);
    });
    return std::accumulate(rows.begin(), rows.end(), 0.0);
}
}  // namespace

double meanAbsoluteError(const Rgb& test, const Rgb& reference, const Exec& exec) {
    assert(test.width() == reference.width() && test.height() == reference.height());
    const int w = test.width(), h = test.height();
    return sumOf(h, exec,
                 [&](int y) {
                     double sum = 0;
                     for (size_t c = 0; c < 3; c++) {
                         const float *t = test.c[c].row(y), *r = reference.c[c].row(y);
                         for (int x = 0; x < w; x++) sum += std::abs(double(t[x]) - double(r[x]));
                     }
                     return sum;
                 }) /
           (3.0 * w * h);
}
double contrastPower(const Rgb& reference, const Exec& exec) {
    const int w = reference.width(), h = reference.height();
    double power = 0;
    for (const PlaneF& channel : reference.c) {
        const auto mean = [&](auto value) {
            return sumOf(h, exec,
                         [&](int y) {
                             double sum = 0;
                             const float* r = channel.row(y);
                             for (int x = 0; x < w; x++) sum += value(double(r[x]));
                             return sum;
                         }) /
                   (double(w) * h);
        };
        const double level = mean([](double v) { return v; });
        power += mean([&](double v) { return (v - level) * (v - level); }) / 3;
    }
    return power;
}

Metric absoluteMetric() {
    return {.figures = {{"mae", "MAE", "mean absolute error"}},
            .nsPerPixel = 4,
            .source = "conventions 13.1",
            .measure = [](const ImagePair& i, const Exec& exec) {
                return std::vector{meanAbsoluteError(i.testEncoded, i.referenceEncoded, exec)};
            }};
}
Metric linearMseMetric() {
    return {.figures = {{"mseLinear", "linear MSE", "mean squared error of linear light"}},
            .space = ColourSpace::linear,
            .nsPerPixel = 3,
            .source = "conventions 13.8",
            .measure = [](const ImagePair& i, const Exec& exec) {
                return std::vector{squaredError(*i.testLinear, *i.referenceLinear, exec).mse};
            }};
}
Metric contrastSnrMetric() {
    return {.figures = {{"snrAc", "AC SNR", "the reference's contrast over the error, dB", FigureForm::decibels, true,
                         nullptr,
                         [](const FrameMetrics& m) {
                             return snr({m.mse, m.others.at("acPower")});
                         }},
                        {"acPower", "AC power", "the reference's contrast: variance about each channel's mean",
                         FigureForm::significant, true}},
            .nsPerPixel = 8,
            .source = "conventions 13.1",
            .measure = [](const ImagePair& i, const Exec& exec) {
                const double power = contrastPower(i.referenceEncoded, exec);
                return std::vector{snr({squaredError(i.testEncoded, i.referenceEncoded, exec).mse, power}), power};
            }};
}

}  // namespace aa
