// results.json. Every member is described once, in a members() below: the writer and the reader are visitors of the
// same description, so that nothing is written that cannot be read. JSON has no infinity and no NaN: they are texts.
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "image/error.h"
#include "image/inputs.h"
#include "image/io.h"
#include "image/json_stream.h"
#include "image/json_text.h"
#include "image/readable.h"
#include "study/json_number.h"
#include "study/results.h"

namespace aa {
namespace {
namespace fs = std::filesystem;
using json = nlohmann::ordered_json;

template <class T>
T wholeOf(const json& j) {
    const bool isBelow = j.is_number_unsigned() ? std::in_range<T>(j.get<uint64_t>())
                                                : j.is_number_integer() && std::in_range<T>(j.get<int64_t>());
    if (!isBelow)
        throw std::runtime_error("expected a whole number from " + std::to_string(std::numeric_limits<T>::min()) +
                                 " to " + std::to_string(std::numeric_limits<T>::max()) + ", found " +
                                 jsonText(j, -1).substr(0, 40));
    return j.get<T>();
}
// A value as JSON holds it, and back.
template <class T>
json toJson(const T& v) {
    if constexpr (std::is_same_v<T, double>)
        return jsonNumber(v);
    else
        return v;
}
// JSON's library would cut off what an integer does not hold.
template <class T>
void fromJson(const json& j, T& v) {
    if constexpr (std::is_same_v<T, double>)
        v = numberOf(j);
    else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>)
        v = wholeOf<T>(j);
    else
        j.get_to(v);
}
template <class T>
void fromJson(const json& j, std::vector<T>& values) {
    if (!j.is_array()) throw std::runtime_error("expected a list, found " + jsonText(j, -1).substr(0, 40));
    for (const json& value : j) fromJson(value, values.emplace_back());
}
template <class T, class Less>
void fromJson(const json& j, std::map<std::string, T, Less>& values) {
    if (!j.is_object()) throw std::runtime_error("expected an object, found " + jsonText(j, -1).substr(0, 40));
    for (const auto& [key, value] : j.items()) fromJson(value, values[key]);
}
// Enumerations by name.
json toJson(const ToneMap& v) { return name(v); }
json toJson(const Transfer& v) { return name(v); }
json toJson(const History& v) { return name(v); }
void fromJson(const json& j, ToneMap& v) { v = toneMapByName(j.get<std::string>()); }
void fromJson(const json& j, Transfer& v) { v = transferByName(j.get<std::string>()); }
void fromJson(const json& j, History& v) { v = historyByName(j.get<std::string>()); }
json toJson(const Window& v) { return {v.x, v.y, v.width, v.height}; }
void fromJson(const json& j, Window& v) {
    v = {wholeOf<int>(j.at(0)), wholeOf<int>(j.at(1)), wholeOf<int>(j.at(2)), wholeOf<int>(j.at(3))};
}
// JSON's keys are texts.
json toJson(const std::map<int, std::string>& images) {
    json j = json::object();
    for (const auto& [frame, file] : images) j[std::to_string(frame)] = file;
    return j;
}
void fromJson(const json& j, std::map<int, std::string>& images) {
    for (const auto& [frame, file] : j.items()) images[std::stoi(frame)] = file.get<std::string>();
}
// The two visitors. One member per call: under a key, as a value or as what its own members() describe.
class Writer {
  public:
    explicit Writer(JsonStream& to) : to_(to) {}
    template <class T>
    void value(const char* key, const T& v) {
        to_.value(key, toJson(v));
    }
    // Left out where there is nothing to say; absent, it is what it was.
    template <class T>
    void sparse(const char* key, const T& v, bool said) {
        if (said) value(key, v);
    }
    template <class T>
    void maybe(const char* key, const std::optional<T>& v) {
        if (v) value(key, *v);
    }
    template <class T>
    void orNull(const char* key, const std::optional<T>& v) {
        to_.value(key, v ? toJson(*v) : json(nullptr));
    }
    // Follows from other members: written alone.
    template <class T>
    void derived(const char* key, const T& v) {
        value(key, v);
    }
    template <class... T>
    void array(const char* key, const T&... v) {
        to_.value(key, json::array({toJson(v)...}));
    }
    template <class Members>
    void group(const char* key, const Members& inside) {
        to_.object(key, [&] { inside(Writer(to_)); });
    }
    template <class Members>
    void groupIf(bool present, const char* key, const Members& inside) {
        if (present) group(key, inside);
    }
    template <class T>
    void object(const char* key, const T& v) {
        to_.object(key, [&] { members(Writer(to_), v); });
    }
    template <class T>
    void maybeObject(const char* key, const std::optional<T>& v) {
        if (v) object(key, *v);
    }
    template <class T>
    void objectOrNull(const char* key, const std::optional<T>& v) {
        if (v)
            object(key, *v);
        else
            to_.value(key, nullptr);
    }
    // `derived` adds what follows from elsewhere to each.
    template <class T, class Derived>
    void list(const char* key, const std::vector<T>& all, const Derived& derived) {
        to_.list(key, [&] {
            for (const T& v : all)
                to_.element([&] {
                    members(Writer(to_), v);
                    derived(Writer(to_), v);
                });
        });
    }
    template <class T>
    void list(const char* key, const std::vector<T>& all) {
        list(key, all, [](const Writer&, const T&) {});
    }
    template <class T>
    void sparseList(const char* key, const std::vector<T>& all) {
        if (!all.empty()) list(key, all);
    }

