// What `run` and `sweep` take alike: the shot, the frames, the display and where the results go.
#pragma once
#include <string>

#include "cli/cli.h"
#include "cli/progress.h"
#include "study/run.h"

namespace aa {

// Where metrics of a sequence see it.
struct ViewingArguments {
    std::string display = std::string(displayModels().front().name);
    double framesPerSecond = 0;  // 0: the frames' own
    double flipPixelsPerDegree = kFlipPixelsPerDegree;
};
void addViewingArguments(Command& command, ViewingArguments& arguments, const std::string& ownFramesPerSecond);
Viewing viewingOf(const ViewingArguments& arguments, double ownFramesPerSecond);

struct RunArguments {
    std::string shot, out, frames, write = "exr", writeFrames = "truth", toneMap = "none", display = "srgb",
                                   history = "first", nonFinite = "sanitise", region, reference;
    double exposure = 0;
    std::vector<std::string> metrics, maps;
    ViewingArguments viewing;
    std::vector<std::string> externals;  // NAME=FOLDER: rows of pictures made elsewhere
    int quantise = 0;                    // 0: off
    bool timeOnly = false, dither = false;
    bool json = false, quiet = false;
    WorkOptions work;
};
void addRunArguments(Command& command, RunArguments& arguments);
// Opens the shot and fills everything in `options` but the methods, which must be there already: they are made to fit
// the history. Throws UsageError, InputError.
ShotReader openShot(const RunArguments& arguments, RunOptions& options);
// What of an earlier run in that folder is gone or outdated, on stderr.
void printReplaced(const RunResults& results, const std::filesystem::path& out);
// Methods by PSNR, the truth's error bar, what the sanitiser replaced.
void printTable(const RunResults& results);

}  // namespace aa
