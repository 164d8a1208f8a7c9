#include "metrics/flip.h"

#include <algorithm>
#include <cassert>
#include <numeric>
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
    return {.figures = {{"flip", "FLIP", "LDR-FLIP, mean"}},
            .nsPerPixel = 93,
            .source = "[Andersson 2020]",
            .measure = [](const ImagePair& i, const Exec& exec) {
                return std::vector{flip(i.testEncoded, i.referenceEncoded, exec)};
            }};
}

FlipStatistics flipStatistics(const PlaneF& map) {
    std::vector<float> values;
    values.reserve(size_t(map.width()) * size_t(map.height()));
    for (int y = 0; y < map.height(); y++) values.insert(values.end(), map.row(y), map.row(y) + map.width());
    std::sort(values.begin(), values.end());
    const double total = std::accumulate(values.begin(), values.end(), 0.0);
    FlipStatistics s;
    s.mean = total / double(values.size());
    s.max = double(values.back());
    double sum = 0;
    for (const float v : values) {
        sum += double(v);
        if (sum < 0.25 * total) s.firstQuartile = double(v);
        if (sum < 0.5 * total) s.median = double(v);
        if (sum < 0.75 * total) s.thirdQuartile = double(v);
    }
    return s;
}

}  // namespace aa