  private:
    JsonStream& to_;
};
class Reader {
  public:
    explicit Reader(const json& from) : from_(from) {}
    template <class T>
    void value(const char* key, T&& v) {
        fromJson(from_.at(key), v);
    }
    template <class T>
    void sparse(const char* key, T&& v, bool) {
        if (from_.contains(key)) fromJson(from_.at(key), v);
    }
    template <class T>
    void maybe(const char* key, std::optional<T>& v) {
        if (from_.contains(key) && !from_.at(key).is_null()) fromJson(from_.at(key), v.emplace());
    }
    template <class T>
    void orNull(const char* key, std::optional<T>& v) {
        maybe(key, v);
    }
    template <class T>
    void derived(const char*, const T&) {}
    template <class... T>
    void array(const char* key, T&... v) {
        size_t i = 0;
        (fromJson(from_.at(key).at(i++), v), ...);
    }
    template <class Members>
    void group(const char* key, const Members& inside) {
        inside(Reader(from_.at(key)));
    }
    template <class Members>
    void groupIf(bool, const char* key, const Members& inside) {
        if (from_.contains(key)) group(key, inside);
    }
    template <class T>
    void object(const char* key, T& v) {
        members(Reader(from_.at(key)), v);
    }
    template <class T>
    void maybeObject(const char* key, std::optional<T>& v) {
        if (from_.contains(key) && !from_.at(key).is_null()) object(key, v.emplace());
    }
    template <class T>
    void objectOrNull(const char* key, std::optional<T>& v) {
        from_.at(key);
        maybeObject(key, v);
    }
    template <class T, class... Derived>
    void list(const char* key, std::vector<T>& all, const Derived&...) {
        for (const json& j : from_.at(key)) members(Reader(j), all.emplace_back());
    }
    template <class T>
    void sparseList(const char* key, std::vector<T>& all) {
        if (from_.contains(key)) list(key, all);
    }

