#include "metrics/flip.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
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
    for (int i = 0; i <= f.csfReach; i++) {
        f.czWideAlongX[i] = f.csfCzWide[i] * a / (a + b);
        f.czNarrowAlongX[i] = f.csfCzNarrow[i] * b / (a + b);
    }

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
            .nsPerPixel = 24,
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

namespace {
constexpr size_t kBins = 1024;
using BinSums = std::array<double, kBins>;
// In the order of the values, and exact; of values from 0 to 1, whatever else lies at an end.
size_t keyOf(float v, size_t keys) {
    return std::min(size_t(int(std::min(std::max(0.0f, v), 1.0f) * float(keys))), keys - 1);
}
size_t binOf(float v) { return keyOf(v, kBins); }
size_t fineBinOf(float v) { return keyOf(v, kBins * kBins) % kBins; }
// The bin up to which the sums reach a goal; `below` becomes the sum before it.
size_t reached(const BinSums& sums, double goal, double& below) {
    size_t bin = 0;
    for (; bin + 1 < kBins && below + sums[bin] < goal; bin++) below += sums[bin];
    return bin;
}
}  // namespace

// Values fall into bins first, those of a quartile's bin into finer ones, and only those of one of these are sorted.
FlipStatistics flipStatistics(const PlaneF& map) {
    const auto eachRow = [&](const auto& fn) {
        for (int y = 0; y < map.height(); y++) fn(std::span(map.row(y), size_t(map.width())));
    };
    constexpr size_t kStrands = 4;  // of neighbours apart: a sum waits for the one before
    std::vector<BinSums> strands(kStrands);
    float most = 0;
    eachRow([&](std::span<const float> row) {
        float largest = 0;  // a variable of its own, which stays in a register
        for (size_t x = 0; x < row.size(); x++) {
            strands[x % kStrands][binOf(row[x])] += double(row[x]);
            largest = std::max(largest, row[x]);
        }
        most = std::max(most, largest);
    });
    BinSums& sums = strands[0];
    for (size_t bin = 0; bin < kBins; bin++)
        for (size_t i = 1; i < kStrands; i++) sums[bin] += strands[i][bin];
    const double total = std::accumulate(sums.begin(), sums.end(), 0.0);
    if (!(total > 0)) return {};

    struct Quartile {
        double goal, below = 0;  // the sum of what is in smaller bins
        size_t bin;
    };
    std::array<Quartile, 3> quartiles;
    std::array<uint8_t, kBins> isNear{};  // some quartile
    for (size_t i = 0; i < 3; i++) {
        Quartile& q = quartiles[i];
        q.goal = 0.25 * double(i + 1) * total;
        q.bin = reached(sums, q.goal, q.below);
        isNear[q.bin] = 1;
    }
    std::vector<float> near;
    eachRow([&](std::span<const float> row) {
        for (const float v : row)
            if (isNear[binOf(v)]) near.push_back(v);
    });
    // The largest value up to which less than the goal lies.
    const auto valueOf = [&](Quartile& q) {
        BinSums fine{};
        for (const float v : near)
            if (binOf(v) == q.bin) fine[fineBinOf(v)] += double(v);
        const size_t fineBin = reached(fine, q.goal, q.below);
        float value = -1;
        std::vector<float> last;
        for (const float v : near)
            if (binOf(v) == q.bin && fineBinOf(v) <= fineBin) {
                if (fineBinOf(v) == fineBin)
                    last.push_back(v);
                else
                    value = std::max(value, v);
            }
        std::sort(last.begin(), last.end());
        for (const float v : last) {
            q.below += double(v);
            if (q.below >= q.goal) break;
            value = v;
        }
        if (value < 0) {  // a smaller bin's
            value = 0;
            eachRow([&](std::span<const float> row) {
                for (const float v : row)
                    if (v > value && binOf(v) < q.bin) value = v;
            });
        }
        return double(value);
    };
    return {total / (double(map.width()) * map.height()), valueOf(quartiles[0]), valueOf(quartiles[1]),
            valueOf(quartiles[2]), double(most)};
}

}  // namespace aa
