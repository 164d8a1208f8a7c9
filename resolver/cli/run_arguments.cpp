#include "cli/run_arguments.h"

#include <algorithm>
#include <cstdio>

#include "image/error.h"
#include "image/io.h"
#include "study/external.h"
#include "study/prepare.h"

namespace aa {

void addViewingArguments(Command& c, ViewingArguments& a, const std::string& own) {
    c.option("--metric-display", a.display, "where `cvvdp` sees the sequence:" + listOfDisplayModels());
    c.option("--metric-fps", a.framesPerSecond, "frames per second at which `cvvdp` sees it; 0 = " + own)
        .range(0.0, 1000.0);
    c.option("--flip-ppd", a.flipPixelsPerDegree,
             "pixels per degree at which `flip` and `hdrFlip` are seen: distance / pixel size x pi / 180; maps keep 67")
        .range(kLeastFlipPixelsPerDegree, kMostFlipPixelsPerDegree)
        .defaultText("67.02");
}
Viewing viewingOf(const ViewingArguments& a, double own) {
    return {&displayModelByName(a.display), a.framesPerSecond > 0 ? a.framesPerSecond : own};
}

void addRunArguments(Command& c, RunArguments& a) {
    c.option("SHOT", a.shot, "the shot's folder").required().typeName("SHOT");
    c.option("-o,--out", a.out, "folder for images, results.json and results.csv").required().typeName("FOLDER");
    c.option("--frames", a.frames, "frames, as 1-16,20; default all");
    c.option("--write", a.write, "image files: exr (linear), png (8-bit sRGB), exr,png or none");
    c.flag(
        "--dither", a.dither,
        "8-bit codes of PNG files rounded up or down by chance, the same in every run: noise instead of bands on slow "
        "gradients");
    c.option("--write-frames", a.writeFrames,
             "truth = frames that have their own truth (of a static shot the last), all")
        .oneOf({"truth", "all"});
    c.option("--exposure", a.exposure, "display exposure, EV").range(-20.0, 20.0);
    c.option("--tone-map", a.toneMap, "display tone map").oneOf({"none", "reinhard", "aces"});
    c.option("--display", a.display,
             "srgb = encode for the display; identity = the clamped values are the displayed ones, one space for "
             "truth, methods and figures (no gamma anywhere)")
        .oneOf({"srgb", "identity"});
    c.option("--history", a.history,
             "history at the first judged frame: first = none, ramp = none, with warmup=ramp, full = a static "
             "shot's frames ran for 10 jitter periods before")
        .oneOf({"first", "ramp", "full"});
    c.option("--quantise", a.quantise,
             "8 = round the compared images, truth included, to 8-bit codes; written EXR files are not rounded")
        .oneOf({8});
    c.option("--metrics", a.metrics, "figures beside those that every run has, comma-separated:" + listOfFigures(true))
        .separatedBy(',');
    c.option(
         "--maps", a.maps,
         "pictures of the differences from the truth, comma-separated, into OUT/maps/KIND/METHOD:" + listOfMapKinds())
        .separatedBy(',');
    addViewingArguments(c, a.viewing, "the shot's own");
    c.option(
        "--region", a.region,
        "X,Y,WIDTH,HEIGHT: figures of these pixels alone, as if they were the picture; methods still see all of it");
    c.option(
         "--reference", a.reference,
         "a method: the others are held against its images instead of the shot's truth; added where it is not there")
        .typeName("METHOD");
    addNonFinite(c, a.nonFinite);
    c.flag("--json", a.json, "print results.json instead of the table");
    c.flag("-q,--quiet", a.quiet, "no progress");
    addWorkOptions(c, a.work);
    addDeviceOptions(c, a.work);
    c.flag("--device-times", a.timeOnly,
           "the methods run on the processor, and on the device for its time beside: both costs in one report");
}

namespace {
// Of "exr,png" and its like.
void chooseWritten(const std::string& text, RunOptions& run) {
    run.writeExr = run.writePng = false;
    if (text == "none") return;
    std::string_view rest = text;
    for (bool isLast = false; !isLast;) {
        const size_t comma = rest.find(',');
        const std::string_view kind = rest.substr(0, comma);
        if (kind != "exr" && kind != "png")
            throw UsageError("--write: expected exr, png, exr,png or none, found '" + text + "'");
        (kind == "exr" ? run.writeExr : run.writePng) = true;
        isLast = comma == std::string_view::npos;
        if (!isLast) rest.remove_prefix(comma + 1);
    }
}
}  // namespace

ShotReader openShot(const RunArguments& a, RunOptions& run) {
    run.exec = a.work.exec();
    run.device = a.work.session();
    run.timeOnly = a.timeOnly;
    if (a.timeOnly && !run.device) throw UsageError("--device-times: no effect without --device vulkan");
    run.measure = measureOptions(a.metrics);
    for (const auto& kind : a.maps) run.maps.push_back(&mapKindByName(kind));
    run.protocol = {.display = {float(a.exposure), toneMapByName(a.toneMap), transferByName(a.display)},
                    .history = historyByName(a.history),
                    .eightBit = a.quantise == 8};
    for (const auto& text : a.externals) {
        run.methods.push_back(externalMethod(text, run.protocol.display));
        const auto same = [&](const MethodSpec& m) { return m.text == run.methods.back().text; };
        if (std::count_if(run.methods.begin(), run.methods.end(), same) > 1)
            throw UsageError("--external: '" + run.methods.back().text + "' is given twice");
        const std::filesystem::path from = std::filesystem::weakly_canonical(run.methods.back().method->source);
        if (firstBelow(std::filesystem::weakly_canonical(a.out), from))
            throw UsageError("--external: " + from.string() + " lies in " + a.out +
                             ", where this run writes and clears; give the run another folder");
    }
    run.out = a.out;
    chooseWritten(a.write, run);
    run.writeAllFrames = a.writeFrames == "all";
    run.dither = a.dither;
    if (a.dither && !run.writePng) throw UsageError("--dither: no effect without --write png");
    if (a.dither && a.quantise)
        throw UsageError("--dither: no effect with --quantise, which rounds before images are written");
    ShotReader shot(a.shot, inputPolicyByName(a.nonFinite));
    run.frames = selectFrames(shot.manifest(), a.frames);
    run.measure.viewing = viewingOf(a.viewing, shot.manifest().fps);
    run.measure.flipPixelsPerDegree = a.viewing.flipPixelsPerDegree;
    if (!a.region.empty())
        run.protocol.region = windowFrom(a.region, "--region", "shot '" + shot.manifest().name + "'",
                                         shot.manifest().width, shot.manifest().height);
    if (!a.reference.empty()) judgeAgainst(run, a.reference);
    requireSequence(run, shot.manifest());
    std::string without;
    for (const auto& method : applyHistory(run, shot.manifest())) without += (without.empty() ? "" : ", ") + method;
    if (!without.empty()) std::fprintf(stderr, "--history ramp: no ramp in %s; run as they are\n", without.c_str());
    return shot;
}

}  // namespace aa
