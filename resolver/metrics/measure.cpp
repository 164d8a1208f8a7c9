#include "metrics/measure.h"

#include <algorithm>

#include "metrics/error_bar.h"

namespace aa {

Reference makeReference(const Rgb& halfA, const Rgb& halfB, const DisplayChain& display, const Exec& exec,
                        bool eightBit) {
    const int w = halfA.width(), h = halfA.height();
    Reference r{Rgb(w, h), {}};
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < h; y++) {
            const float *a = halfA.c[c].row(y), *b = halfB.c[c].row(y);
            float* mean = r.linear.c[c].row(y);
            for (int x = 0; x < w; x++) mean[x] = 0.5f * a[x] + 0.5f * b[x];
        }
    r.linear.fillBorder();
    encode(r.linear, display, exec, r.encoded);
    if (display.transfer == Transfer::identity) {
        r.clippedPixels = clippedPixels(r.linear, display);
        r.linear = r.encoded;
    }
    if (eightBit) quantise8(r.encoded, exec);
    Rgb encodedA, encodedB;
    encode(halfA, display, exec, encodedA);
    encode(halfB, display, exec, encodedB);
    r.noise = truthNoise(squaredError(encodedA, encodedB, exec).mse);
    return r;
}

FrameMetrics frameMetrics(const SquaredError& e) {
    return {.mse = e.mse, .reference = e.reference, .psnr = psnr(e.mse), .snr = snr(e), .others = {}};
}

std::optional<double> FrameMetrics::figure(std::string_view name) const {
    if (const auto other = others.find(name); other != others.end()) return other->second;
    const Figure* f = figureByName(name);
    if (!f || !f->ofSquares) return {};
    return f->ofSquares(squares());
}

void addFigures(FrameMetrics& to, const Metric& metric, const ImagePair& images, const Exec& exec) {
    if (!metric.measure) return;
    const std::vector<double> values = metric.measure(images, exec);
    for (size_t i = 0; i < values.size(); i++) to.others.emplace(metric.figures[i].name, values[i]);
}

MeasureOptions measureOptions(const std::vector<std::string>& names) {
    MeasureOptions options;
    for (const auto& name : names)
        if (const Metric* m = findFigure(name).metric;
            !m->always && std::find(options.metrics.begin(), options.metrics.end(), m) == options.metrics.end())
            options.metrics.push_back(m);
    return options;
}

FrameMetrics measure(const Rgb& encoded, const Rgb* linear, const Reference& reference, const MeasureOptions& options,
                     const Exec& exec, TileErrors& pool) {
    const TileErrors errors = tileErrors(encoded, reference.encoded, exec);
    pool += errors;
    FrameMetrics m = frameMetrics(errors.squaredError());
    const ImagePair images{encoded, reference.encoded, linear, linear ? &reference.linear : nullptr};
    const auto add = [&](const Metric& metric) {
        if (metric.isPossible(images)) addFigures(m, metric, images, exec);
    };
    for (const Metric& metric : metrics())
        if (metric.always) add(metric);
    for (const Metric* metric : options.metrics) add(*metric);
    return m;
}

}  // namespace aa
