#include "metrics/metrics.h"

#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "metrics/metric.h"
#include "metrics/metrics_kernels.h"

namespace aa {
namespace {
double inOrder(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }

// Rows per block of the windowed kernels: each block repeats 10 rows of the along-x pass.
constexpr int kWindowRows = 128;

double ssim(const Rgb& test, const Rgb& reference, const Exec& exec, SsimSignal signal, PlaneF* map) {
    assert(test.width() == reference.width() && test.height() == reference.height());
    const int w = test.width(), h = test.height();
    if (map && (map->width() != w || map->height() != h)) *map = PlaneF(w, h);
    std::vector<double> rows(static_cast<size_t>(h));
    const SsimArgs args{
        view(test), view(reference), test.stride(), w, h, signal, map ? map->row(0) : nullptr, map ? map->stride() : 0,
        rows.data()};
    runKernel(metricsKernelsFor(exec).ssim, exec, args, h, kWindowRows);
    if (map) map->fillBorder();
    return inOrder(rows) / (double(w) * h);
}
}  // namespace

double TileErrors::totalSum() const { return inOrder(sum); }
double TileErrors::totalValues() const { return inOrder(values); }
TileErrors& TileErrors::operator+=(const TileErrors& frame) {
    if (sum.empty()) return *this = frame;
    assert(frame.sum.size() == sum.size() && frame.columns == columns);
    // A frame whose truth is exact among others that are noisy counts with its error against the whole truth.
    const auto addHalf = [&](std::vector<double>& half, const std::vector<double>& other) {
        if (half.empty() && other.empty()) return;
        if (half.empty()) half = sum;
        const std::vector<double>& more = other.empty() ? frame.sum : other;
        for (size_t i = 0; i < half.size(); i++) half[i] += more[i];
    };
    addHalf(againstA, frame.againstA);
    addHalf(againstB, frame.againstB);
    for (size_t i = 0; i < sum.size(); i++) sum[i] += frame.sum[i], values[i] += frame.values[i];
    referenceSum += frame.referenceSum;
    return *this;
}
std::vector<double> TileErrors::coarse(size_t tiles) const {
    const size_t across = columns ? columns : sum.size(), wide = (across + tiles - 1) / tiles,
                 high = (sum.size() / across + tiles - 1) / tiles;
    std::vector<double> sums(wide * high);
    for (size_t i = 0; i < sum.size(); i++) sums[i / across / tiles * wide + i % across / tiles] += sum[i];
    return sums;
}

TileErrors tileErrors(const Rgb& test, const Rgb& reference, const Exec& exec) {
    assert(test.width() == reference.width() && test.height() == reference.height());
    static_assert(TileErrors::kTilePx == kErrorTilePx);
    const int w = test.width(), h = test.height();
    const int tilesX = (w + kErrorTilePx - 1) / kErrorTilePx, tilesY = (h + kErrorTilePx - 1) / kErrorTilePx;
    std::vector<double> tileRows(size_t(h) * size_t(tilesX)), referenceRows(static_cast<size_t>(h));
    const SquaredErrorArgs args{view(test), view(reference), test.stride(),       w,
                                tilesX,     tileRows.data(), referenceRows.data()};
    runKernel(metricsKernelsFor(exec).squaredError, exec, args, h);

    TileErrors errors;
    errors.columns = size_t(tilesX);
    errors.sum.resize(size_t(tilesX) * size_t(tilesY));
    errors.values.resize(errors.sum.size());
    for (int y = 0; y < h; y++)
        for (int tile = 0; tile < tilesX; tile++) {
            const size_t i = size_t(y / kErrorTilePx) * size_t(tilesX) + size_t(tile);
            errors.sum[i] += tileRows[size_t(y) * size_t(tilesX) + size_t(tile)];
            errors.values[i] += 3.0 * (std::min(w, (tile + 1) * kErrorTilePx) - tile * kErrorTilePx);
        }
    errors.referenceSum = inOrder(referenceRows);
    return errors;
}

SquaredError squaredError(const Rgb& test, const Rgb& reference, const Exec& exec) {
    return tileErrors(test, reference, exec).squaredError();
}
double rmse(double mse) { return std::sqrt(mse); }
double psnr(double mse, double peak) {
    return mse == 0 ? std::numeric_limits<double>::infinity() : 10 * std::log10(peak * peak / mse);
}
double snr(const SquaredError& error) {
    return error.mse == 0 ? std::numeric_limits<double>::infinity() : 10 * std::log10(error.reference / error.mse);
}
double relMse(const Rgb& test, const Rgb& reference, const Exec& exec) {
    assert(test.width() == reference.width() && test.height() == reference.height());
    std::vector<double> rows(static_cast<size_t>(test.height()));
    const RelativeErrorArgs args{view(test), view(reference), test.stride(), test.width(), rows.data()};
    runKernel(metricsKernelsFor(exec).relativeError, exec, args, test.height());
    return inOrder(rows) / (3.0 * test.width() * test.height());
}

double ssimLuma(const Rgb& test, const Rgb& reference, const Exec& exec, PlaneF* map) {
    return ssim(test, reference, exec, SsimSignal::luma, map);
}
double ssimValid(const Rgb& test, const Rgb& reference, const Exec& exec, PlaneF* map) {
    constexpr int kReach = 5;
    PlaneF own;
    PlaneF& all = map ? *map : own;
    const double everywhere = ssimLuma(test, reference, exec, &all);
    if (std::min(all.width(), all.height()) <= 2 * kReach) return everywhere;
    double sum = 0;
    for (int y = kReach; y < all.height() - kReach; y++)
        for (int x = kReach; x < all.width() - kReach; x++) sum += double(all.at(x, y));
    return sum / (double(all.width() - 2 * kReach) * (all.height() - 2 * kReach));
}
double ssimRgb(const Rgb& test, const Rgb& reference, const Exec& exec, PlaneF* map) {
    constexpr SsimSignal kChannels[] = {SsimSignal::red, SsimSignal::green, SsimSignal::blue};
    double sum = 0;
    PlaneF maps[3];
    for (size_t c = 0; c < 3; c++) sum += ssim(test, reference, exec, kChannels[c], map ? &maps[c] : nullptr);
    if (map) {
        *map = PlaneF(test.width(), test.height());
        for (int y = 0; y < map->height(); y++)
            for (int x = 0; x < map->width(); x++)
                map->at(x, y) = (maps[0].at(x, y) + maps[1].at(x, y) + maps[2].at(x, y)) / 3;
        map->fillBorder();
    }
    return sum / 3;
}
double ssimMatlab3D(const Rgb& test, const Rgb& reference, const Exec& exec, PlaneF* map) {
    return ssim(test, reference, exec, SsimSignal::volume, map);
}

Metric squaredErrorMetric() {
    const auto decibels = FigureForm::decibels;
    return {.figures = {{"mse", "MSE", "mean squared error", {}, false, [](const SquaredError& e) { return e.mse; }},
                        {"rmse", "RMSE", "its root", {}, false, [](const SquaredError& e) { return rmse(e.mse); }},
                        {"psnr", "PSNR", "peak signal to noise, dB", decibels, true,
                         [](const SquaredError& e) { return psnr(e.mse); }},
                        {"snr", "SNR", "signal to noise, dB", decibels, true,
                         [](const SquaredError& e) { return snr(e); }}},
            .always = true,
            .nsPerPixel = 4,
            .source = "conventions 13.1"};
}
Metric relMseMetric() {
    return {
        .figures = {{"relMse", "relMSE", "relative MSE of linear light (of EXR files, of methods with linear output)"}},
        .space = ColourSpace::linear,
        .always = true,
        .nsPerPixel = 3,
        .source = "conventions 13.8",
        .measure = [](const ImagePair& i, const Exec& exec) {
            return std::vector{relMse(*i.testLinear, *i.referenceLinear, exec)};
        }};
}
namespace {
Metric ssimMetric(Figure figure, bool always, int nsPerPixel,
                  double (*measure)(const Rgb&, const Rgb&, const Exec&, PlaneF*)) {
    figure.form = FigureForm::similarity;
    figure.higherIsBetter = true;
    return {.figures = {figure},
            .always = always,
            .nsPerPixel = nsPerPixel,
            .source = "conventions 13.2",
            .measure = [measure](const ImagePair& i, const Exec& exec) {
                return std::vector{measure(i.testEncoded, i.referenceEncoded, exec, nullptr)};
            }};
}
}  // namespace
Metric ssimLumaMetric() {
    return ssimMetric({"ssimLuma", "SSIM", "structural similarity of luma 601"}, true, 5, ssimLuma);
}
Metric ssimValidMetric() {
    return ssimMetric({"ssimValid", "SSIM valid", "SSIM of luma 601, windows within the picture alone"}, false, 7,
                      ssimValid);
}
Metric ssimRgbMetric() {
    Metric m = ssimMetric({"ssimRgb", "SSIM RGB", "SSIM, mean over channels"}, false, 12, ssimRgb);
    m.byDefault = true;
    return m;
}
Metric ssimMatlab3DMetric() {
    return ssimMetric({"ssimMatlab3D", "SSIM 3D", "SSIM as MATLAB filters an RGB array"}, false, 20, ssimMatlab3D);
}

void dither8(Rgb& encoded, int frame, const Exec& exec) {
    auto& c = encoded.c;
    const DitherArgs args{.image = {{c[0].row(0), c[1].row(0), c[2].row(0)}},
                          .stride = c[0].stride(),
                          .width = encoded.width(),
                          .frame = uint32_t(frame)};
    runKernel(metricsKernelsFor(exec).dither, exec, args, encoded.height());
    encoded.fillBorder();
}
void quantise8(Rgb& encoded, const Exec& exec) {
    forRows(exec, encoded.height(), [&](int y0, int y1) {
        for (auto& channel : encoded.c)
            for (int y = y0; y < y1; y++) {
                float* row = channel.row(y);
                for (int x = 0; x < encoded.width(); x++) {
                    const float v = row[x];
                    row[x] = std::floor(255.0f * (v > 0 ? (v < 1 ? v : 1.0f) : 0.0f) + 0.5f) / 255.0f;
                }
            }
    });
    encoded.fillBorder();
}

}  // namespace aa
