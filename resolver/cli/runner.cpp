#include "cli/runner.h"

#include <tbb/global_control.h>

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <sstream>

#include "cli/cli.h"
#include "image/error.h"
#include "image/io.h"
#include "metrics/temporal.h"
#include "shot/frame_stream.h"
#include "shot/manifest.h"

namespace aa {
namespace fs = std::filesystem;
namespace {

std::string frameName(int frame, const char* extension) {
    char text[32];
    std::snprintf(text, sizeof text, "%06d%s", frame, extension);
    return text;
}

// All of `asked`, or nothing: the figures along the motion need every one of them.
PassSet passesThatAreThere(PassSet asked, PassSet offered) {
    return asked.without(offered).empty() ? asked : PassSet{};
}

RunResults describeRun(const Manifest& m, const RunOptions& o) {
    RunResults r;
    r.shot = m.name;
    r.width = m.width;
    r.height = m.height;
    r.isStatic = m.isStatic;
    r.jitterSequence = m.jitterSequence;
    r.jitterStart = m.jitterStart;
    r.jitterPeriod = m.jitterPeriod;
    const size_t period = std::min(m.frames.size(), size_t(std::max(m.jitterPeriod, 1)));
    for (size_t i = 0; i < period; i++) {
        r.jitterMeanPx[0] += m.frames[i].jitterPx.x / double(period);
        r.jitterMeanPx[1] += m.frames[i].jitterPx.y / double(period);
    }
    r.subSamples = int(m.subsamplePositionsPx.size());
    r.truthSamplesPerHalf = m.truthSamplesPerHalf;
    r.truthFilter = m.truthFilter;
    r.truthFilterWidthPx = m.truthFilterWidthPx;
    r.programVersion = AA_VERSION;
    r.isa = name(o.exec.isa);
    r.precision = o.exec.precision == Precision::fast     ? "fast"
                  : o.exec.precision == Precision::scalar ? "scalar"
                                                          : "double";
    r.machine = machineName();
    r.threads =
        o.exec.parallel ? int(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism)) : 1;
    r.protocol = o.protocol;
    std::map<std::string, int> counted;
    for (const auto& f : m.frames)
        for (const auto& [group, seconds] : f.renderSeconds) r.renderSeconds[group] += seconds, counted[group]++;
    for (auto& [group, seconds] : r.renderSeconds) seconds /= counted[group];
    for (const auto& spec : o.methods) {
        MethodResult result;
        result.id = spec.method->id;
        result.text = spec.text;
        result.title = spec.method->title;
        result.family = spec.method->family;
        result.source = spec.method->source;
        result.folder = spec.folderName();
        const bool unjittered =
            std::all_of(m.frames.begin(), m.frames.end(), [](const auto& f) { return f.jitterPx == glm::dvec2(0.0); });
        const bool centre = unjittered || (spec.method->sampling() == Sampling::centre && !m.frames[0].centre.empty());
        result.sampling = centre ? "centre" : "jittered";
        const Params params = spec.params();
        result.parameters.insert(params.all().begin(), params.all().end());
        for (auto n : names(spec.passes())) result.passes.emplace_back(n);
        r.methods.push_back(std::move(result));
    }
    return r;
}

// Squared error where history was rejected, of every method that rejects and keeps the mask (one with a fill) and of
// its peers without or with another fill: they reject the same pixels.
void judgeRejected(const std::vector<RunningMethod>& methods, const Rgb& truthEncoded,
                   std::vector<MethodResult>& results) {
    const auto base = [](const RunningMethod& m) { return withoutStages(m.spec.text); };
    for (size_t k = 0; k < methods.size(); k++) {
        const auto peer = std::find_if(methods.begin(), methods.end(), [&](const auto& m) {
            return m.method->rejection() && base(m) == base(methods[k]);
        });
        if (peer == methods.end()) continue;
        const PlaneF& mask = *peer->method->rejection();
        FrameSum sum;
        for (int y = 0; y < mask.height(); y++)
            for (int x = 0; x < mask.width(); x++)
                if (mask.at(x, y) != 0)
                    for (size_t c = 0; c < 3; c++, sum.count++) {
                        const double e =
                            double(methods[k].outEncoded.c[c].at(x, y)) - double(truthEncoded.c[c].at(x, y));
                        sum.sum += e * e;
                    }
        results[k].frames.back().rejected = sum;
    }
}

// Writes one method's image of one frame; returns the path relative to the run's folder.
std::string writeImage(const RunningMethod& m, int frame, const RunOptions& o) {
    const fs::path folder = m.spec.folderName();
    std::string written;
    if (o.writePng) {
        written = (folder / frameName(frame, ".png")).string();
        writePng(o.out / written, m.outEncoded);
    }
    if (o.writeExr) {
        written = (folder / frameName(frame, ".exr")).string();
        const DisplayChain& display = o.protocol.display;
        if (m.spec.outputSpace() == Space::linear && display.transfer != Transfer::identity) {
            writeExr(o.out / written, m.out, false);
        } else {
            Rgb linear;
            decode(m.out, display, o.exec, linear);
            writeExr(o.out / written, linear, true);
        }
    }
    if (o.debugLayers)
        if (const auto layers = m.method->debugLayers(); !layers.empty())
            writeLayers(o.out / folder / frameName(frame, ".layers.exr"), layers);
    return written;
}

// ---- a full history ----
constexpr size_t kHistoryPeriods = 10;  // decisions 13

std::vector<MethodSpec> withHistory(const std::vector<MethodSpec>& methods) {
    std::vector<MethodSpec> chosen;
    for (const auto& m : methods)
        if (m.method->wantsHistory()) chosen.push_back(m);
    return chosen;
}
// Whole passes over the frames before the judged one.
size_t warmUpPasses(const RunOptions& o, const Manifest& m) {
    if (o.protocol.history != History::full || o.frames.empty() || withHistory(o.methods).empty()) return 0;
    const size_t frames = kHistoryPeriods * size_t(std::max(m.jitterPeriod, 1));
    return (frames + o.frames.size() - 1) / o.frames.size();
}
// Frames of an earlier pass keep their parity, which tells methods with two sets of sub-samples apart, and get numbers
// that no frame of another pass has: they seed noise.
int numberInPass(int number, size_t passesLeft, const RunOptions& o, const Manifest& m) {
    const int count = m.frames[o.frames.back()].frame - m.frames[o.frames.front()].frame + 1;
    return number + int(passesLeft) * (count + count % 2);
}
// Runs the methods that accumulate over the frames again and again, without a judge. Returns the camera of the last
// frame.
std::optional<Camera> warmUp(const ShotReader& shot, const RunOptions& o, std::vector<RunningMethod>& methods,
                             size_t passes, Progress& progress) {
    std::vector<size_t> frames;
    for (size_t pass = 0; pass < passes; pass++) frames.insert(frames.end(), o.frames.begin(), o.frames.end());
    FrameStream stream(shot, frames, passesOf(withHistory(o.methods)));
    std::optional<Camera> before;
    for (size_t i = 0; auto frame = stream.next(); i++) {
        const size_t pass = i / o.frames.size();
        const int number = frame->number;
        if (i % o.frames.size() == 0) {
            frame->reset = pass == 0;
            if (pass > 0) frame->previousCamera = before;
        }
        frame->number = numberInPass(number, passes - pass, o, shot.manifest());
        before = frame->camera;
        prepareFrame(*frame, methods, o.protocol.display, o.exec);
        for (auto& m : methods)
            if (m.spec.method->wantsHistory()) m.resolve(*frame, frame->display, o.exec);
        progress.step("warm-up " + std::to_string(pass + 1) + "/" + std::to_string(passes) + " frame " +
                      std::to_string(number));
        if (progress.interrupted()) break;
    }
    return before;
}

}  // namespace

