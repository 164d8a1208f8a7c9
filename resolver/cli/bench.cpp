#include <time.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/cli.h"
#include "cli/runner.h"
#include "image/error.h"
#include "shot/synth.h"

namespace aa {
namespace {

struct Options {
    std::vector<std::string> methods;
    std::string size = "1920x1080", shot, scene = "moving";
    int frames = 8, repeats = 3;
    bool json = false;
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
    const std::vector<Frame>& of(const MethodSpec& m) const {
        return m.method->sampling() == Sampling::jittered ? jittered : centre;
    }
};
Frames framesFor(const Options& o, const std::vector<MethodSpec>& methods, const Exec& exec) {
    const PassSet wanted = passesOf(methods, Sampling::jittered), wantedOfCentre = passesOf(methods, Sampling::centre);
    Frames r;
    if (!o.shot.empty()) {
        const ShotReader reader(o.shot);
        r.info = shotInfo(reader.manifest());
        const size_t count = std::min(size_t(o.frames), reader.manifest().frames.size());
        for (size_t i = 0; i < count; i++) {
            if (!wanted.empty()) r.jittered.push_back(reader.read(i, wanted));
            if (wantedOfCentre.empty()) continue;
            r.centre.push_back(reader.hasCentreFrames() ? reader.readCentre(i, wantedOfCentre)
                                                        : reader.read(i, wantedOfCentre));
        }
    } else {
        SynthOptions synth;
        synth.scene = o.scene;
        if (std::sscanf(o.size.c_str(), "%dx%d", &synth.width, &synth.height) != 2)
            throw UsageError("--size: expected WIDTHxHEIGHT, found '" + o.size + "'");
        synth.frames = o.frames;
        synth.subsamples = "d3d8";
        const SynthShot shot(synth);
        synth.jitter = "none";
        const SynthShot still(synth);
        r.info = shotInfo(shot.manifest());
        r.info.isStatic = true;  // so that accum is timed as well; no method's speed depends on it
        for (size_t i = 0; i < size_t(o.frames); i++) {
            if (!wanted.empty()) r.jittered.push_back(shot.frame(i));
            if (!wantedOfCentre.empty()) r.centre.push_back(still.frame(i));
        }
    }
    for (auto* frames : {&r.jittered, &r.centre})
        for (auto& f : *frames) encode(f.colorLinear, {}, exec, f.colorEncoded);
    return r;
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

// Seconds on one thread: of its processor time, which other programs on the machine do not lengthen. On several: of
// wall time.
double secondsNow(bool oneThread) {
    if (!oneThread) return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}
// The first pass over the frames is not timed: it allocates, and the first touch of a page costs as much as a method.
Row time(const MethodSpec& spec, const std::vector<Frame>& frames, const ShotInfo& info, const Exec& exec,
         bool oneThread, int repeats, double share) {
    Row row{.text = spec.text};
    const double pixels = double(info.width) * info.height;
    std::vector<double> ns;
    const auto method = spec.create(info);
    Rgb out(info.width, info.height);
    for (int r = 0; r <= repeats; r++)
        for (const Frame& frame : frames) {
            const double start = secondsNow(oneThread);
            method->resolve(frame, exec, out);
            if (r > 0) ns.push_back((secondsNow(oneThread) - start) * 1e9 / pixels);
        }
    row.stateBytes = method->stateBytes();
    std::sort(ns.begin(), ns.end());
    row.nsMedian = ns[ns.size() / 2];
    row.nsMin = ns.front();
    row.nsPerEdgePixel = share > 0 ? row.nsMedian / share : NAN;
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

void execute(const Options& o) {
    std::vector<MethodSpec> specs;
    for (const auto& text : o.methods) specs.push_back(parseMethod(text));
    const Exec exec = o.work.exec();
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    withThreads(o.work.threads, [&] {
        const Frames frames = framesFor(o, specs, exec);
        const ShotInfo& info = frames.info;
        const double share = edgeShare(frames.centre.empty() ? frames.jittered : frames.centre);
        if (!o.json)
            std::printf(
                "%s, %dx%d, %zu frames, %.1f %% edge pixels, %s, threads %d\n%-32s %9s %9s %9s %9s %9s %12s %12s\n",
                (o.shot.empty() ? o.scene : o.shot).c_str(), info.width, info.height,
                std::max(frames.jittered.size(), frames.centre.size()), 100 * share,
                std::string(name(exec.isa)).c_str(), o.work.threads, "method", "ns/px", "min", "ns/edge", "ms",
                "state MB", "max error", "rms error");
        for (const auto& spec : specs) {
            Row row = time(spec, frames.of(spec), info, exec, o.work.threads == 1, o.repeats, share);
            compareWithDouble(row, spec, frames.of(spec), info, exec);
            const double ms = row.nsMedian * 1e-6 * info.width * info.height;
            if (!o.json)
                std::printf("%-32s %9.2f %9.2f %9.1f %9.3f %9.2f %12.3g %12.3g\n", row.text.c_str(), row.nsMedian,
                            row.nsMin, row.nsPerEdgePixel, ms, double(row.stateBytes) / (1 << 20), row.maxError,
                            row.rmsError);
            all.push_back({{"method", row.text},
                           {"nsPerPixel", row.nsMedian},
                           {"nsPerPixelMin", row.nsMin},
                           {"nsPerEdgePixel", row.nsPerEdgePixel},
                           {"edgeShare", share},
                           {"stateBytes", row.stateBytes},
                           {"maxError", row.maxError},
                           {"rmsError", row.rmsError}});
        }
    });
    if (o.json) std::cout << all.dump(1) << "\n";
}

}  // namespace

void addBench(CLI::App& app, Context&) {
    auto o = std::make_shared<Options>();
    auto* c = app.add_subcommand("bench", "Speed and memory of methods, and their error against the double form");
    c->add_option("-m,--method", o->methods, "methods to time, noaa first as the baseline")
        ->required()
        ->allow_extra_args(false);
    c->add_option("--size", o->size, "size of the synthetic frames, px");
    c->add_option("--shot", o->shot, "time on this shot's frames instead of synthetic ones");
    c->add_option("--scene", o->scene, "synthetic scene (`synth --list`); clutter has the edges of a rendered frame")
        ->excludes("--shot");
    c->add_option("--frames", o->frames, "frames in memory")->check(CLI::Range(1, 64));
    c->add_option("--repeats", o->repeats, "passes over the frames")->check(CLI::Range(1, 100));
    c->add_flag("--json", o->json, "as JSON");
    addWorkOptions(*c, o->work);
    c->callback([o] { execute(*o); });
}

}  // namespace aa
