// Pooled figures, gains, pairs and error bars: what needs all frames and all methods together.
#include <algorithm>
#include <cmath>
#include <limits>

#include "study/external.h"
#include "study/results.h"

namespace aa {
namespace {

// A method's trail and flicker frame by frame.
struct OverTime {
    std::vector<FrameSum> ghost, flicker, rejected;
};
OverTime overTime(const MethodResult& m) {
    OverTime o;
    for (const auto& f : m.frames) {
        if (f.rejected && f.rejected->count > 0) o.rejected.push_back(*f.rejected);
        if (!f.temporal) continue;
        if (f.temporal->ghostValues > 0) o.ghost.push_back({f.temporal->ghostSquares, f.temporal->ghostValues});
        if (f.temporal->flickerPixels > 0) o.flicker.push_back({f.temporal->flickerSquares, f.temporal->flickerPixels});
    }
    return o;
}
void addErrorsOverTime(RunResults& run) {
    std::vector<OverTime> all;
    for (auto& m : run.methods) {
        all.push_back(overTime(m));
        FrameSum rejected;
        for (const FrameSum& f : all.back().rejected) rejected.sum += f.sum, rejected.count += f.count;
        if (rejected.count > 0) {
            const auto frames = std::count_if(m.frames.begin(), m.frames.end(), [](auto& f) { return f.rejected; });
            m.rejectedMse = rejected.sum / rejected.count;
            const Window area = run.protocol.region.value_or(Window{0, 0, run.width, run.height});
            m.rejectedShare = rejected.count / (3.0 * area.width * area.height * double(frames));
        }
        if (!m.temporal) continue;
        m.temporal->ghostMseError = errorOverTime(all.back().ghost);
        // The flicker along the motion is a root mean square: d sqrt(v) = dv / (2 sqrt(v)).
        if (const auto e = errorOverTime(all.back().flicker); e && m.temporal->flickerMoving.value_or(0) > 0)
            m.temporal->flickerError = *e * 255 * 255 / (2 * *m.temporal->flickerMoving);
    }
    for (auto& p : run.pairs) {
        const OverTime &a = all[p.first], &b = all[p.second];
        if (a.ghost.size() == b.ghost.size()) p.ghost = compareOverTime(a.ghost, b.ghost);
        if (a.flicker.size() == b.flicker.size()) p.flicker = compareOverTime(a.flicker, b.flicker);
        const bool samePixels = std::equal(a.rejected.begin(), a.rejected.end(), b.rejected.begin(), b.rejected.end(),
                                           [](auto& x, auto& y) { return x.count == y.count; });
        const auto base = [&](size_t i) { return withoutStages(run.methods[i].text); };
        if (samePixels && base(p.first) == base(p.second)) p.rejected = compareOverTime(a.rejected, b.rejected);
    }
}

// Mean of a value over the frames; absent unless every frame has it.
template <class Get>
std::optional<double> meanOf(const std::vector<const FrameMetrics*>& frames, Get get) {
    double sum = 0;
    for (const FrameMetrics* m : frames) {
        const std::optional<double> v = get(*m);
        if (!v) return {};
        sum += *v;
    }
    return sum / double(frames.size());
}
// Means of squares and of every other figure.
FrameMetrics meanMetrics(const std::vector<const FrameMetrics*>& frames) {
    FrameMetrics mean =
        frameMetrics(SquaredError{*meanOf(frames, [](const FrameMetrics& m) { return std::optional(m.mse); }),
                                  *meanOf(frames, [](const FrameMetrics& m) { return std::optional(m.reference); })});
    for (const auto& other : frames[0]->others)
        if (const auto v = meanOf(frames, [&](const FrameMetrics& m) { return m.figure(other.first); }))
            mean.others.emplace(other.first, *v);
    return mean;
}
std::optional<PooledMetrics> pool(const MethodResult& method, double noise) {
    std::vector<const FrameMetrics*> frames;
    for (const auto& f : method.frames)
        if (f.metrics && f.judged) frames.push_back(&*f.metrics);
    if (frames.empty()) return {};
    PooledMetrics p;
    p.frames = int(frames.size());
    p.mean = meanMetrics(frames);
    p.mseInterval = mseInterval(p.mean.mse, noise);
    double finite = 0;
    for (const FrameMetrics* m : frames) {
        if (std::isinf(m->psnr))
            p.infinitePsnrFrames++;
        else
            finite += m->psnr;
    }
    const int finiteFrames = p.frames - p.infinitePsnrFrames;
    p.meanFinitePsnr = finiteFrames ? finite / finiteFrames : std::numeric_limits<double>::infinity();
    return p;
}
double median(std::vector<double> v) {
    if (v.empty()) return 0;
    std::sort(v.begin(), v.end());
    const size_t half = v.size() / 2;
    return v.size() % 2 ? v[half] : (v[half - 1] + v[half]) / 2;
}
}  // namespace

std::optional<FigureRange> rangeOverFrames(const MethodResult& method, const Figure& figure) {
    const auto better = [&](double a, double b) { return figure.higherIsBetter ? a > b : a < b; };
    std::optional<FigureRange> range;
    double sum = 0, count = 0;
    for (const FrameResult& f : method.frames) {
        if (!f.judged || !f.metrics) continue;
        const std::optional<double> v = f.metrics->figure(figure.name);
        if (!v) return {};
        if (!range) range = {*v, *v, 0, f.frame, f.frame};
        if (better(*v, range->best)) range->best = *v, range->bestFrame = f.frame;
        if (better(range->worst, *v)) range->worst = *v, range->worstFrame = f.frame;
        sum += *v, count++;
    }
    if (range) range->mean = sum / count;
    return range;
}

TileErrors tileErrorsOf(const RunResults& run, const MethodResult& m) {
    TileErrors tiles;
    if (!m.pooled || m.tileSquares.empty()) return tiles;
    tiles.sum = m.tileSquares;
    const Window area = run.protocol.region.value_or(Window{0, 0, run.width, run.height});
    for (int y = 0; y < area.height; y += TileErrors::kTilePx)
        for (int x = 0; x < area.width; x += TileErrors::kTilePx)
            tiles.values.push_back(3.0 * std::min(TileErrors::kTilePx, area.width - x) *
                                   std::min(TileErrors::kTilePx, area.height - y) * m.pooled->frames);
    tiles.referenceSum = m.pooled->mean.reference * tiles.totalValues();
    return tiles;
}

std::string rerunLine(const RunResults& run, const MethodResult& m) {
    const std::string& line = run.provenance.rerun;
    if (line.empty()) return {};
    const std::string row =
        m.family == kExternalFamily ? "--external " + shellQuoted(m.id + "=" + m.source) : "-m " + shellQuoted(m.text);
    return line + " " + row + " -o " + shellQuoted(m.folder + "_again");
}

std::string incompleteInWords(const RunResults& run) {
    if (run.complete) return {};
    const std::string asked = run.framesAsked > 0 ? " of " + std::to_string(run.framesAsked) : "";
    const bool manyMethods = run.framesAsked > 0 && run.framesDone() == run.framesAsked;
    return manyMethods ? "interrupted before its last method"
                       : "interrupted after " + std::to_string(run.framesDone()) + asked + " frames";
}

bool RunResults::jitterCentred() const { return std::abs(jitterMeanPx[0]) < 1e-4 && std::abs(jitterMeanPx[1]) < 1e-4; }

void finish(RunResults& run, const std::vector<TileErrors>& errors) {
    const double noise = run.truthNoise.value_or(0);
    const MethodResult* noaa = nullptr;
    for (auto& m : run.methods) {
        std::vector<double> seconds;
        std::vector<double> onDevice;
        for (const auto& f : m.frames) {
            seconds.push_back(f.seconds);
            if (f.deviceSeconds) onDevice.push_back(*f.deviceSeconds);
        }
        if (!onDevice.empty()) {
            m.deviceSecondsMedian = median(onDevice);
            m.deviceSecondsMin = *std::min_element(onDevice.begin(), onDevice.end());
        }
        m.secondsMedian = median(seconds);
        m.secondsMin = seconds.empty() ? 0 : *std::min_element(seconds.begin(), seconds.end());
        m.nsPerPixel = m.secondsMedian * 1e9 / (double(run.width) * run.height);
        m.pooled = pool(m, noise);
        if (m.id == "noaa" && m.pooled) noaa = &m;
    }
    if (noaa)
        for (auto& m : run.methods)
            if (m.pooled)
                m.pooled->gainDb =
                    m.pooled->mean.mse == noaa->pooled->mean.mse ? 0 : m.pooled->mean.psnr - noaa->pooled->mean.psnr;
    for (auto& m : run.methods)
        if (noaa && noaa->temporal && noaa->temporal->ghostMse.value_or(0) > 0 && m.temporal && m.temporal->ghostMse)
            m.temporal->ghostExcess = *m.temporal->ghostMse / *noaa->temporal->ghostMse;
    for (size_t i = 0; i < errors.size() && i < run.methods.size(); i++) run.methods[i].tileSquares = errors[i].sum;
    run.pairs.clear();
    for (size_t i = 0; i < errors.size(); i++)
        for (size_t k = i + 1; k < errors.size(); k++)
            if (!errors[i].sum.empty() && errors[i].sum.size() == errors[k].sum.size())
                run.pairs.push_back({i, k, compareMethods(errors[i], errors[k], noise)});
    addErrorsOverTime(run);
}

}  // namespace aa
