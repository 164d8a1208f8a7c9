#include "metrics/measure.h"

#include <algorithm>

#include "image/input_policy.h"
#include "metrics/error_bar.h"

namespace aa {

namespace {
Rgb meanOf(const Rgb& halfA, const Rgb& halfB, const Exec& exec) {
    Rgb all = Rgb::unset(halfA.width(), halfA.height());
    forRows(exec, all.height(), [&](int y0, int y1) {
        for (size_t c = 0; c < 3; c++)
            for (int y = y0; y < y1; y++) {
                const float *a = halfA.c[c].row(y), *b = halfB.c[c].row(y);
                float* mean = all.c[c].row(y);
                for (int x = 0; x < all.width(); x++) mean[x] = 0.5f * a[x] + 0.5f * b[x];
            }
    });
    all.fillBorder();
    return all;
}
// Fills what the halves tell, which differ.
void addHalves(Reference& r, const Rgb& halfA, const Rgb& halfB, const DisplayChain& display, const Exec& exec,
               bool eightBit) {
    encode(halfA, display, exec, r.encodedA);
    encode(halfB, display, exec, r.encodedB);
    r.noise = truthNoise(squaredError(r.encodedA, r.encodedB, exec).mse);
    if (r.noise == 0) {
        r.encodedA = r.encodedB = {};
    } else if (eightBit) {
        quantise8(r.encodedA, exec);
        quantise8(r.encodedB, exec);
    }
}
}  // namespace

Reference makeReference(const Rgb& halfA, const Rgb& halfB, const DisplayChain& display, const Exec& exec,
                        bool eightBit) {
    Reference r;
    r.linear = meanOf(halfA, halfB, exec);
    encode(r.linear, display, exec, r.encoded);
    if (nonFiniteValues(r.linear) > 0) r.broken = r.linear;
    if (display.transfer == Transfer::identity) {
        r.clippedPixels = clippedPixels(r.linear, display);
        r.linear = r.encoded;
    }
    if (eightBit) quantise8(r.encoded, exec);
    if (!halfA.samePixels(halfB)) addHalves(r, halfA, halfB, display, exec, eightBit);
    return r;
}

ReferenceErrors::ReferenceErrors(const Rgb& encoded, const Reference& reference, const Exec& exec)
    : reference_(reference) {
    against_.emplace_back(encoded, reference.encoded, exec);
    if (reference.encodedA.empty()) return;
    against_.emplace_back(encoded, reference.encodedA, exec);
    against_.emplace_back(encoded, reference.encodedB, exec);
}
void ReferenceErrors::add(int y0, int y1) {
    for (TileErrorRows& rows : against_) rows.add(y0, y1);
}
TileErrors ReferenceErrors::total() const {
    TileErrors errors = against_[0].total(reference_.sumOfSquares);
    if (against_.size() == 1) return errors;
    errors.againstA = against_[1].total(0).sum;
    errors.againstB = against_[2].total(0).sum;
    return errors;
}
TileErrors tileErrors(const Rgb& encoded, const Reference& reference, const Exec& exec) {
    ReferenceErrors errors(encoded, reference, exec);
    forRows(exec, encoded.height(), [&](int y0, int y1) { errors.add(y0, y1); });
    return errors.total();
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

void addFigures(FrameMetrics& to, const Metric& metric, const ImagePair& images, const Exec& exec,
                const Measure* prepared) {
    if (!metric.measure && !metric.prepare) return;
    const std::vector<double> values =
        prepared ? (*prepared)(images, exec) : metric.against(images.reference(), exec)(images, exec);
    for (size_t i = 0; i < values.size(); i++) to.others.emplace(metric.figures[i].name, values[i]);
}

void deriveFromMeans(FrameMetrics& means) {
    for (auto&& [name, value] : means.others)
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

namespace {
std::vector<const Metric*> wanted(const MeasureOptions& options, bool judged) {
    std::vector<const Metric*> all;
    for (const Metric& metric : metrics())
        if (metric.always) all.push_back(&metric);
    all.insert(all.end(), options.metrics.begin(), options.metrics.end());
    if (judged) all.insert(all.end(), options.ofJudged.begin(), options.ofJudged.end());
    return all;
}
}  // namespace

void prepare(Reference& r, const MeasureOptions& options, const Exec& exec, bool judged) {
    if (!r.sumOfSquares) r.sumOfSquares = sumOfSquares(r.encoded, exec);
    const ReferencePicture picture{r.encoded, &r.linear, options.flipPixelsPerDegree};
    for (const Metric* metric : wanted(options, judged))
        if (metric->prepare && !r.prepared.contains(metric)) r.prepared[metric] = metric->prepare(picture, exec);
}

FrameMetrics measure(const MeasuredPicture& picture, const Reference& reference, const MeasureOptions& options,
                     const Exec& exec, TileErrors& pool, bool judged) {
    const TileErrors errors = picture.errors ? *picture.errors : tileErrors(picture.encoded, reference, exec);
    pool += errors;
    FrameMetrics m = frameMetrics(errors.squaredError());
    const ImagePair images{picture.encoded,
                           reference.encoded,
                           picture.linear,
                           picture.linear ? &reference.linear : nullptr,
                           options.flipPixelsPerDegree,
                           picture.luma};
    for (const Metric* metric : wanted(options, judged)) {
        if (!metric->isPossible(images)) continue;
        const auto prepared = reference.prepared.find(metric);
        addFigures(m, *metric, images, exec, prepared == reference.prepared.end() ? nullptr : &prepared->second);
    }
    return m;
}

}  // namespace aa
