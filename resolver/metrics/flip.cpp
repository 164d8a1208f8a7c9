#include "metrics/flip.h"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <span>
#include <utility>

#include "image/colour.h"
#include "metrics/flip_kernels.h"
#include "metrics/metric.h"
#include "metrics/metrics_kernels.h"

namespace aa {

double flip(const Rgb& test, const Rgb& reference, const Exec& exec, PlaneF* map) {
    assert(test.width() == reference.width() && test.height() == reference.height());
    constexpr int kRowsPerBlock = 128;  // each block repeats 20 rows of the pass along x
    const int w = test.width(), h = test.height();
    Rgb linearTest, linearReference;
    decode(test, {}, exec, linearTest);
    decode(reference, {}, exec, linearReference);
    if (map && (map->width() != w || map->height() != h)) *map = PlaneF(w, h);
    std::vector<double> rows(size_t(h) * kSumStrands);
    const FlipArgs args{view(std::as_const(linearTest)),
                        view(std::as_const(linearReference)),
                        linearTest.stride(),
                        w,
                        h,
                        map ? map->row(0) : nullptr,
                        map ? map->stride() : 0,
                        rows.data()};
    runKernel(flipKernelsFor(exec).flip, exec, args, h, kRowsPerBlock);
    if (map) map->fillBorder();
    return std::accumulate(rows.begin(), rows.end(), 0.0) / (double(w) * h);
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
            .nsPerPixel = 100,
            .source = "[Andersson 2020]",
            .measure = [](const ImagePair& i, const Exec& exec) {
                PlaneF map;
                const double mean = flip(i.testEncoded, i.referenceEncoded, exec, &map);
                const FlipStatistics s = flipStatistics(map);
                return std::vector{mean, s.firstQuartile, s.median, s.thirdQuartile};
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