std::vector<std::string> applyHistory(RunOptions& o, const Manifest& manifest) {
    if (o.protocol.history == History::full && !manifest.isStatic)
        throw UsageError("--history full: '" + manifest.name +
                         "' moves, and only the frames of a static shot can be repeated; choose first or ramp");
    std::vector<std::string> without;
    if (o.protocol.history != History::ramp) return without;
    for (auto& spec : o.methods) {
        const auto& table = spec.method->params;
        const auto named = [](const auto& p) { return p.first == "warmup"; };
        if (std::none_of(table.begin(), table.end(), [](const auto& p) { return p.name == "warmup"; })) {
            if (spec.method->temporal) without.push_back(spec.text);
        } else if (std::none_of(spec.given.begin(), spec.given.end(), named)) {
            spec.given.emplace_back("warmup", "ramp");
        }
    }
    return without;
}

size_t stepsOf(const RunOptions& o, const Manifest& m) { return o.frames.size() * (1 + warmUpPasses(o, m)); }

void requirePasses(const ShotReader& shot, const std::vector<MethodSpec>& methods) {
    const PassSet jittered = shot.offered();
    const PassSet centre = shot.hasCentreFrames() ? shot.offered(Sampling::centre) : jittered;
    for (const auto& m : methods)
        if (const auto missing =
                names(m.passes().without(m.method->sampling() == Sampling::centre ? centre : jittered));
            !missing.empty()) {
            std::string all;
            for (const auto& s : methods) all += (all.empty() ? "" : ",") + std::string(s.method->id);
            throw InputError(shot.manifest().folder.string() + ": method '" + m.text + "' needs the pass '" +
                             std::string(missing[0]) + "', which the shot does not have; export again with --for " +
                             all);
        }
}

