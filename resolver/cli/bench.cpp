#include <algorithm>
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
    std::string size = "1920x1080", shot;
    int frames = 8, repeats = 3;
    bool json = false;
    WorkOptions work = {.threads = 1};
};

struct Row {
    std::string text;
    double nsMedian = 0, nsMin = 0, maxError = NAN, rmsError = NAN;
    size_t stateBytes = 0;
};

// The frames to time on, in the sampling that the methods read: of a shot, or of the synthetic scene `moving`.
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
        synth.scene = "moving";
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

Row time(const MethodSpec& spec, const std::vector<Frame>& frames, const ShotInfo& info, const Exec& exec,
         int repeats) {
    Row row{.text = spec.text};
    const double pixels = double(info.width) * info.height;
    std::vector<double> ns;
    for (int r = 0; r < repeats; r++) {
        RunningMethod running(spec, info);
        for (size_t i = 0; i < frames.size(); i++) {
            const double seconds = running.resolve(frames[i], {}, exec);
            if (i > 0 || frames.size() == 1)
                ns.push_back(seconds * 1e9 / pixels);  // the first frame fills caches and history
        }
        row.stateBytes = running.method->stateBytes();
    }
    std::sort(ns.begin(), ns.end());
    row.nsMedian = ns[ns.size() / 2];
    row.nsMin = ns.front();
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
        if (!o.json)
            std::printf("%dx%d, %zu frames, %s, threads %d\n%-32s %9s %9s %9s %9s %12s %12s\n", info.width, info.height,
                        std::max(frames.jittered.size(), frames.centre.size()), std::string(name(exec.isa)).c_str(),
                        o.work.threads, "method", "ns/px", "min", "ms", "state MB", "max error", "rms error");
        for (const auto& spec : specs) {
            Row row = time(spec, frames.of(spec), info, exec, o.repeats);
            compareWithDouble(row, spec, frames.of(spec), info, exec);
            const double ms = row.nsMedian * 1e-6 * info.width * info.height;
            if (!o.json)
                std::printf("%-32s %9.2f %9.2f %9.3f %9.2f %12.3g %12.3g\n", row.text.c_str(), row.nsMedian, row.nsMin,
                            ms, double(row.stateBytes) / (1 << 20), row.maxError, row.rmsError);
            all.push_back({{"method", row.text},
                           {"nsPerPixel", row.nsMedian},
                           {"nsPerPixelMin", row.nsMin},
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
    c->add_option("--frames", o->frames, "frames in memory")->check(CLI::Range(1, 64));
    c->add_option("--repeats", o->repeats, "passes over the frames")->check(CLI::Range(1, 100));
    c->add_flag("--json", o->json, "as JSON");
    addWorkOptions(*c, o->work);
    c->callback([o] { execute(*o); });
}

}  // namespace aa
