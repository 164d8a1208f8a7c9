#include "metrics/flip.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <stdexcept>

#include "image/colour.h"
#include "metrics/flip_kernels.h"
#include "metrics/metrics_kernels.h"

namespace aa {

namespace {
// [Andersson 2020] at another distance; flip_constants.h says what each filter is.
FlipFilters filtersAt(double pixelsPerDegree) {
    constexpr double kPi = std::numbers::pi;
    FlipFilters f{};
    f.csfReach = f.narrowReach = int(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * pixelsPerDegree));
    const auto gaussian = [&](double* taps, double b) {
        double sum = 0;
        for (int i = 0; i <= f.csfReach; i++) {
            taps[i] = std::exp(-kPi * kPi * i * i / (pixelsPerDegree * pixelsPerDegree * b));
            sum += (i ? 2 : 1) * taps[i];
        }
        for (int i = 0; i <= f.csfReach; i++) taps[i] /= sum;
        return sum;
    };
    gaussian(f.csfY, 0.0047), gaussian(f.csfCx, 0.0053);
    const double wide = gaussian(f.csfCzWide, 0.04), narrow = gaussian(f.csfCzNarrow, 0.025);
    const double a = 34.1 * std::sqrt(kPi / 0.04) * wide * wide, b = 13.5 * std::sqrt(kPi / 0.025) * narrow * narrow;
    f.czWideShare = a / (a + b);

    const double sd = 0.5 * 0.082 * pixelsPerDegree;
    f.featureReach = std::max(1, int(std::ceil(3 * sd)));
    double total = 0, edges = 0, positive = 0, negative = 0;
    for (int i = 0; i <= f.featureReach; i++) {
        const double weight = i ? 2 : 1;
        f.gauss[i] = std::exp(-i * i / (2 * sd * sd));
        f.edge[i] = i * f.gauss[i];
        f.point[i] = (i * i / (sd * sd) - 1) * f.gauss[i];
        total += weight * f.gauss[i], edges += f.edge[i];
        (f.point[i] > 0 ? positive : negative) += weight * std::abs(f.point[i]);
    }
    for (int i = 0; i <= f.featureReach; i++) {
        f.gauss[i] /= total, f.edge[i] /= edges;
        f.point[i] /= f.point[i] > 0 ? positive : negative;
    }
    return f;
}
}  // namespace

FlipReference::FlipReference(const Rgb& reference, Values values, const Exec& exec, double pixelsPerDegree)
    : width_(reference.width()), height_(reference.height()), values_(values), precision_(exec.precision) {
    assert(pixelsPerDegree >= kLeastFlipPixelsPerDegree && pixelsPerDegree <= kMostFlipPixelsPerDegree);
    if (pixelsPerDegree != kFlipPixelsPerDegree) filters_ = std::make_unique<FlipFilters>(filtersAt(pixelsPerDegree));
    const int rows = (height_ + kFlipTileRows - 1) / kFlipTileRows, blocks = (width_ + kFlipColumns - 1) / kFlipColumns;
    const size_t floats = exec.precision == Precision::oracle ? 2 : 1;  // of a value
    seen_.resize(floats * size_t(rows) * size_t(blocks) * (kFlipTileRows * kFlipColumns * kFlipSeen));
    const FlipArgs args{.image = view(reference),
                        .encoded = values == Values::encoded,
                        .stride = reference.stride(),
                        .width = width_,
                        .height = height_,
                        .filters = filters_.get(),
                        .seen = seen_.data()};
    const auto& kernels = flipKernelsFor(exec);
    runKernel(filters_ ? kernels.seeFrom : kernels.see, exec, args, rows, kFlipPiece);
}
FlipReference::~FlipReference() = default;