std::vector<size_t> selectFrames(const Manifest& manifest, const std::string& list) {
    std::vector<size_t> chosen;
    if (list.empty()) {
        for (size_t i = 0; i < manifest.frames.size(); i++) chosen.push_back(i);
        return chosen;
    }
    std::vector<bool> wanted(manifest.frames.size());
    std::istringstream parts(list);
    for (std::string part; std::getline(parts, part, ',');) {
        int first = 0, last = 0;
        const char* end = part.data() + part.size();
        auto [p, failed] = std::from_chars(part.data(), end, first);
        last = first;
        if (failed == std::errc{} && p != end && *p == '-') {
            const auto second = std::from_chars(p + 1, end, last);
            p = second.ptr;
            failed = second.ec;
        }
        if (failed != std::errc{} || p != end || last < first)
            throw UsageError("--frames: expected numbers and ranges like 1-16,20, found '" + part + "'");
        size_t found = 0;
        for (size_t i = 0; i < manifest.frames.size(); i++)
            if (manifest.frames[i].frame >= first && manifest.frames[i].frame <= last) wanted[i] = true, found++;
        if (found == 0)
            throw InputError("--frames " + part + ": the shot has no such frame (it has " +
                             std::to_string(manifest.frames.front().frame) + " to " +
                             std::to_string(manifest.frames.back().frame) + ")");
    }
    for (size_t i = 0; i < wanted.size(); i++)
        if (wanted[i]) chosen.push_back(i);
    return chosen;
}

RunResults run(const ShotReader& shot, const RunOptions& o, Progress& progress) {
    std::vector<TileErrors> errors;
    RunResults results = runMethods(shot, o, progress, errors);
    finish(results, errors);
    writeResults(results, o.out);
    return results;
}

