#include "cli/run_arguments.h"

#include <cstdio>

#include "image/error.h"
#include "image/io.h"

namespace aa {

void addRunArguments(CLI::App& c, RunArguments& a) {
    c.add_option("SHOT", a.shot, "the shot's folder")->required();
    c.add_option("-o,--out", a.out, "folder for images, results.json and results.csv")->required();
    c.add_option("--frames", a.frames, "frames, as 1-16,20; default all");
    c.add_option("--write", a.write, "image files: exr (linear), png (8-bit sRGB), exr,png or none");
    c.add_option("--write-frames", a.writeFrames,
                 "truth = frames that have their own truth (of a static shot the last), all")
        ->check(CLI::IsMember({"truth", "all"}));
    c.add_option("--exposure", a.exposure, "display exposure, EV")->check(CLI::Range(-20.0, 20.0));
    c.add_option("--tone-map", a.toneMap, "display tone map")->check(CLI::IsMember({"none", "reinhard", "aces"}));
    c.add_option("--display", a.display,
                 "srgb = encode for the display; identity = the clamped values are the displayed ones, one space for "
                 "truth, methods and figures (no gamma anywhere)")
        ->check(CLI::IsMember({"srgb", "identity"}));
    c.add_option("--history", a.history,
                 "history at the first judged frame: first = none, ramp = none, with warmup=ramp, full = a static "
                 "shot's frames ran for 10 jitter periods before")
        ->check(CLI::IsMember({"first", "ramp", "full"}));
    c.add_option("--quantise", a.quantise,
                 "8 = round the compared images, truth included, to 8-bit codes; written EXR files are not rounded")
        ->check(CLI::IsMember({8}));
    c.add_option("--input", a.input, "NaN and Inf in the input: sanitise = replace and count, strict = refuse")
        ->check(CLI::IsMember({"sanitise", "strict"}));
    c.add_flag("--json", a.json, "print results.json instead of the table");
    c.add_flag("-q,--quiet", a.quiet, "no progress");
    addWorkOptions(c, a.work);
}

ShotReader openShot(const RunArguments& a, RunOptions& run) {
    run.exec = a.work.exec();
    run.threads = a.work.threads;
    run.protocol = {.display = {float(a.exposure), toneMapByName(a.toneMap), transferByName(a.display)},
                    .history = historyByName(a.history),
                    .eightBit = a.quantise == 8};
    run.out = a.out;
    run.writeExr = a.write.find("exr") != std::string::npos;
    run.writePng = a.write.find("png") != std::string::npos;
    if (!run.writeExr && !run.writePng && a.write != "none")
        throw UsageError("--write: expected exr, png, exr,png or none, found '" + a.write + "'");
    run.writeAllFrames = a.writeFrames == "all";
    ShotReader shot(a.shot, a.input == "strict" ? InputPolicy::strict : InputPolicy::sanitise);
    run.frames = selectFrames(shot.manifest(), a.frames);
    std::string without;
    for (const auto& method : applyHistory(run, shot.manifest())) without += (without.empty() ? "" : ", ") + method;
    if (!without.empty()) std::fprintf(stderr, "--history ramp: no ramp in %s; run as they are\n", without.c_str());
    return shot;
}

}  // namespace aa
