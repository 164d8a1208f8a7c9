// What `run` and `sweep` take alike: the shot, the frames, the display and where the results go.
#pragma once
#include <string>

#include "cli/cli.h"
#include "cli/runner.h"

namespace aa {

struct RunArguments {
    std::string shot, out, frames, write = "exr", writeFrames = "truth", toneMap = "none", input = "sanitise";
    double exposure = 0;
    bool json = false, quiet = false;
    WorkOptions work;
};
void addRunArguments(CLI::App& command, RunArguments& arguments);
// Opens the shot and fills everything in `options` but the methods. Throws UsageError, InputError.
ShotReader openShot(const RunArguments& arguments, RunOptions& options);
// Methods by PSNR, the truth's error bar, what the sanitiser replaced.
void printTable(const RunResults& results);

}  // namespace aa