RunResults runMethods(const ShotReader& shot, const RunOptions& o, Progress& progress,
                      std::vector<TileErrors>& errors) {
    const Manifest& manifest = shot.manifest();
    requirePasses(shot, o.methods);
    std::vector<RunningMethod> methods;
    for (const auto& spec : o.methods) {
        methods.emplace_back(spec, shotInfo(manifest));
        methods.back().method->keepDebugLayers = o.debugLayers;
    }
    makeWritableFolder(o.out);
    for (const auto& m : methods) makeWritableFolder(o.out / m.spec.folderName());
    makeWritableFolder(o.out / "truth");

    RunResults results = describeRun(manifest, o);
    errors.assign(methods.size(), {});
    double noise = 0;
    size_t withTruth = 0;
    // A static shot has one truth for all its frames: decoded and encoded once.
    std::optional<Reference> reference;
    std::shared_ptr<const Truth> truth;

    // Methods that accumulate read the jittered frames, all others the centre-sampled ones where the shot has them.
    const bool split = shot.hasCentreFrames();
    PassSet wanted = split ? passesOf(o.methods, Sampling::jittered) : passesOf(o.methods);
    const PassSet wantedOfCentre = split ? passesOf(o.methods, Sampling::centre) : PassSet{};
    // A sequence is also judged over time, along the motion where the shot knows it.
    const bool judgeTime = o.frames.size() > 1 && !passesOf(o.methods, Sampling::jittered).empty();
    if (judgeTime && !manifest.isStatic) wanted |= passesThatAreThere(temporalMetricPasses(), shot.offered());
    TemporalScene scene(manifest.isStatic);
    std::vector<TemporalJudge> judges(methods.size(), TemporalJudge(temporalWarmup(o.frames.size())));
    const size_t passes = warmUpPasses(o, manifest);
    std::optional<Camera> before;
    if (passes > 0) before = warmUp(shot, o, methods, passes, progress);
    results.warmUpFrames = passes * o.frames.size();
    if (progress.interrupted()) return results;
    FrameStream stream(shot, o.frames, wanted, /*withTruth=*/true, wantedOfCentre);
    const DisplayChain& display = o.protocol.display;
    std::shared_ptr<Frame> centreFrame;  // of the last frame; shared by those of a static shot, and prepared once
    for (size_t i = 0; auto frame = stream.next(); i++) {
        if (i == 0) {
            frame->reset = passes == 0;  // a sequence may start in the middle
            if (passes > 0) frame->previousCamera = before;
        }
        prepareFrame(*frame, methods, display, o.exec);
        if (stream.centre() && stream.centre() != centreFrame) prepareFrame(*stream.centre(), methods, display, o.exec);
        centreFrame = stream.centre();
        if (stream.truth() != truth) {
            truth = stream.truth();
            reference.reset();
            if (truth) {
                reference = makeReference(truth->a, truth->b, display, o.exec, o.protocol.eightBit);
                if (display.transfer == Transfer::identity) {
                    auto& clipped = results.truthClipped ? *results.truthClipped : results.truthClipped.emplace();
                    clipped.pixels += reference->clippedPixels;
                    clipped.of += size_t(manifest.width) * size_t(manifest.height);
                }
            }
        }
        const bool write = o.writeAllFrames || (reference && (!manifest.isStatic || i + 1 == o.frames.size()));
        if (write && reference) {
            const std::string file = (fs::path("truth") / frameName(frame->number, ".exr")).string();
            writeExr(o.out / file, reference->linear, display.transfer == Transfer::identity);
            results.truthImages[frame->number] = file;
        }
        if (reference) noise += reference->noise, withTruth++;
        if (judgeTime) scene.advance(*frame, reference ? &reference->encoded : nullptr, o.exec);
        // A static shot is judged at its last frame, as the published protocol does: there every history is longest.
        if (manifest.isStatic) errors.assign(methods.size(), {});
        for (size_t k = 0; k < methods.size(); k++) {
            FrameResult result;
            result.frame = frame->number;
            const bool centre = split && methods[k].spec.method->sampling() == Sampling::centre;
            const Frame& input = centre ? *stream.centre() : *frame;
            result.seconds = methods[k].resolve(input, input.display, o.exec);
            if (o.protocol.eightBit) quantise8(methods[k].outEncoded, o.exec);
            if (reference) {
                const bool linear = methods[k].spec.outputSpace() == Space::linear;
                result.metrics = measure(methods[k].outEncoded, linear ? &methods[k].out : nullptr, *reference,
                                         o.measure, o.exec, errors[k]);
            }
            if (judgeTime) {
                judges[k].add(scene, methods[k].outEncoded, o.exec);
                if (int(i) >= temporalWarmup(o.frames.size())) result.temporal = judges[k].latest();
            }
            if (write) result.image = writeImage(methods[k], frame->number, o);
            auto& done = results.methods[k].frames;
            if (manifest.isStatic && !done.empty()) done.back().judged = false;
            done.push_back(std::move(result));
            results.methods[k].stateBytes = std::max(results.methods[k].stateBytes, methods[k].method->stateBytes());
        }
        if (judgeTime && reference && !frame->reset) judgeRejected(methods, reference->encoded, results.methods);
        progress.step("frame " + std::to_string(frame->number));
        if (progress.interrupted()) break;
    }
    // Of a truth with one half only (an imported render) nobody knows the noise.
    if (const auto t = manifest.extra.find("truth");
        withTruth > 0 && !(t != manifest.extra.end() && t->value("halves", 2) == 1))
        results.truthNoise = noise / double(withTruth);
    if (const SanitiseCounts& n = stream.counts(); n.total() > 0)
        results.sanitised = {
            {"colourNan", n.colourNan}, {"colourInf", n.colourInf}, {"colourNegative", n.colourNegative},
            {"depth", n.depth},         {"normal", n.normal},       {"motion", n.motion},
            {"edges", n.edges},         {"segments", n.segments}};
    for (size_t k = 0; judgeTime && k < methods.size(); k++) {
        results.methods[k].temporal = judges[k].result();
        if (passes > 0) results.methods[k].temporal->convergence.reset();  // it counts from the start of the history
    }
    return results;
}

}  // namespace aa
