#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/cli.h"
#include "image/error.h"
#include "methods/driver.h"
#include "shot/patterns.h"
#include "shot/reader.h"
#include "shot/synth/synth.h"

namespace aa {
namespace {

struct Options {
    std::vector<std::string> methods, families;
    std::string size = "1920x1080", shot, scene;
    int frames = 8, repeats = 3;
    bool json = false, markdown = false;
    WorkOptions work = {.threads = 1};
};

struct Row {
    std::string text;
    double nsMedian = 0, nsMin = 0, nsPerEdgePixel = 0, maxError = NAN, rmsError = NAN;
    size_t stateBytes = 0;
};

// The frames to time on, in the sampling that the methods read: of a shot, or of a synthetic scene.
struct Frames {
    std::vector<Frame> jittered, centre;
    ShotInfo info;
    std::string scene, subsamples;  // of the synthetic frames
    double edgeShare = 0;
    const std::vector<Frame>& of(const MethodSpec& m) const {
        return m.method->sampling() == Sampling::jittered ? jittered : centre;
    }
};
Frames shotFrames(const Options& o, const std::vector<MethodSpec>& methods) {
    const PassSet wanted = passesOf(methods, Sampling::jittered), wantedOfCentre = passesOf(methods, Sampling::centre);
    const ShotReader reader(o.shot);
    Frames r;
    r.info = shotInfo(reader.manifest());
    const size_t count = std::min(size_t(o.frames), reader.manifest().frames.size());
    for (size_t i = 0; i < count; i++) {
        if (!wanted.empty()) r.jittered.push_back(reader.read(i, wanted));
        if (wantedOfCentre.empty()) continue;
        r.centre.push_back(reader.hasCentreFrames() ? reader.readCentre(i, wantedOfCentre)
                                                    : reader.read(i, wantedOfCentre));
    }
    return r;
}
Frames synthFrames(const Options& o, const std::vector<MethodSpec>& methods, const std::string& scene,
                   const std::string& pattern) {
    const PassSet wanted = passesOf(methods, Sampling::jittered), wantedOfCentre = passesOf(methods, Sampling::centre);
    SynthOptions synth;
    synth.scene = scene;
    if (std::sscanf(o.size.c_str(), "%dx%d", &synth.width, &synth.height) != 2)
        throw UsageError("--size: expected WIDTHxHEIGHT, found '" + o.size + "'");
    synth.frames = o.frames;
    synth.subsamples = pattern;
    synth.subsampleColor = !pattern.empty() && passesOf(methods).has(Pass::subsampleColor);
    const SynthShot shot(synth);
    synth.jitter = "none";
    const SynthShot still(synth);
    Frames r;
    r.info = shotInfo(shot.manifest());
    r.info.isStatic = true;  // so that accum is timed as well; no method's speed depends on it
    r.scene = scene, r.subsamples = pattern;
    for (size_t i = 0; i < size_t(o.frames); i++) {
        if (!wanted.empty()) r.jittered.push_back(shot.frame(i));
        if (!wantedOfCentre.empty()) r.centre.push_back(still.frame(i));
    }
    return r;
}
// The synthetic frames' scene: discs have no edges that a pass could list.
std::string sceneFor(const Options& o, const MethodSpec& m) {
    const PassSet listed = Pass::edges | Pass::segments;
    const bool wantsEdges = !(m.passes().without(m.passes().without(listed))).empty();
    const std::string scene = !o.scene.empty() ? o.scene : wantsEdges ? "half_planes" : "moving";
    SynthOptions synth;
    synth.scene = scene, synth.width = synth.height = 8;
    if (wantsEdges && SynthShot(synth).passes().without(listed) == SynthShot(synth).passes())
        throw UsageError("--scene: " + scene + " has curved objects, and " + m.text +
                         " reads the edges of polygons; choose half_planes, or give a --shot");
    return scene;
}
// The synthetic frames' sub-sample pattern that serves a method: the first that it accepts.
std::string patternFor(const MethodSpec& m) {
    if (!m.passes().has(Pass::subsamples) && !m.passes().has(Pass::subsampleColor)) return "";
    std::string why;
    for (const char* pattern : {"d3d8", "d3d4", "d3d2", "d3d16"}) try {
            m.create({.width = 8,
                      .height = 8,
                      .jitterPeriod = 16,
                      .isStatic = true,
                      .frameCount = 16,
                      .subSamplePositionsPx = patternPositionsPx(pattern)});
            return pattern;
        } catch (const std::runtime_error& e) {
            why = e.what();
        }
    throw UsageError(why);
}

// Seconds of this thread's processor, which other programs on the machine cannot lengthen; with several threads only
// the wall clock counts them all.
double seconds(const Exec& exec) {
    if (exec.parallel)
        return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

// Share of the pixels whose encoded luma differs by 0.1 or more (SMAA's threshold at HIGH) from the pixel to the left
// or above.
double edgeShare(const std::vector<Frame>& frames) {
    double edges = 0, pixels = 0;
    for (const auto& f : frames) {
        const auto luma = [&](int x, int y) {
            const auto& c = f.colorEncoded.c;
            return 0.2126f * c[0].at(x, y) + 0.7152f * c[1].at(x, y) + 0.0722f * c[2].at(x, y);
        };
        for (int y = 0; y < f.height; y++)
            for (int x = 0; x < f.width; x++, pixels++) {
                const float l = luma(x, y);
                edges += std::abs(l - luma(x - 1, y)) >= 0.1f || std::abs(l - luma(x, y - 1)) >= 0.1f;
            }
    }
    return edges / std::max(pixels, 1.0);
}

// The first pass over the frames is not timed: it allocates, and the first touch of a page costs as much as a method.
// Nor is a frame that drops the history: it costs less than the others.
Row time(const MethodSpec& spec, const Frames& all, const Exec& exec, int repeats) {
    Row row{.text = spec.text};
    const std::vector<Frame>& frames = all.of(spec);
    const double pixels = double(all.info.width) * all.info.height;
    std::vector<double> ns;
    const auto method = spec.create(all.info);
    Rgb out(all.info.width, all.info.height);
    for (int r = 0; r <= repeats; r++)
        for (size_t i = 0; i < frames.size(); i++) {
            const double start = seconds(exec);
            method->resolve(frames[i], exec, out);
            const double took = seconds(exec) - start;
            if (r > 0 && (i > 0 || !spec.method->temporal || frames.size() == 1)) ns.push_back(took * 1e9 / pixels);
        }
    row.stateBytes = method->stateBytes();
    std::sort(ns.begin(), ns.end());
    row.nsMedian = ns[ns.size() / 2];
    row.nsMin = ns.front();
    row.nsPerEdgePixel = all.edgeShare > 0 ? row.nsMedian / all.edgeShare : NAN;
    return row;
}

// Largest and root-mean-square difference from the double form, over all frames.
void compareWithDouble(Row& row, const MethodSpec& spec, const std::vector<Frame>& frames, const ShotInfo& info,
                       const Exec& exec) {
    RunningMethod lanes(spec, info), oracle(spec, info);
    Exec exact = exec;
    exact.precision = Precision::oracle;
    double sum = 0, largest = 0, count = 0;
    for (const auto& f : frames) {
        lanes.resolve(f, {}, exec);
        oracle.resolve(f, {}, exact);
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < f.height; y++)
                for (int x = 0; x < f.width; x++, count++) {
                    const double d = double(lanes.out.c[c].at(x, y)) - double(oracle.out.c[c].at(x, y));
                    sum += d * d;
                    largest = std::max(largest, std::fabs(d));
                }
    }
    row.maxError = largest;
    row.rmsError = std::sqrt(sum / count);
}

// In float planes of the image's size, the unit of docs/precision.md.
double statePlanes(const Row& row, const ShotInfo& info) {
    return double(row.stateBytes) / double(PlaneF(info.width, info.height).bytes());
}
void printHead(const Options& o, const Frames& f, const Exec& exec) {
    if (o.json) return;
    const size_t count = std::max(f.jittered.size(), f.centre.size());
    if (o.markdown) {  // only what is the same on every machine
        std::printf(
            "# Precision and memory\n\nGenerated by `aaresolve bench --markdown` (`make docs`); do not edit. %zu "
            "frames of "
            "%dx%d: float lanes against the\ndouble form of the same text, largest and root-mean-square difference in "
            "the "
            "method's output space (scalar float equals the\nlanes bit by bit). State: everything that a method keeps "
            "between frames, history and scratch, in float planes of the\npicture's size; an RGBA history of two "
            "frames is "
            "8.\n\n| method | state, planes | max error | rms error |\n|---|---:|---:|---:|\n",
            count, f.info.width, f.info.height);
        return;
    }
    std::printf(
        "%s, %dx%d, %zu frames, %.1f %% edge pixels, %s, threads %d, %s\n%-32s %9s %9s %9s %9s %9s %7s %12s %12s\n",
        (o.shot.empty() ? f.scene : o.shot).c_str(), f.info.width, f.info.height, count, 100 * f.edgeShare,
        std::string(name(exec.isa)).c_str(), o.work.threads, exec.parallel ? "wall clock" : "processor time", "method",
        "ns/px", "min", "ns/edge", "ms", "state MB", "planes", "max error", "rms error");
}
void printRow(const Options& o, const Row& row, const ShotInfo& info) {
    if (o.json) return;
    const double planes = statePlanes(row, info), ms = row.nsMedian * 1e-6 * info.width * info.height;
    if (o.markdown)
        std::printf("| `%s` | %.1f | %.2g | %.2g |\n", row.text.c_str(), planes, row.maxError, row.rmsError);
    else
        std::printf("%-32s %9.2f %9.2f %9.1f %9.3f %9.2f %7.1f %12.3g %12.3g\n", row.text.c_str(), row.nsMedian,
                    row.nsMin, row.nsPerEdgePixel, ms, double(row.stateBytes) / (1 << 20), planes, row.maxError,
                    row.rmsError);
    std::fflush(stdout);
}

std::vector<MethodSpec> chosen(const Options& o) {
    std::vector<MethodSpec> specs;
    for (const auto& text : o.methods) specs.push_back(parseMethod(text));
    for (const auto& family : o.families) {
        const size_t before = specs.size();
        for (const auto& m : registry())
            if (m.family == family) specs.push_back(parseMethod(m.id));
        if (specs.size() == before)
            throw UsageError("--family: no method is of the family '" + family + "'; `aaresolve list` shows all");
    }
    if (specs.empty()) throw UsageError("bench: expected at least one -m METHOD or --family FAMILY, found none");
    return specs;
}

void execute(const Options& o) {
    const std::vector<MethodSpec> specs = chosen(o);
    const Exec exec = o.work.exec();
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    withThreads(o.work.threads, [&] {
        // Frames with many sub-samples are large: one pattern's are in memory at a time.
        std::optional<Frames> frames;
        for (size_t k = 0; k < specs.size(); k++) {
            const MethodSpec& spec = specs[k];
            const bool synthetic = o.shot.empty();
            const std::string pattern = synthetic ? patternFor(spec) : "", scene = synthetic ? sceneFor(o, spec) : "";
            if (!frames || (synthetic && (frames->subsamples != pattern || frames->scene != scene))) {
                frames.reset();
                frames = synthetic ? synthFrames(o, specs, scene, pattern) : shotFrames(o, specs);
                for (auto* sampled : {&frames->jittered, &frames->centre})
                    for (auto& f : *sampled) encodeFrame(f, {}, exec);
                frames->edgeShare = edgeShare(frames->centre.empty() ? frames->jittered : frames->centre);
            }
            const ShotInfo& info = frames->info;
            if (k == 0) printHead(o, *frames, exec);
            Row row = time(spec, *frames, exec, o.repeats);
            compareWithDouble(row, spec, frames->of(spec), info, exec);
            printRow(o, row, info);
            all.push_back({{"method", row.text},
                           {"nsPerPixel", row.nsMedian},
                           {"nsPerPixelMin", row.nsMin},
                           {"nsPerEdgePixel", row.nsPerEdgePixel},
                           {"edgeShare", frames->edgeShare},
                           {"stateBytes", row.stateBytes},
                           {"maxError", row.maxError},
                           {"rmsError", row.rmsError}});
        }
    });
    if (o.json) std::cout << all.dump(1) << "\n";
}

}  // namespace

void addBench(CommandLine& line, Context&) {
    auto o = std::make_shared<Options>();
    Command c = line.command("bench", "Speed and memory of methods, and their error against the double form");
    c.option("-m,--method", o->methods, "methods to time, noaa first as the baseline").oneEach();
    c.option("--family", o->families, "time every method of a family: reference, spatial, geometry, temporal")
        .oneEach();
    c.option("--size", o->size, "size of the synthetic frames, px");
    c.option("--shot", o->shot, "time on this shot's frames instead of synthetic ones");
    c.option("--scene", o->scene,
             "synthetic scene (`synth --list`); default moving, half_planes for methods that read edges")
        .excludes("--shot");
    c.option("--frames", o->frames, "frames in memory").range(1, 64);
    c.option("--repeats", o->repeats, "passes over the frames").range(1, 100);
    c.flag("--json", o->json, "as JSON");
    c.flag("--markdown", o->markdown, "a table of memory and errors, the same on every machine").excludes("--json");
    addWorkOptions(c, o->work);
    c.run([o] { execute(*o); });
}

}  // namespace aa