double FlipReference::flip(const Rgb& test, const Exec& exec, PlaneF* map) const {
    assert(test.width() == width_ && test.height() == height_);
    if ((exec.precision == Precision::oracle) != (precision_ == Precision::oracle))
        throw std::logic_error("FlipReference::flip: the reference was seen in another precision");
    if (map && (map->width() != width_ || map->height() != height_)) *map = PlaneF::unset(width_, height_);
    std::vector<double> rows(static_cast<size_t>(height_));
    const FlipArgs args{.image = view(test),
                        .encoded = values_ == Values::encoded,
                        .stride = test.stride(),
                        .width = width_,
                        .height = height_,
                        .filters = filters_.get(),
                        .reference = seen_.data(),
                        .map = map ? map->row(0) : nullptr,
                        .mapStride = map ? map->stride() : 0,
                        .rows = rows.data()};
    const auto& kernels = flipKernelsFor(exec);
    runKernel(filters_ ? kernels.judgeFrom : kernels.judge, exec, args, (height_ + kFlipTileRows - 1) / kFlipTileRows,
              kFlipPiece);
    if (map) map->fillBorder();
    return std::accumulate(rows.begin(), rows.end(), 0.0) / (double(width_) * height_);
}

double flip(const Rgb& test, const Rgb& reference, const Exec& exec, PlaneF* map, double pixelsPerDegree) {
    return FlipReference(reference, FlipReference::Values::encoded, exec, pixelsPerDegree).flip(test, exec, map);
}
double flipOfLight(const Rgb& test, const Rgb& reference, const Exec& exec, PlaneF* map, double pixelsPerDegree) {
    return FlipReference(reference, FlipReference::Values::light, exec, pixelsPerDegree).flip(test, exec, map);
}

Metric flipMetric() {
    const auto quartile = [](std::string_view name, std::string_view title, std::string_view help) {
        return Figure{.name = name, .title = title, .help = help, .spreadOf = "flip"};
    };
    return {.figures = {{"flip", "FLIP", "LDR-FLIP, mean"},
                        quartile("flipFirstQuartile", "FLIP, 1st quartile", "below which a quarter of all FLIP lies"),
                        quartile("flipMedian", "FLIP, median", "below which half of all FLIP lies"),
                        quartile("flipThirdQuartile", "FLIP, 3rd quartile", "below which three quarters of it lie")},
            .byDefault = true,
            .nsPerPixel = 35,
            .source = "[Andersson 2020]",
            .prepare = [](const ReferencePicture& r, const Exec& e) -> Measure {
                const auto reference = std::make_shared<FlipReference>(r.encoded, FlipReference::Values::encoded, e,
                                                                       r.flipPixelsPerDegree);
                return [reference](const ImagePair& i, const Exec& exec) {
                    PlaneF map;
                    const double mean = reference->flip(i.testEncoded, exec, &map);
                    const FlipStatistics s = flipStatistics(map);
                    return std::vector{mean, s.firstQuartile, s.median, s.thirdQuartile};
                };
            }};
}

// Values fall into bins first, so that only those of three bins are sorted.
FlipStatistics flipStatistics(const PlaneF& map) {
    constexpr size_t kBins = 1024;
    std::vector<double> sums(kBins);
    std::vector<float> largest(kBins);
    const auto binOf = [](float v) { return std::min(kBins - 1, size_t(std::max(v, 0.0f) * float(kBins))); };
    double total = 0;
    float most = 0;
    for (int y = 0; y < map.height(); y++)
        for (const float v : std::span(map.row(y), size_t(map.width()))) {
            sums[binOf(v)] += double(v);
            largest[binOf(v)] = std::max(largest[binOf(v)], v);
            most = std::max(most, v);
        }
    for (const double sum : sums) total += sum;
    // The largest value up to which less than `share` of the total lies.
    const auto quartile = [&](double share) {
        size_t bin = 0;
        double below = 0;
        float last = 0;
        for (; bin + 1 < kBins && below + sums[bin] < share * total; bin++)
            below += sums[bin], last = std::max(last, largest[bin]);
        std::vector<float> values;
        for (int y = 0; y < map.height(); y++)
            for (const float v : std::span(map.row(y), size_t(map.width())))
                if (binOf(v) == bin) values.push_back(v);
        std::sort(values.begin(), values.end());
        for (const float v : values) {
            below += double(v);
            if (below >= share * total) break;
            last = v;
        }
        return double(last);
    };
    if (!(total > 0)) return {};
    return {total / (double(map.width()) * map.height()), quartile(0.25), quartile(0.5), quartile(0.75), double(most)};
}

}  // namespace aa
