#include "metrics/metrics.h"

#include <cassert>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>

#include "image/colour.h"
#include "metrics/metric.h"
#include "metrics/metrics_kernels.h"

namespace aa {
namespace {
double inOrder(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }

// Rows per block of the windowed kernels: each block repeats 10 rows of the along-x pass.
constexpr int kWindowRows = 128;

double ssim(const RgbIn& test, const RgbIn& reference, const PlaneF& like, const Exec& exec, SsimSignal signal,
            PlaneF* map) {
    const int w = like.width(), h = like.height();
    if (map && (map->width() != w || map->height() != h)) *map = PlaneF::unset(w, h);
    std::vector<double> rows(static_cast<size_t>(h));
    const SsimArgs args{
        test,       reference, like.stride(), w, h, signal, map ? map->row(0) : nullptr, map ? map->stride() : 0,
        rows.data()};
    runKernel(metricsKernelsFor(exec).ssim, exec, args, h, kWindowRows);
    if (map) map->fillBorder();
    return inOrder(rows) / (double(w) * h);
}
double ssim(const Rgb& test, const Rgb& reference, const Exec& exec, SsimSignal signal, PlaneF* map) {
    assert(test.width() == reference.width() && test.height() == reference.height());
    return ssim(view(test), view(reference), test.c[0], exec, signal, map);
}
double ssim(const PlaneF& test, const PlaneF& reference, const Exec& exec, PlaneF* map) {
    assert(test.width() == reference.width() && test.height() == reference.height());
    return ssim({{test.row(0)}}, {{reference.row(0)}}, test, exec, SsimSignal::red, map);
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

TileErrorRows::TileErrorRows(const Rgb& test, const Rgb& reference, const Exec& exec)
    : test_(test),
      reference_(reference),
      exec_(exec),
      tilesX_(size_t(test.width() + kErrorTilePx - 1) / kErrorTilePx),
      rows_(size_t(test.height()) * tilesX_) {
    assert(test.width() == reference.width() && test.height() == reference.height());
    static_assert(TileErrors::kTilePx == kErrorTilePx);
}
void TileErrorRows::add(int y0, int y1) {
    const SquaredErrorArgs args{view(test_),   view(reference_), test_.stride(),
                                test_.width(), int(tilesX_),     rows_.data()};
    rowsOf(metricsKernelsFor(exec_).squaredError, exec_.precision)(args, y0, y1);
}
TileErrors TileErrorRows::total(std::optional<double> squares) const {
    const int w = test_.width(), h = test_.height();
    TileErrors errors;
    errors.columns = tilesX_;
    errors.sum.resize(tilesX_ * (size_t(h + kErrorTilePx - 1) / kErrorTilePx));
    errors.values.resize(errors.sum.size());
    for (int y = 0; y < h; y++)
        for (size_t tile = 0; tile < tilesX_; tile++) {
            const size_t i = size_t(y / kErrorTilePx) * tilesX_ + tile;
            const int begin = int(tile) * kErrorTilePx;
            errors.sum[i] += rows_[size_t(y) * tilesX_ + tile];
            errors.values[i] += 3.0 * (std::min(w, begin + kErrorTilePx) - begin);
        }
    errors.referenceSum = squares ? *squares : sumOfSquares(reference_, exec_);
    return errors;
}
TileErrors tileErrors(const Rgb& test, const Rgb& reference, const Exec& exec, std::optional<double> squares) {
    TileErrorRows rows(test, reference, exec);
    forRows(exec, test.height(), [&](int y0, int y1) { rows.add(y0, y1); });
    return rows.total(squares);
}

double sumOfSquares(const Rgb& image, const Exec& exec) {
    std::vector<double> rows(static_cast<size_t>(image.height()));
    const SquaresArgs args{view(image), image.stride(), image.width(), rows.data()};
    runKernel(metricsKernelsFor(exec).squares, exec, args, image.height());
    return inOrder(rows);
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

void pictureLumaRows(const Rgb& encoded, const Exec& exec, int y0, int y1, PlaneF& luma) {
    const LumaArgs args{view(encoded), luma.stride(), encoded.width(), luma.row(0)};
    rowsOf(metricsKernelsFor(exec).luma, exec.precision)(args, y0, y1);
}
PlaneF pictureLuma(const Rgb& encoded, const Exec& exec) {
    PlaneF luma = PlaneF::unset(encoded.width(), encoded.height());
    forRows(exec, encoded.height(), [&](int y0, int y1) { pictureLumaRows(encoded, exec, y0, y1, luma); });
    luma.fillBorder();
    return luma;
}

double ssimLuma(const Rgb& test, const Rgb& reference, const Exec& exec, PlaneF* map, KnownLuma known) {
    // The luma of doubles is no plane's.
    if (exec.precision == Precision::oracle) return ssim(test, reference, exec, SsimSignal::luma, map);
    const PlaneF ofTest = known.test ? PlaneF() : pictureLuma(test, exec),
                 ofReference = known.reference ? PlaneF() : pictureLuma(reference, exec);
    return ssim(known.test ? *known.test : ofTest, known.reference ? *known.reference : ofReference, exec, map);
}
double ssimValid(const Rgb& test, const Rgb& reference, const Exec& exec, PlaneF* map, KnownLuma known) {
    constexpr int kReach = 5;
    PlaneF own;
    PlaneF& all = map ? *map : own;
    const double everywhere = ssimLuma(test, reference, exec, &all, known);
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
Metric ssimMetric(Figure figure, int nsPerPixel) {
    figure.form = FigureForm::similarity;
    figure.higherIsBetter = true;
    return {.figures = {figure}, .nsPerPixel = nsPerPixel, .source = "conventions 13.2"};
}
Measure ofColours(double (*measure)(const Rgb&, const Rgb&, const Exec&, PlaneF*)) {
    return [measure](const ImagePair& i, const Exec& exec) {
        return std::vector{measure(i.testEncoded, i.referenceEncoded, exec, nullptr)};
    };
}
// Nothing more of a reference serves all pictures: the kernel filters the sum and the difference of a pair.
std::function<Measure(const ReferencePicture&, const Exec&)> withLuma(double (*measure)(const Rgb&, const Rgb&,
                                                                                        const Exec&, PlaneF*,
                                                                                        KnownLuma)) {
    return [measure](const ReferencePicture& r, const Exec& e) -> Measure {
        const auto luma = std::make_shared<const PlaneF>(pictureLuma(r.encoded, e));
        return [measure, luma](const ImagePair& i, const Exec& exec) {
            return std::vector{measure(i.testEncoded, i.referenceEncoded, exec, nullptr, {i.testLuma, luma.get()})};
        };
    };
}
}  // namespace
Metric ssimLumaMetric() {
    Metric m = ssimMetric({"ssimLuma", "SSIM", "structural similarity of luma 601"}, 5);
    m.always = true;
    m.prepare = withLuma(ssimLuma);
    return m;
}
Metric ssimValidMetric() {
    Metric m = ssimMetric({"ssimValid", "SSIM valid", "SSIM of luma 601, windows within the picture alone"}, 7);
    m.prepare = withLuma(ssimValid);
    return m;
}
Metric ssimRgbMetric() {
    Metric m = ssimMetric({"ssimRgb", "SSIM RGB", "SSIM, mean over channels"}, 12);
    m.byDefault = true;
    m.measure = ofColours(ssimRgb);
    return m;
}
Metric ssimMatlab3DMetric() {
    Metric m = ssimMetric({"ssimMatlab3D", "SSIM 3D", "SSIM as MATLAB filters an RGB array"}, 20);
    m.measure = ofColours(ssimMatlab3D);
    return m;
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
                for (int x = 0; x < encoded.width(); x++) row[x] = float(code8(row[x])) / 255.0f;
            }
    });
    encoded.fillBorder();
}

}  // namespace aa
