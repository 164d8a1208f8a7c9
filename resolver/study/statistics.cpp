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
    OverTime o{ghostSums(m), flickerSums(m), {}};
    for (const auto& f : m.frames)
        if (f.rejected && f.rejected->count > 0) o.rejected.push_back(*f.rejected);
    return o;
}
template <class Get>
std::vector<FrameSum> sumsOf(const MethodResult& m, Get get) {
    std::vector<FrameSum> sums;
    for (const auto& f : m.frames)
        if (f.temporal)
            if (const FrameSum s = get(*f.temporal); s.count > 0) sums.push_back(s);
    return sums;
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
        if (p.comparison.why == Unresolved::equal)  // whatever else the two differ by is rounding, too
            for (auto* overTime : {&p.ghost, &p.flicker, &p.rejected})
                if (*overTime) *overTime = TimeComparison{};
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
    deriveFromMeans(mean);
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
    // Of metrics that watch the sequence a mean over frames is no figure: nothing before all were seen.
    p.mean.others.eraseIf([](const auto& f) { return figureByName(f.first) && findFigure(f.first).metric->watch; });
    for (const auto& [name, value] : method.sequence)
        if (const Figure* f = figureByName(name)) p.mean.others[f->name] = value;
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
// Between the two nearest; the share 0.5 is the median.
double quantile(std::vector<double> v, double share) {
    if (v.empty()) return 0;
    std::sort(v.begin(), v.end());
    const double at = share * double(v.size() - 1);
    const size_t below = size_t(at), above = std::min(below + 1, v.size() - 1);
    return v[below] + (at - double(below)) * (v[above] - v[below]);
}
double median(const std::vector<double>& v) { return quantile(v, 0.5); }

// The first frame allocates, touches memory for the first time and has no history to read: where others are, it does
// not count.
template <class Get>
std::vector<double> timingsOf(const MethodResult& m, Get get) {
    std::vector<double> timings;
    const size_t skipped = m.frames.size() + m.moreSeconds.size() > 2 ? 1 : 0;
    for (size_t i = skipped; i < m.frames.size(); i++) timings.push_back(get(m.frames[i]));
    return timings;
}
void fillTimes(MethodResult& m, double pixels) {
    std::vector<double> seconds = timingsOf(m, [](const FrameResult& f) { return f.seconds; });
    seconds.insert(seconds.end(), m.moreSeconds.begin(), m.moreSeconds.end());
    if (seconds.empty()) return;
    m.timings = int(seconds.size());
    m.secondsMedian = median(seconds);
    m.secondsMin = *std::min_element(seconds.begin(), seconds.end());
    constexpr size_t kFew = 4;
    m.secondsLow = seconds.size() < kFew ? m.secondsMin : quantile(seconds, 0.25);
    m.secondsHigh = seconds.size() < kFew ? *std::max_element(seconds.begin(), seconds.end()) : quantile(seconds, 0.75);
    m.nsPerPixel = m.secondsMedian * 1e9 / pixels;
    m.wallMedian = median(timingsOf(m, [](const FrameResult& f) { return f.wallSeconds; }));
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

bool RunResults::hasFigures() const {
    return std::any_of(methods.begin(), methods.end(), [](const MethodResult& m) { return m.pooled.has_value(); });
}
bool RunResults::jitterCentred() const { return std::abs(jitterMeanPx[0]) < 1e-4 && std::abs(jitterMeanPx[1]) < 1e-4; }

std::vector<FrameSum> ghostSums(const MethodResult& m) {
    return sumsOf(m, [](const TemporalFrame& t) { return FrameSum{t.ghostSquares, t.ghostValues}; });
}
std::vector<FrameSum> flickerSums(const MethodResult& m) {
    return sumsOf(m, [](const TemporalFrame& t) { return FrameSum{t.flickerSquares, t.flickerPixels}; });
}

std::optional<size_t> indexOf(const RunResults& run, std::string_view text) {
    for (size_t i = 0; i < run.methods.size(); i++)
        if (run.methods[i].text == text) return i;
    return {};
}
std::optional<size_t> noaaOf(const RunResults& run) {
    for (size_t i = 0; i < run.methods.size(); i++)
        if (run.methods[i].id == "noaa" && run.methods[i].pooled) return i;
    return {};
}
bool comparable(const MethodResult& a, const MethodResult& b) {
    return !a.parts.empty() && a.parts.size() == b.parts.size() &&
           a.parts[0].squares.size() == b.parts[0].squares.size();
}

std::optional<Comparison> compared(const RunResults& run, size_t a, size_t b) {
    const auto pair = std::find_if(run.pairs.begin(), run.pairs.end(), [&](const PairResult& p) {
        return (p.first == a && p.second == b) || (p.first == b && p.second == a);
    });
    if (pair == run.pairs.end()) return {};
    Comparison c = pair->comparison;
    if (pair->first == a) return c;
    c.mseDifference = -c.mseDifference, c.gainDb = -c.gainDb;
    std::swap(c.low, c.high), std::swap(c.gainLow, c.gainHigh);
    for (double* v : {&c.low, &c.high, &c.gainLow, &c.gainHigh}) *v = -*v;
    return c;
}

void finish(RunResults& run, const std::vector<TileErrors>& errors) {
    const double noise = run.truthNoise.value_or(0);
    for (auto& m : run.methods) {
        std::vector<double> onDevice;
        for (const auto& f : m.frames)
            if (f.deviceSeconds) onDevice.push_back(*f.deviceSeconds);
        if (!onDevice.empty()) {
            m.deviceSecondsMedian = median(onDevice);
            m.deviceSecondsMin = *std::min_element(onDevice.begin(), onDevice.end());
        }
        fillTimes(m, double(run.width) * run.height);
        m.pooled = pool(m, noise);
    }
    const auto plain = noaaOf(run);
    const MethodResult* noaa = plain ? &run.methods[*plain] : nullptr;
    if (noaa)
        for (auto& m : run.methods)
            if (m.pooled)
                m.pooled->gainDb =
                    m.pooled->mean.mse == noaa->pooled->mean.mse ? 0 : m.pooled->mean.psnr - noaa->pooled->mean.psnr;
    for (auto& m : run.methods)
        if (noaa && noaa->temporal && noaa->temporal->ghostMse.value_or(0) > 0 && m.temporal && m.temporal->ghostMse)
            m.temporal->ghostExcess = *m.temporal->ghostMse / *noaa->temporal->ghostMse;
    for (size_t i = 0; i < errors.size() && i < run.methods.size(); i++) {
        if (errors[i].sum.empty()) continue;
        run.methods[i].tileSquares = errors[i].coarse(kResultTilePx / TileErrors::kTilePx);
        run.methods[i].parts = errorParts(errors[i]);
    }
    run.pairs.clear();
    for (size_t i = 0; i < run.methods.size(); i++)
        for (size_t k = i + 1; k < run.methods.size(); k++)
            if (comparable(run.methods[i], run.methods[k]))
                run.pairs.push_back({i, k, compareMethods(run.methods[i].parts, run.methods[k].parts)});
    for (const auto& p : run.pairs)
        if (plain && p.comparison.why == Unresolved::equal && (p.first == *plain || p.second == *plain))
            run.methods[p.first == *plain ? p.second : p.first].pooled->gainDb = 0;
    addErrorsOverTime(run);
}

}  // namespace aa
