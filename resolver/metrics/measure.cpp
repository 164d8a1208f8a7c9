#include "metrics/measure.h"

#include <algorithm>

#include "image/input_policy.h"
#include "metrics/error_bar.h"

namespace aa {

Reference makeReference(const Rgb& halfA, const Rgb& halfB, const DisplayChain& display, const Exec& exec,
                        bool eightBit) {
    const int w = halfA.width(), h = halfA.height();
    Reference r;
    r.linear = Rgb(w, h);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < h; y++) {
            const float *a = halfA.c[c].row(y), *b = halfB.c[c].row(y);
            float* mean = r.linear.c[c].row(y);
            for (int x = 0; x < w; x++) mean[x] = 0.5f * a[x] + 0.5f * b[x];
        }
    r.linear.fillBorder();
    encode(r.linear, display, exec, r.encoded);
    if (nonFiniteValues(r.linear) > 0) r.broken = r.linear;
    if (display.transfer == Transfer::identity) {
        r.clippedPixels = clippedPixels(r.linear, display);
        r.linear = r.encoded;
    }
    if (eightBit) quantise8(r.encoded, exec);
    encode(halfA, display, exec, r.encodedA);
    encode(halfB, display, exec, r.encodedB);
    r.noise = truthNoise(squaredError(r.encodedA, r.encodedB, exec).mse);
    if (r.noise == 0) {
        r.encodedA = r.encodedB = {};
    } else if (eightBit) {
        quantise8(r.encodedA, exec);
        quantise8(r.encodedB, exec);
    }
    return r;
}

TileErrors tileErrors(const Rgb& encoded, const Reference& reference, const Exec& exec) {
    TileErrors errors = tileErrors(encoded, reference.encoded, exec);
    if (reference.encodedA.empty()) return errors;
    errors.againstA = tileErrors(encoded, reference.encodedA, exec).sum;
    errors.againstB = tileErrors(encoded, reference.encodedB, exec).sum;
    return errors;
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

void deriveFromMeans(FrameMetrics& means) {
    for (auto& [name, value] : means.others)
        if (const Figure* f = figureByName(name); f && f->ofMeans) value = f->ofMeans(means);
}

MeasureOptions measureOptions(const std::vector<std::string>& names) {
    MeasureOptions options;
    for (const auto& name : names)
        if (const Metric* m = findFigure(name).metric;
            !m->always && std::find(options.metrics.begin(), options.metrics.end(), m) == options.metrics.end())
            options.metrics.push_back(m);
    return options;
}

DefaultMetrics defaultMetrics(const MeasureOptions& asked, double pixels) {
    DefaultMetrics d;
    for (const Metric& m : metrics()) {
        if (!m.byDefault || std::find(asked.metrics.begin(), asked.metrics.end(), &m) != asked.metrics.end()) continue;
        d.metrics.push_back(&m);
        d.seconds += 1e-9 * m.nsPerPixel * pixels;
    }
    return d;
}

FrameMetrics measure(const Rgb& encoded, const Rgb* linear, const Reference& reference, const MeasureOptions& options,
                     const Exec& exec, TileErrors& pool, bool judged) {
    const TileErrors errors = tileErrors(encoded, reference, exec);
    pool += errors;
    FrameMetrics m = frameMetrics(errors.squaredError());
    const ImagePair images{encoded, reference.encoded, linear, linear ? &reference.linear : nullptr,
                           options.flipPixelsPerDegree};
    const auto add = [&](const Metric& metric) {
        if (metric.isPossible(images)) addFigures(m, metric, images, exec);
    };
    for (const Metric& metric : metrics())
        if (metric.always) add(metric);
    for (const Metric* metric : options.metrics) add(*metric);
    if (judged)
        for (const Metric* metric : options.ofJudged) add(*metric);
    return m;
}

}  // namespace aa
