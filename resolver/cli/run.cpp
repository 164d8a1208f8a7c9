#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "cli/choose.h"
#include "cli/cli.h"
#include "cli/run_arguments.h"
#include "image/error.h"
#include "image/folder_claim.h"
#include "image/io.h"
#include "report/advice.h"
#include "report/format.h"
#include "report/gallery.h"
#include "study/megabyte.h"
#include "study/prepare.h"

namespace aa {
namespace {

struct RunCommandArguments {
    RunArguments run;
    std::vector<std::string> methods;
    bool resume = false, add = false;
    bool debugLayers = false, overFrames = false, withoutBaseline = false;
    std::string trace;  // a file
};
constexpr const char* kBaseline = "noaa";
std::vector<const MethodResult*> bestFirst(const RunResults& r) {
    std::vector<const MethodResult*> rows;
    for (const auto& m : r.methods) rows.push_back(&m);
    std::stable_sort(rows.begin(), rows.end(), [](const auto* a, const auto* b) {
        return (a->pooled ? a->pooled->mean.mse : INFINITY) < (b->pooled ? b->pooled->mean.mse : INFINITY);
    });
    return rows;
}
constexpr const char* kFlip = "flip";
// The figures that the table before has no column for; and where those that need a viewer were seen.
void printOthers(const RunResults& r, const std::vector<const MethodResult*>& rows, size_t width) {
    std::vector<const Figure*> asked;
    for (const Figure* f : figuresIn(r))
        if (!findFigure(f->name).metric->always && f->name != kFlip) asked.push_back(f);
    if (asked.empty()) return;
    std::printf("%-*s", int(width), "method");
    for (const Figure* f : asked) std::printf(" %*s", std::max(10, int(f->name.size())), std::string(f->name).c_str());
    std::puts("");
    for (const auto* m : rows) {
        if (!m->pooled) continue;
        std::printf("%-*s", int(width), m->text.c_str());
        for (const Figure* f : asked) {
            const auto value = m->pooled->mean.figure(f->name);
            std::printf(" %*s", std::max(10, int(f->name.size())), value ? shown(*f, *value).c_str() : "-");
        }
        std::puts("");
    }
    if (r.shownOn)
        std::printf("JOD as seen on %s; %g frames per second\n", r.shownOn->words.c_str(), r.shownOn->framesPerSecond);
    if (r.flipPixelsPerDegree) std::printf("FLIP as seen at %g pixels per degree\n", *r.flipPixelsPerDegree);
}
}  // namespace

void printReplaced(const RunResults& r, const std::filesystem::path& out) {
    if (!r.replacedMethods.empty())
        std::fprintf(stderr, "%s: removed the pictures of %s, which this run has not\n", out.c_str(),
                     enumerated(r.replacedMethods).c_str());
    for (const auto& file : r.outdatedFiles)
        std::fprintf(stderr, "%s: is of the earlier run; make it again\n", (out / file).c_str());
}

namespace {
// PSNR, the gain over noaa with its interval, SSIM and FLIP.
void printJudged(const RunResults& r, const MethodResult& m, bool withFlip) {
    const auto noaa = noaaOf(r);
    const auto index = size_t(&m - r.methods.data());
    const auto versus = !noaa || index == *noaa ? std::nullopt : compared(r, index, *noaa);
    if (r.isReference(m)) {
        std::printf(" %9s %8s", "reference", "-");
    } else if (m.pooled) {
        std::printf(" %9.3f", m.pooled->mean.psnr);
        if (m.pooled->gainDb)
            std::printf(" %+8.3f", *m.pooled->gainDb);
        else
            std::printf(" %8s", "-");
    } else {
        std::printf(" %9s %8s", "-", "-");
    }
    std::printf(" %16s %9s", versus ? intervalInWords(*versus).c_str() : "-",
                versus ? std::string(inShort(versus->why)).c_str() : "-");
    if (m.pooled)
        std::printf(" %8.6f", m.pooled->mean.others.at("ssimLuma"));
    else
        std::printf(" %8s", "-");
    if (!withFlip) return;
    const auto flip = m.pooled ? m.pooled->mean.figure(kFlip) : std::nullopt;
    flip ? std::printf(" %6.4f", *flip) : std::printf(" %6s", "-");
}
void printCost(const RunResults& r, const MethodResult& m) {
    if (m.nsPerPixel > 0) {
        const double perPixel = 1e9 / (double(r.width) * r.height);
        char spread[32];
        std::snprintf(spread, sizeof spread, "%.3g to %.3g", m.secondsLow * perPixel, m.secondsHigh * perPixel);
        std::printf(" %8.2f %13s", m.nsPerPixel, m.timings > 1 ? spread : "once");
    } else {
        std::printf(" %8s %13s", "-", "-");
    }
    std::printf(" %8.2f %8.2f", double(m.inputBytes) / kMegabyte, double(m.stateBytes) / kMegabyte);
    if (m.deviceSecondsMedian) std::printf(" %10.4f", 1e3 * *m.deviceSecondsMedian);
    std::puts("");
}
// Why there is no figure, and what one can do.
void sayWithoutFigures(const RunResults& r) {
    std::printf(
        "no figures%s: none of these frames has a ground truth; export the shot with its truth, or hold the methods "
        "against one of them by --reference METHOD",
        r.maps.empty() ? "" : " and no maps");
    if (!r.wroteAllFrames()) std::printf("; for their pictures %s", howToWriteAll(r).c_str());
    std::puts("");
}
}  // namespace

void printTable(const RunResults& r) {
    const auto rows = bestFirst(r);
    size_t width = 6;
    for (const auto* m : rows) width = std::max(width, m->text.size());
    const bool judged = r.hasFigures(), withFlip = judged && std::any_of(rows.begin(), rows.end(), [](const auto*m) {
                                                       return m->pooled && m->pooled->mean.figure(kFlip);
                                                   });
    std::printf("%-*s", int(width), "method");
    if (judged)
        std::printf(" %9s %8s %16s %9s %8s%s", "PSNR dB", "gain dB", "95 % interval", "resolved", "SSIM",
                    withFlip ? "   FLIP" : "");
    std::printf(" %8s %13s %8s %8s%s\n", "ns/px", "quartiles", "input MB", "state MB", r.device ? "  device ms" : "");
    for (const auto* m : rows) {
        std::printf("%-*s", int(width), m->text.c_str());
        if (judged) printJudged(r, *m, withFlip);
        printCost(r, *m);
    }
    if (!judged && r.complete) sayWithoutFigures(r);
    printOthers(r, rows, width);
    if (!r.complete)
        std::printf("%s: these figures are not those of the whole shot; the same command with --resume goes on\n",
                    incompleteInWords(r).c_str());
    if (r.device)
        std::printf("device: %s (%s), %s%s\n", r.device->name.c_str(), r.device->kind.c_str(),
                    r.device->precision.c_str(),
                    r.device->isSoftware() ? "; software on the processor, its times are no card's" : "");
    if (!r.protocol.reference.empty())
        std::printf("reference: %s, a method of this run and not the truth\n", r.protocol.reference.c_str());
    else if (r.truthNoise && *r.truthNoise == 0)
        std::puts("truth: exact");
    else if (r.truthNoise)
        std::printf("truth: %d samples per half, error bar of the MSE %.4g (PSNR %.2f dB)\n", r.truthSamplesPerHalf,
                    *r.truthNoise, psnr(*r.truthNoise));
    if (r.truthClipped)
        std::printf("truth: %zu of %zu pixels (%.3g %%) exceed the display and are clipped\n", r.truthClipped->pixels,
                    r.truthClipped->of, 100 * double(r.truthClipped->pixels) / double(r.truthClipped->of));
    if (!r.pairs.empty() && noaaOf(r))
        std::puts(
            "gain: over noaa; resolved: whether the interval excludes 0, else why not: noise = the truth's, varies = "
            "the difference varies over the picture, too small = too little picture to judge, same = the same "
            "picture but for rounding");
    std::puts("ns/px: processor time of all threads, median and quartiles over the frames");
    for (const std::string& s : {leftOutInWords(r), busyInWords(r)})
        if (!s.empty()) std::puts(s.c_str());
    if (judged) {
        for (const auto& [kind, scale] : r.maps) std::printf("maps/%s: %s\n", kind.c_str(), scale.c_str());
        std::printf("figures: %s\n", inWords(r.protocol).c_str());
    }
    for (const auto& [what, count] : r.sanitised)
        if (count > 0)
            std::printf("input values that no method can use: %s %llu\n", what.c_str(),
                        static_cast<unsigned long long>(count));
    for (const auto& m : r.methods) {
        uint64_t broken = 0;
        for (const auto& f : m.frames) broken += f.nonFinite;
        if (broken > 0)
            std::printf(
                "%s: %llu values of its pictures or their truth are no numbers; each counts as the largest "
                "difference\n",
                m.text.c_str(), static_cast<unsigned long long>(broken));
    }
}

namespace {
// Figures over time; only what the shot gives.
void printTemporal(const RunResults& r) {
    using Value = std::optional<double>;
    struct Column {
        const char* head;
        int width, decimals;  // below 0: that many significant digits
        Value (*of)(const TemporalMetrics&);
    };
    constexpr Column kColumns[] = {
        {"tPSNR dB", 8, 3, [](const TemporalMetrics& t) { return t.tPsnr; }},
        {"flicker at rest", 15, 4, [](const TemporalMetrics& t) { return t.flickerStatic; }},
        {"flicker in motion", 17, 4, [](const TemporalMetrics& t) { return t.flickerMoving; }},
        {"ghost MSE", 10, -4, [](const TemporalMetrics& t) { return t.ghostMse; }},
        {"ghosts x noaa", 13, 3, [](const TemporalMetrics& t) { return t.ghostExcess; }},
        {"half-life", 9, 2, [](const TemporalMetrics& t) { return t.ghostHalfLife; }},
        {"converged", 9, 0, [](const TemporalMetrics& t) { return t.convergence ? Value(*t.convergence) : Value(); }},
    };
    const auto rows = bestFirst(r);
    const auto there = [&](const Column& c) {
        return std::any_of(rows.begin(), rows.end(), [&](const auto* m) { return m->temporal && c.of(*m->temporal); });
    };
    // tPSNR alone says what PSNR says.
    if (std::none_of(std::begin(kColumns) + 1, std::end(kColumns), there)) return;
    size_t width = 6;
    for (const auto* m : rows) width = std::max(width, m->text.size());
    std::printf("%-*s", int(width), "method");
    for (const Column& c : kColumns)
        if (there(c)) std::printf(" %*s", c.width, c.head);
    std::puts("");
    const TemporalMetrics* any = nullptr;
    for (const auto* m : rows) {
        if (!m->temporal) continue;
        any = &*m->temporal;
        std::printf("%-*s", int(width), m->text.c_str());
        for (const Column& c : kColumns)
            if (const Value v = c.of(*any); !there(c))
                continue;
            else if (!v)
                std::printf(" %*s", c.width, "-");
            else if (c.decimals < 0)
                std::printf(" %*.*g", c.width, -c.decimals, *v);
            else
                std::printf(" %*.*f", c.width, c.decimals, *v);
        std::puts("");
    }
    if (any)
        std::printf(
            "over time: after %d warm-up frames; flicker in codes of 255; half-life of ghosts and convergence in "
            "frames\n",
            any->warmup);
}

// Every figure frame by frame in the published form.
void printOverFrames(const RunResults& r) {
    const auto judged = [](const MethodResult& m) { return m.pooled ? m.pooled->frames : 0; };
    if (std::none_of(r.methods.begin(), r.methods.end(), [&](const auto& m) { return judged(m) > 1; })) return;
    size_t width = 6;
    for (const auto& m : r.methods) width = std::max(width, m.text.size());
    std::printf("over frames: best / worst / average (frame of the best, of the worst)\n");
    bool infinite = false;
    for (const Figure* f : figuresIn(r)) {
        for (const auto& m : r.methods) {
            const auto range = judged(m) > 1 ? rangeOverFrames(m, *f) : std::nullopt;
            if (!range) continue;
            infinite = infinite || std::isinf(range->mean);
            std::printf("%-*s  %s %s / %s / %s (%d, %d), pooled %s\n", int(width), m.text.c_str(),
                        std::string(f->name).c_str(), shown(*f, range->best).c_str(), shown(*f, range->worst).c_str(),
                        shown(*f, range->mean).c_str(), range->bestFrame, range->worstFrame,
                        shown(*f, m.pooled->mean.figure(f->name).value()).c_str());
        }
    }
    if (infinite)
        std::printf(
            "a frame that is identical has an infinite PSNR, and then the average has; the pooled one has not\n");
}

// Gains are measured against no anti-aliasing.
void addBaseline(std::vector<MethodSpec>& methods, const RunCommandArguments& o) {
    const auto isPlain = [](const MethodSpec& m) { return m.text == kBaseline; };
    if (o.withoutBaseline || std::any_of(methods.begin(), methods.end(), isPlain)) return;
    methods.insert(methods.begin(), parseMethod(kBaseline));
    if (!o.run.quiet)
        std::fprintf(stderr, "%s is run as well: gains are measured against it (--no-noaa: without)\n", kBaseline);
}
void printAdvice(const RunResults& r) {
    const auto advice = adviceInWords(r);
    if (!advice.empty()) std::puts("which method (gain over noaa, 95 % interval):");
    for (const std::string& s : advice) std::printf("  %s\n", s.c_str());
}

void execute(const RunCommandArguments& o, Context& context) {
    RunOptions run;
    if (o.methods.empty() && o.run.externals.empty())
        throw UsageError("run: no method; give one by -m (`aaresolve list` shows them), or pictures by --external");
    if (!o.methods.empty()) run.methods = chosenFor(o.run.shot, o.methods);
    if (!o.add) addBaseline(run.methods, o);  // what is added to has its own
    run.debugLayers = o.debugLayers;
    if (!o.trace.empty()) run.trace = std::make_shared<Trace>();
    run.provenance =
        provenanceOf(context.arguments, {"-m", "--method", "-o", "--out", "--external"}, {"--resume", "--add"});
    const ShotReader shot = openShot(o.run, run);
    if (!o.trace.empty()) requireWritable(o.trace);
    requireOwnFolder(run, shot.manifest());
    const FolderClaim claim(run.out);
    const bool goesOn = o.add || (o.resume && std::filesystem::exists(run.out / "results.json"));
    if (o.resume && !goesOn)
        std::fprintf(stderr, "--resume: %s holds no results yet; run from the start\n", run.out.c_str());
    RunResults results;
    withThreads(o.run.work.threads, [&] {
        TerminalProgress progress(shot.manifest().name, stepsOf(run, shot.manifest()), o.run.quiet);
        results = goesOn ? aa::resume(shot, run, progress.callbacks()) : aa::run(shot, run, progress.callbacks());
        if (run.trace) run.trace->write(o.trace);
        if (progress.interrupted()) context.exitCode = 130;
    });
    printReplaced(results, run.out);
    if (o.run.json)
        std::cout << toJsonText(results) << "\n";
    else {
        printTable(results), printTemporal(results);
        if (o.overFrames) printOverFrames(results);
        printAdvice(results);
    }
    if (!o.run.json)
        std::printf("results: %s\nto see them: aaresolve report %s\n", (run.out / "results.json").c_str(),
                    shellQuoted(run.out.string()).c_str());
}

}  // namespace

void addRun(CommandLine& line, Context& context) {
    auto o = std::make_shared<RunCommandArguments>();
    Command c = line.command("run", "Run methods on a shot and measure them against its ground truth");
    addMethodOption(c, o->methods, "a method", true);
    c.flag("--no-noaa", o->withoutBaseline, "do not add noaa where it is not named; then there are no gains");
    c.option("--external", o->run.externals,
             "NAME=FOLDER: a row of frames that were made elsewhere, one EXR (linear) or PNG (encoded) each; the last "
             "number of a name is its frame; repeat for more")
        .oneEach();
    addRunArguments(c, o->run);
    c.flag("--resume", o->resume, "go on with an interrupted run in OUT; the same command, and this");
    c.flag("--add", o->add, "add these methods to the run in OUT, whose options must be the same; its methods stay");
    c.flag("--over-frames", o->overFrames, "print best, worst and average over the frames of every figure as well");
    c.flag("--debug-layers", o->debugLayers, "also write each method's intermediate images");
    c.option("--trace", o->trace,
             "what each thread does when, as a file for chrome://tracing or ui.perfetto.dev: decoding, preparing, the "
             "methods, their figures and pictures")
        .typeName("FILE");
    c.run([o, &context] { execute(*o, context); });
}

}  // namespace aa