  private:
    const json& from_;
};
template <class V>
constexpr bool kReads = std::is_same_v<std::remove_cvref_t<V>, Reader>;

// ---- the description; what is described is const where it is written ----
template <class S, class T>
concept Is = std::is_same_v<std::remove_const_t<S>, T>;

template <class V, Is<FrameMetrics> S>
void members(V v, S& m) {
    v.value("mse", m.mse);
    v.derived("psnr", m.psnr);
    v.derived("snr", m.snr);
    v.value("referencePower", m.reference);
    if constexpr (kReads<V>) m = frameMetrics(m.squares());
    if constexpr (kReads<V>) {
        for (const Metric& metric : metrics())
            for (const Figure& f : metric.figures) {
                std::optional<double> value;
                if (!f.ofSquares) v.maybe(std::string(f.name).c_str(), value);
                if (value) m.others.emplace(f.name, *value);
            }
    } else {
        for (const auto& [name, value] : m.others) v.value(std::string(name).c_str(), value);
    }
}
template <class V, Is<PooledMetrics> S>
void members(V v, S& p) {
    members(v, p.mean);
    v.value("frames", p.frames);
    v.value("mseCorrected", p.mseInterval.corrected);
    if constexpr (kReads<V>) p.mseInterval.raw = p.mean.mse;
    v.value("meanFinitePsnr", p.meanFinitePsnr);
    v.value("infinitePsnrFrames", p.infinitePsnrFrames);
    v.maybe("gainDb", p.gainDb);
}
template <class V, Is<TemporalMetrics> S>
void members(V v, S& t) {
    v.value("warmupFrames", t.warmup);
    v.value("frames", t.frames);
    v.maybe("tPsnr", t.tPsnr);
    v.maybe("flickerStatic", t.flickerStatic);
    v.maybe("flickerStep", t.flickerStep);
    v.maybe("flickerMoving", t.flickerMoving);
    v.maybe("ghostMse", t.ghostMse);
    v.maybe("ghostExcess", t.ghostExcess);
    v.maybe("ghostMseError", t.ghostMseError);
    v.maybe("flickerError", t.flickerError);
    v.maybe("ghostHalfLifeFrames", t.ghostHalfLife);
    v.sparse("ghostFraction", t.ghostFraction, !t.ghostFraction.empty());
    v.sparse("trailShare", t.trailShare, !t.ghostFraction.empty());
    v.maybe("convergenceFrames", t.convergence);
}
template <class V, Is<TemporalFrame> S>
void members(V v, S& t) {
    v.value("ghostSquares", t.ghostSquares);
    v.value("ghostValues", t.ghostValues);
    v.value("flickerSquares", t.flickerSquares);
    v.value("flickerPixels", t.flickerPixels);
}
template <class V, Is<FrameSum> S>
void members(V v, S& s) {
    v.value("squares", s.sum);
    v.value("values", s.count);
}
template <class V, Is<ClippedPixels> S>
void members(V v, S& c) {
    v.value("pixels", c.pixels);
    v.value("of", c.of);
}
template <class V, Is<TimeComparison> S>
void members(V v, S& c) {
    v.value("gainDb", c.gainDb);
    v.value("low95", c.low);
    v.value("high95", c.high);
    v.value("resolved", c.resolved);
}
template <class V, Is<ErrorParts> S>
void members(V v, S& p) {
    v.value("columns", p.columns);
    v.value("rows", p.rows);
    v.value("squares", p.squares);
    v.value("halves", p.halves);
    v.value("values", p.values);
    v.value("measured", p.measured);
}
template <class V, Is<FrameResult> S>
void members(V v, S& f) {
    v.value("frame", f.frame);
    v.value("seconds", f.seconds);
    v.sparse("wallSeconds", f.wallSeconds, f.wallSeconds > 0);
    v.maybe("deviceSeconds", f.deviceSeconds);
    v.value("judged", f.judged);
    v.sparse("image", f.image, !f.image.empty());
    v.sparse("nonFinite", f.nonFinite, f.nonFinite > 0);
    v.maybeObject("metrics", f.metrics);
    v.maybeObject("temporal", f.temporal);
    v.maybeObject("rejected", f.rejected);
}
template <class V, Is<FigureRange> S>
void members(V v, S& r) {
    v.value("best", r.best);
    v.value("worst", r.worst);
    v.value("mean", r.mean);
    v.value("bestFrame", r.bestFrame);
    v.value("worstFrame", r.worstFrame);
}
template <class V, Is<MethodResult> S>
void members(V v, S& m) {
    v.value("id", m.id);
    v.value("text", m.text);
    v.value("title", m.title);
    v.value("family", m.family);
    v.value("source", m.source);
    v.value("folder", m.folder);
    v.value("sampling", m.sampling);
    v.value("parameters", m.parameters);
    v.value("passes", m.passes);
    v.sparse("inputBytes", m.inputBytes, true);
    v.sparse("targetBytes", m.targetBytes, true);
    v.value("stateBytes", m.stateBytes);
    v.value("secondsMedian", m.secondsMedian);
    v.value("secondsMin", m.secondsMin);
    v.sparse("secondsLow", m.secondsLow, m.timings > 0);
    v.sparse("secondsHigh", m.secondsHigh, m.timings > 0);
    v.sparse("timings", m.timings, m.timings > 0);
    v.sparse("wallSecondsMedian", m.wallMedian, m.wallMedian > 0);
    v.value("nsPerPixel", m.nsPerPixel);
    v.maybe("deviceSecondsMedian", m.deviceSecondsMedian);
    v.maybe("deviceSecondsMin", m.deviceSecondsMin);
    v.objectOrNull("pooled", m.pooled);
    if constexpr (!kReads<V>)  // follows from the frames
        v.groupIf(m.pooled && m.pooled->frames > 1, "overFrames", [&](auto figures) {
            for (const Metric& metric : metrics())
                for (const Figure& f : metric.figures)
                    figures.maybeObject(std::string(f.name).c_str(), rangeOverFrames(m, f));
        });
    v.list("frames", m.frames);
    v.maybeObject("temporal", m.temporal);
    v.sparse("sequence", m.sequence, !m.sequence.empty());
    v.sparse("tileSquares", m.tileSquares, !m.tileSquares.empty());
    v.sparseList("errorParts", m.parts);
    v.groupIf(m.rejectedMse.has_value(), "rejected", [&](auto rejected) {
        rejected.orNull("mse", m.rejectedMse);
        rejected.orNull("share", m.rejectedShare);
    });
}
template <class V, Is<PairResult> S>
void members(V v, S& p) {
    v.array("indices", p.first, p.second);
    v.value("mseDifference", p.comparison.mseDifference);
    v.value("low95", p.comparison.low);
    v.value("high95", p.comparison.high);
    v.value("gainDb", p.comparison.gainDb);
    v.value("gainLow95", p.comparison.gainLow);
    v.value("gainHigh95", p.comparison.gainHigh);
    v.value("resolved", p.comparison.resolved);
    std::string why(kReads<V> ? nameOf(Unresolved::varies) : nameOf(p.comparison.why));
    v.sparse("unresolved", why, !p.comparison.resolved);
    if constexpr (kReads<V>) p.comparison.why = p.comparison.resolved ? Unresolved::no : unresolvedByName(why);
    v.maybeObject("ghost", p.ghost);
    v.maybeObject("flicker", p.flicker);
    v.maybeObject("rejected", p.rejected);
}
template <class V, Is<MachineLoad> S>
void members(V v, S& l) {
    v.value("before", l.before);
    v.value("processors", l.processors);
    v.maybe("waitedShare", l.waited);
    v.derived("busy", l.busy());
}
template <class V, Is<ShownOn> S>
void members(V v, S& s) {
    v.value("display", s.display);
    v.value("words", s.words);
    v.value("pixelsPerDegree", s.pixelsPerDegree);
    v.value("framesPerSecond", s.framesPerSecond);
}
template <class V, Is<RunDevice> S>
void members(V v, S& d) {
    v.value("name", d.name);
    v.value("kind", d.kind);
    v.value("driver", d.driver);
    v.value("precision", d.precision);
    v.value("judged", d.judged);
}
template <class V, Is<Provenance> S>
void members(V v, S& p) {
    v.value("date", p.date);
    v.sparse("command", p.command, !p.command.empty());
    v.sparse("rerun", p.rerun, !p.rerun.empty());
    v.value("folder", p.folder);
    v.value("shotPath", p.shotPath);
    v.sparse("commit", p.commit, !p.commit.empty());
    v.group("machine", [&](auto m) {
        m.value("processor", p.machine.processor);
        m.value("cores", p.machine.cores);
        m.value("instructionSets", p.machine.instructionSets);
        m.value("system", p.machine.system);
    });
}
template <class V, Is<RunResults> S>
void members(V all, S& run) {
    all.groupIf(!run.provenance.date.empty(), "provenance", [&](auto v) { members(v, run.provenance); });
    all.group("shot", [&](auto v) {
        v.value("name", run.shot);
        v.sparse("hash", run.shotHash, !run.shotHash.empty());
        v.array("resolution", run.width, run.height);
        v.value("static", run.isStatic);
        v.group("jitter", [&](auto j) {
            j.value("sequence", run.jitterSequence);
            j.value("start", run.jitterStart);
            j.value("period", run.jitterPeriod);
            j.array("meanPx", run.jitterMeanPx[0], run.jitterMeanPx[1]);
            j.derived("centred", run.jitterCentred());
        });
        v.sparse("subSamples", run.subSamples, run.subSamples > 0);
        v.sparse("renderSeconds", run.renderSeconds, !run.renderSeconds.empty());
    });
    all.group("truth", [&](auto v) {
        v.value("samplesPerHalf", run.truthSamplesPerHalf);
        v.value("filter", run.truthFilter);
        v.value("filterWidthPx", run.truthFilterWidthPx);
        v.orNull("noiseMse", run.truthNoise);
        v.value("images", run.truthImages);
        v.maybeObject("clipped", run.truthClipped);
    });
    // Runs before the protocol could be chosen have none of it but exposure and tone map.
    all.group("run", [&](auto v) {
        v.sparse("complete", run.complete, true);
        v.sparse("framesAsked", run.framesAsked, run.framesAsked > 0);
        v.sparse("asked", run.asked, !run.asked.empty());
        v.value("program", run.programVersion);
        v.value("instructionSet", run.isa);
        v.value("precision", run.precision);
        v.value("threads", run.threads);
        v.value("machine", run.machine);
        v.maybeObject("device", run.device);
        v.maybeObject("load", run.load);
        v.sparse("figuresLeftOut", run.leftOut, !run.leftOut.empty());
        v.group("display", [&](auto d) {
            d.value("exposureEv", run.protocol.display.exposure);
            d.value("toneMap", run.protocol.display.toneMap);
            d.sparse("transfer", run.protocol.display.transfer, true);
        });
        v.sparse("history", run.protocol.history, true);
        v.sparse("warmUpFrames", run.warmUpFrames, true);
        std::optional<int> bits;
        if (run.protocol.eightBit) bits = 8;
        v.orNull("quantiseBits", bits);
        if constexpr (!std::is_const_v<S>) {  // reading
            if (bits && *bits != 8) throw std::runtime_error("quantiseBits: expected 8 or null");
            run.protocol.eightBit = bits.has_value();
        }
        v.maybe("region", run.protocol.region);
        v.sparse("reference", run.protocol.reference, !run.protocol.reference.empty());
        v.maybeObject("shownOn", run.shownOn);
        v.maybe("flipPixelsPerDegree", run.flipPixelsPerDegree);
        v.sparse("maps", run.maps, !run.maps.empty());
        v.value("sanitised", run.sanitised);
    });
    all.list("methods", run.methods, [&](auto v, const MethodResult& m) {
        const std::string line = rerunLine(run, m);
        v.sparse("rerun", line, !line.empty());
    });
    all.list("pairs", run.pairs, [&](auto v, const PairResult& p) {  // for those who read the file without counting
        v.derived("first", run.methods[p.first].text);
        v.derived("second", run.methods[p.second].text);
    });
}
void writeJson(const RunResults& run, std::ostream& out) {
    JsonStream::write(out, [&](JsonStream& stream) {
        stream.value("format", "aaresolve-results");
        stream.value("version", 1);
        members(Writer(stream), run);
    });
    out << '\n';
}
}  // namespace

