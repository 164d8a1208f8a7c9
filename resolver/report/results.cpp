#include "report/results.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "image/error.h"
#include "image/io.h"
#include "methods/spec.h"

namespace aa {
namespace fs = std::filesystem;
using json = nlohmann::ordered_json;
namespace {

// ---- numbers: JSON has no infinity and no NaN ----
json number(double v) {
    if (std::isnan(v)) return "NaN";
    if (std::isinf(v)) return v > 0 ? "Inf" : "-Inf";
    return v;
}
json number(const std::optional<double>& v) { return v ? number(*v) : json(nullptr); }
double toNumber(const json& j) {
    if (j.is_string()) {
        const auto& s = j.get_ref<const std::string&>();
        if (s == "Inf") return std::numeric_limits<double>::infinity();
        if (s == "-Inf") return -std::numeric_limits<double>::infinity();
        if (s == "NaN") return std::numeric_limits<double>::quiet_NaN();
    }
    return j.get<double>();  // throws on any other type
}
std::optional<double> toOptional(const json& parent, const char* key) {
    const auto it = parent.find(key);
    if (it == parent.end() || it->is_null()) return {};
    return toNumber(*it);
}
std::string csvNumber(double v) {
    if (std::isnan(v)) return "NaN";
    if (std::isinf(v)) return v > 0 ? "Inf" : "-Inf";
    char text[40];
    std::snprintf(text, sizeof text, "%.9g", v);
    return text;
}
std::string csvNumber(const std::optional<double>& v) { return v ? csvNumber(*v) : ""; }
std::string csvText(const std::string& s) {
    if (s.find_first_of(",\"\n") == std::string::npos) return s;
    std::string quoted = "\"";
    for (const char c : s) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + '"';
}

json toJson(const DisplayChain& d) {
    return {{"exposureEv", d.exposure}, {"toneMap", name(d.toneMap)}, {"transfer", name(d.transfer)}};
}
DisplayChain displayChain(const json& j) {
    return {j.at("exposureEv").get<float>(), toneMapByName(j.at("toneMap").get<std::string>()),
            transferByName(j.value("transfer", "srgb"))};
}
bool quantised(const json& run) {
    const auto bits = run.find("quantiseBits");
    if (bits == run.end() || bits->is_null()) return false;
    if (bits->get<int>() != 8) throw std::runtime_error("quantiseBits: expected 8 or null");
    return true;
}

// ---- metrics ----
json toJson(const FrameMetrics& m) {
    json j = {{"mse", number(m.mse)},
              {"psnr", number(m.psnr)},
              {"snr", number(m.snr)},
              {"referencePower", number(m.reference)}};
    for (const auto& [name, value] : m.others) j[name] = number(value);
    return j;
}
FrameMetrics frameMetrics(const json& j) {
    FrameMetrics m = frameMetrics(SquaredError{toNumber(j.at("mse")), toNumber(j.at("referencePower"))});
    for (const Metric& metric : metrics())
        for (const Figure& f : metric.figures)
            if (const auto v = f.ofSquares ? std::nullopt : toOptional(j, std::string(f.name).c_str()))
                m.others.emplace(f.name, *v);
    return m;
}
json toJson(const PooledMetrics& p) {
    json j = toJson(p.mean);
    j["frames"] = p.frames;
    j["mseCorrected"] = number(p.mseInterval.corrected);
    j["meanFinitePsnr"] = number(p.meanFinitePsnr);
    j["infinitePsnrFrames"] = p.infinitePsnrFrames;
    if (p.gainDb) j["gainDb"] = number(p.gainDb);
    return j;
}
PooledMetrics pooledMetrics(const json& j) {
    PooledMetrics p;
    p.mean = frameMetrics(j);
    p.frames = j.at("frames").get<int>();
    p.mseInterval = {toNumber(j.at("mseCorrected")), p.mean.mse};
    p.meanFinitePsnr = toNumber(j.at("meanFinitePsnr"));
    p.infinitePsnrFrames = j.at("infinitePsnrFrames").get<int>();
    p.gainDb = toOptional(j, "gainDb");
    return p;
}

json toJson(const TemporalMetrics& t) {
    json j = {{"warmupFrames", t.warmup}, {"frames", t.frames}};
    const auto put = [&](const char* key, const std::optional<double>& v) {
        if (v) j[key] = number(v);
    };
    put("tPsnr", t.tPsnr);
    put("flickerStatic", t.flickerStatic);
    put("flickerStep", t.flickerStep);
    put("flickerMoving", t.flickerMoving);
    put("ghostMse", t.ghostMse);
    put("ghostExcess", t.ghostExcess);
    put("ghostMseError", t.ghostMseError);
    put("flickerError", t.flickerError);
    put("ghostHalfLifeFrames", t.ghostHalfLife);
    if (!t.ghostFraction.empty()) j["ghostFraction"] = t.ghostFraction, j["trailShare"] = t.trailShare;
    if (t.convergence) j["convergenceFrames"] = *t.convergence;
    return j;
}
TemporalMetrics temporalMetrics(const json& j) {
    TemporalMetrics t;
    t.warmup = j.at("warmupFrames").get<int>();
    t.frames = j.at("frames").get<int>();
    t.tPsnr = toOptional(j, "tPsnr");
    t.flickerStatic = toOptional(j, "flickerStatic");
    t.flickerStep = toOptional(j, "flickerStep");
    t.flickerMoving = toOptional(j, "flickerMoving");
    t.ghostMse = toOptional(j, "ghostMse");
    t.ghostExcess = toOptional(j, "ghostExcess");
    t.ghostMseError = toOptional(j, "ghostMseError");
    t.flickerError = toOptional(j, "flickerError");
    t.ghostHalfLife = toOptional(j, "ghostHalfLifeFrames");
    if (j.contains("ghostFraction")) {
        j.at("ghostFraction").get_to(t.ghostFraction);
        t.trailShare = toNumber(j.at("trailShare"));
    }
    if (j.contains("convergenceFrames")) t.convergence = j.at("convergenceFrames").get<int>();
    return t;
}

json toJson(const TemporalFrame& t) {
    return {{"ghostSquares", t.ghostSquares},
            {"ghostValues", t.ghostValues},
            {"flickerSquares", t.flickerSquares},
            {"flickerPixels", t.flickerPixels}};
}
TemporalFrame temporalFrame(const json& j) {
    return {j.at("ghostSquares").get<double>(), j.at("ghostValues").get<double>(), j.at("flickerSquares").get<double>(),
            j.at("flickerPixels").get<double>()};
}
json toJson(const TimeComparison& c) {
    return {{"gainDb", c.gainDb}, {"low95", c.low}, {"high95", c.high}, {"resolved", c.resolved}};
}
std::optional<TimeComparison> timeComparison(const json& pair, const char* key) {
    const auto it = pair.find(key);
    if (it == pair.end()) return {};
    return TimeComparison{it->at("gainDb").get<double>(), it->at("low95").get<double>(), it->at("high95").get<double>(),
                          it->at("resolved").get<bool>()};
}

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
            m.rejectedShare = rejected.count / (3.0 * run.width * run.height * double(frames));
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

bool RunResults::jitterCentred() const { return std::abs(jitterMeanPx[0]) < 1e-4 && std::abs(jitterMeanPx[1]) < 1e-4; }

void finish(RunResults& run, const std::vector<TileErrors>& errors) {
    const double noise = run.truthNoise.value_or(0);
    const MethodResult* noaa = nullptr;
    for (auto& m : run.methods) {
        std::vector<double> seconds;
        for (const auto& f : m.frames) seconds.push_back(f.seconds);
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

std::string toJsonText(const RunResults& run) {
    json j = {{"format", "aaresolve-results"}, {"version", 1}};
    j["shot"] = {{"name", run.shot},
                 {"resolution", {run.width, run.height}},
                 {"static", run.isStatic},
                 {"jitter",
                  {{"sequence", run.jitterSequence},
                   {"start", run.jitterStart},
                   {"period", run.jitterPeriod},
                   {"meanPx", {run.jitterMeanPx[0], run.jitterMeanPx[1]}},
                   {"centred", run.jitterCentred()}}}};
    if (run.subSamples > 0) j["shot"]["subSamples"] = run.subSamples;
    if (!run.renderSeconds.empty()) j["shot"]["renderSeconds"] = run.renderSeconds;
    j["truth"] = {{"samplesPerHalf", run.truthSamplesPerHalf},
                  {"filter", run.truthFilter},
                  {"filterWidthPx", run.truthFilterWidthPx},
                  {"noiseMse", number(run.truthNoise)}};
    j["truth"]["images"] = json::object();
    if (run.truthClipped) j["truth"]["clipped"] = {{"pixels", run.truthClipped->pixels}, {"of", run.truthClipped->of}};
    for (const auto& [frame, file] : run.truthImages) j["truth"]["images"][std::to_string(frame)] = file;
    j["run"] = {{"program", run.programVersion},
                {"instructionSet", run.isa},
                {"precision", run.precision},
                {"threads", run.threads},
                {"machine", run.machine},
                {"display", toJson(run.protocol.display)},
                {"history", name(run.protocol.history)},
                {"warmUpFrames", run.warmUpFrames},
                {"quantiseBits", run.protocol.eightBit ? json(8) : json(nullptr)},
                {"sanitised", run.sanitised}};
    j["methods"] = json::array();
    for (const auto& m : run.methods) {
        json q = {{"id", m.id},
                  {"text", m.text},
                  {"title", m.title},
                  {"family", m.family},
                  {"source", m.source},
                  {"folder", m.folder},
                  {"sampling", m.sampling},
                  {"parameters", m.parameters},
                  {"passes", m.passes},
                  {"stateBytes", m.stateBytes},
                  {"secondsMedian", m.secondsMedian},
                  {"secondsMin", m.secondsMin},
                  {"nsPerPixel", m.nsPerPixel},
                  {"pooled", m.pooled ? toJson(*m.pooled) : json(nullptr)},
                  {"frames", json::array()}};
        if (m.temporal) q["temporal"] = toJson(*m.temporal);
        if (!m.tileSquares.empty()) q["tileSquares"] = m.tileSquares;
        if (m.rejectedMse) q["rejected"] = {{"mse", *m.rejectedMse}, {"share", *m.rejectedShare}};
        for (const auto& f : m.frames) {
            json r = {{"frame", f.frame}, {"seconds", f.seconds}, {"judged", f.judged}};
            if (!f.image.empty()) r["image"] = f.image;
            if (f.metrics) r["metrics"] = toJson(*f.metrics);
            if (f.temporal) r["temporal"] = toJson(*f.temporal);
            if (f.rejected) r["rejected"] = {{"squares", f.rejected->sum}, {"values", f.rejected->count}};
            q["frames"].push_back(r);
        }
        j["methods"].push_back(q);
    }
    j["pairs"] = json::array();
    for (const auto& p : run.pairs) {
        json q = {{"first", run.methods[p.first].text},
                  {"second", run.methods[p.second].text},
                  {"indices", {p.first, p.second}},
                  {"mseDifference", number(p.comparison.mseDifference)},
                  {"low95", number(p.comparison.low)},
                  {"high95", number(p.comparison.high)},
                  {"gainDb", number(p.comparison.gainDb)},
                  {"gainLow95", number(p.comparison.gainLow)},
                  {"gainHigh95", number(p.comparison.gainHigh)},
                  {"resolved", p.comparison.resolved}};
        if (p.ghost) q["ghost"] = toJson(*p.ghost);
        if (p.flicker) q["flicker"] = toJson(*p.flicker);
        if (p.rejected) q["rejected"] = toJson(*p.rejected);
        j["pairs"].push_back(q);
    }
    return j.dump(1) + "\n";
}

std::vector<const Figure*> figuresIn(const RunResults& run) {
    std::set<std::string_view> present = {"mse", "psnr", "snr"};
    for (const auto& m : run.methods)
        for (const auto& f : m.frames)
            if (f.metrics)
                for (const auto& other : f.metrics->others) present.insert(other.first);
    std::vector<const Figure*> figures;
    for (const Metric& metric : metrics())
        for (const Figure& f : metric.figures)
            if (present.contains(f.name)) figures.push_back(&f);
    return figures;
}

std::string toCsvText(const RunResults& run) {
    std::ostringstream out;
    const std::string protocol = csvText(inOneField(run.protocol));
    const std::vector<const Figure*> figures = figuresIn(run);
    out << "method,frame";
    for (const Figure* f : figures) out << ',' << f->name;
    out << ",seconds,protocol\n";
    const auto line = [&](const std::string& method, const std::string& frame, const FrameMetrics* m, double seconds) {
        out << csvText(method) << ',' << frame;
        for (const Figure* f : figures) out << ',' << csvNumber(m ? m->figure(f->name) : std::nullopt);
        out << ',' << csvNumber(seconds) << ',' << protocol << '\n';
    };
    for (const auto& m : run.methods) {
        for (const auto& f : m.frames)
            line(m.text, std::to_string(f.frame), f.metrics ? &*f.metrics : nullptr, f.seconds);
        line(m.text, "pooled", m.pooled ? &m.pooled->mean : nullptr, m.secondsMedian);
    }
    return out.str();
}

void writeResults(const RunResults& run, const fs::path& folder) {
    writeText(folder / "results.json", toJsonText(run));
    writeText(folder / "results.csv", toCsvText(run));
}

RunResults readResults(const fs::path& folder) {
    const fs::path file = folder / "results.json";
    std::ifstream in(file);
    if (!in)
        throw InputError(file.string() +
                         ": no such file; expected the output folder of `aaresolve run SHOT -m ... -o OUT`");
    RunResults run;
    try {
        const json j = json::parse(in);
        if (j.at("format") != "aaresolve-results" || j.at("version") != 1)
            throw InputError(file.string() + ": not results of this program's version; run the shot again");
        const json &shot = j.at("shot"), &jitter = shot.at("jitter"), &truth = j.at("truth"), &made = j.at("run");
        run.shot = shot.at("name").get<std::string>();
        run.width = shot.at("resolution").at(0).get<int>();
        run.height = shot.at("resolution").at(1).get<int>();
        run.isStatic = shot.at("static").get<bool>();
        run.subSamples = shot.value("subSamples", 0);
        if (shot.contains("renderSeconds")) shot.at("renderSeconds").get_to(run.renderSeconds);
        run.jitterSequence = jitter.at("sequence").get<std::string>();
        run.jitterStart = jitter.at("start").get<int>();
        run.jitterPeriod = jitter.at("period").get<int>();
        for (size_t i = 0; i < 2; i++) run.jitterMeanPx[i] = jitter.at("meanPx").at(i).get<double>();
        run.truthSamplesPerHalf = truth.at("samplesPerHalf").get<int>();
        run.truthFilter = truth.at("filter").get<std::string>();
        run.truthFilterWidthPx = truth.at("filterWidthPx").get<double>();
        run.truthNoise = toOptional(truth, "noiseMse");
        for (const auto& [frame, image] : truth.at("images").items())
            run.truthImages[std::stoi(frame)] = image.get<std::string>();
        run.programVersion = made.at("program").get<std::string>();
        run.isa = made.at("instructionSet").get<std::string>();
        run.precision = made.at("precision").get<std::string>();
        run.threads = made.at("threads").get<int>();
        run.machine = made.at("machine").get<std::string>();
        // Runs before the protocol could be chosen have none of these but exposure and tone map.
        run.protocol.display = displayChain(made.at("display"));
        run.protocol.history = historyByName(made.value("history", "first"));
        run.protocol.eightBit = quantised(made);
        run.warmUpFrames = made.value("warmUpFrames", size_t(0));
        if (truth.contains("clipped"))
            run.truthClipped = {truth.at("clipped").at("pixels").get<size_t>(),
                                truth.at("clipped").at("of").get<size_t>()};
        made.at("sanitised").get_to(run.sanitised);
        for (const json& q : j.at("methods")) {
            MethodResult m;
            m.id = q.at("id").get<std::string>();
            m.text = q.at("text").get<std::string>();
            m.title = q.at("title").get<std::string>();
            m.family = q.at("family").get<std::string>();
            m.sampling = q.at("sampling").get<std::string>();
            m.source = q.at("source").get<std::string>();
            m.folder = q.at("folder").get<std::string>();
            q.at("parameters").get_to(m.parameters);
            q.at("passes").get_to(m.passes);
            m.stateBytes = q.at("stateBytes").get<size_t>();
            m.secondsMedian = q.at("secondsMedian").get<double>();
            m.secondsMin = q.at("secondsMin").get<double>();
            m.nsPerPixel = q.at("nsPerPixel").get<double>();
            if (!q.at("pooled").is_null()) m.pooled = pooledMetrics(q.at("pooled"));
            if (q.contains("temporal")) m.temporal = temporalMetrics(q.at("temporal"));
            if (q.contains("tileSquares")) q.at("tileSquares").get_to(m.tileSquares);
            if (q.contains("rejected"))
                m.rejectedMse = q.at("rejected").at("mse").get<double>(),
                m.rejectedShare = q.at("rejected").at("share").get<double>();
            for (const json& r : q.at("frames")) {
                FrameResult f;
                f.frame = r.at("frame").get<int>();
                f.seconds = r.at("seconds").get<double>();
                f.judged = r.at("judged").get<bool>();
                f.image = r.value("image", "");
                if (r.contains("metrics")) f.metrics = frameMetrics(r.at("metrics"));
                if (r.contains("temporal")) f.temporal = temporalFrame(r.at("temporal"));
                if (r.contains("rejected"))
                    f.rejected = FrameSum{r.at("rejected").at("squares").get<double>(),
                                          r.at("rejected").at("values").get<double>()};
                m.frames.push_back(f);
            }
            run.methods.push_back(m);
        }
        for (const json& q : j.at("pairs")) {
            PairResult p;
            p.first = q.at("indices").at(0).get<size_t>();
            p.second = q.at("indices").at(1).get<size_t>();
            p.comparison = {.mseDifference = toNumber(q.at("mseDifference")),
                            .low = toNumber(q.at("low95")),
                            .high = toNumber(q.at("high95")),
                            .gainDb = toNumber(q.at("gainDb")),
                            .gainLow = toNumber(q.at("gainLow95")),
                            .gainHigh = toNumber(q.at("gainHigh95")),
                            .resolved = q.at("resolved").get<bool>()};
            p.ghost = timeComparison(q, "ghost"), p.flicker = timeComparison(q, "flicker");
            p.rejected = timeComparison(q, "rejected");
            if (p.first >= run.methods.size() || p.second >= run.methods.size())
                throw InputError(file.string() + ": a pair names a method that is not there; run the shot again");
            run.pairs.push_back(p);
        }
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& e) {
        throw InputError(file.string() + ": damaged (" + e.what() + "); run the shot again");
    }
    return run;
}

std::string machineName() {
    std::ifstream cpus("/proc/cpuinfo");
    for (std::string line; std::getline(cpus, line);)
        if (line.starts_with("model name")) {
            const size_t colon = line.find(':');
            if (colon != std::string::npos) return line.substr(std::min(line.size(), colon + 2));
        }
    return "unknown processor";
}

}  // namespace aa