std::string toJsonText(const RunResults& run) {
    std::ostringstream out;
    writeJson(run, out);
    return out.str();
}

void writeResults(const RunResults& run, const fs::path& folder) {
    writeStream(folder / "results.csv", [&](std::ostream& out) { writeCsv(run, out); });
    // Last: whole results have a whole table beside them.
    mayBeReplaced(folder / "results.json");
    writeStream(folder / "results.json", [&](std::ostream& out) { writeJson(run, out); });
}

namespace {
// What is read, replaced or removed by these names lies in the run's folder.
void checkPaths(const RunResults& run) {
    const auto check = [](const std::string& path, const char* what) {
        if (!isPathBelow(path))
            throw std::runtime_error(std::string(what) + ": expected a path below the run's folder, found '" + path +
                                     "'");
    };
    for (const auto& [frame, image] : run.truthImages) check(image, "truth.images");
    for (const auto& kind : run.maps) check(kind.first, "run.maps");
    for (const MethodResult& m : run.methods) {
        check(m.folder, "folder");
        for (const FrameResult& f : m.frames)
            if (!f.image.empty()) check(f.image, "image");
    }
}
// Those of two methods are compared part by part.
void checkParts(const RunResults& run) {
    const std::vector<ErrorParts>* first = nullptr;
    for (const MethodResult& m : run.methods) {
        for (const ErrorParts& p : m.parts) {
            const size_t count = p.columns > 0 && p.rows > 0 ? size_t(p.columns) * size_t(p.rows) : 0;
            if (count == 0 || p.squares.size() != count || p.halves.size() != count || p.values.size() != count)
                throw std::runtime_error("errorParts of " + m.text + ": not as many as columns x rows");
        }
        if (m.parts.empty()) continue;
        const auto isAlike = [](const ErrorParts& a, const ErrorParts& b) {
            return a.columns == b.columns && a.rows == b.rows;
        };
        if (first && !std::equal(first->begin(), first->end(), m.parts.begin(), m.parts.end(), isAlike))
            throw std::runtime_error("errorParts of " + m.text + ": other parts than those of another method");
        first = &m.parts;
    }
}
}  // namespace

RunResults readResults(const fs::path& path) {
    std::error_code ignored;
    const fs::path file = fs::is_regular_file(path, ignored) ? path : path / "results.json";
    const std::string text = requiredText(file, "; expected the output folder of `aaresolve run SHOT -m ... -o OUT`");
    RunResults run;
    try {
        const json j = parseJson(text, file.string(), "run the shot again");
        if (j.at("format") != "aaresolve-results" || j.at("version") != 1)
            throw InputError(file.string() + ": not results of this program's version; run the shot again");
        members(Reader(j), run);
        if (run.protocol.region && !run.protocol.region->isInside(run.width, run.height))
            throw InputError(file.string() + ": its region is not within the picture; run the shot again");
        checkPaths(run);
        checkParts(run);
        for (const PairResult& p : run.pairs)
            if (p.first >= run.methods.size() || p.second >= run.methods.size())
                throw InputError(file.string() + ": a pair names a method that is not there; run the shot again");
    } catch (const InputError&) {
        throw;
    } catch (const std::exception& e) {
        throw InputError(file.string() + ": damaged (" + e.what() + "); run the shot again");
    }
    return run;
}

}  // namespace aa
