// The frame-major runner: every chosen method runs on a frame while it is in memory; the next frame is decoded
// meanwhile; only the passes that the methods need are read. Memory does not grow with the number of frames.
#pragma once
#include <filesystem>

#include "cli/progress.h"
#include "image/colour.h"
#include "image/io.h"
#include "methods/driver.h"
#include "report/results.h"
#include "shot/manifest.h"
#include "shot/reader.h"

namespace aa {

struct RunOptions {
    std::vector<MethodSpec> methods;
    std::vector<size_t> frames;  // indices into the manifest, ascending; the methods see them all, in order
    Protocol protocol;
    Exec exec;
    int threads = 0;
    MeasureOptions measure;
    std::filesystem::path out;
    bool writeExr = true, writePng = false;
    bool writeAllFrames = false;  // otherwise: frames with ground truth of their own; of a static shot, the last
    bool debugLayers = false;
};

// Makes the methods fit options.protocol.history: ramp sets warmup=ramp wherever a method has the parameter and it was
// not given. Returns the methods that accumulate and have no ramp. Throws UsageError: a full history of a moving shot.
std::vector<std::string> applyHistory(RunOptions& options, const Manifest& manifest);
// Steps that a run shows as progress: its frames, before them those of a full history.
size_t stepsOf(const RunOptions& options, const Manifest& manifest);

// Runs, measures and writes OUT/<method>/<frame>.*, OUT/truth/<frame>.exr, results.json and results.csv. When
// interrupted, the results cover the frames that were finished. Throws InputError, UsageError.
//
// Images that are compared are displayed by the protocol's chain and, if asked, rounded to 8-bit codes. EXR files are
// never rounded: they hold linear light, of methods with encoded output decoded again; with the identity transfer the
// displayed values. PNG files hold the displayed values as codes.
RunResults run(const ShotReader& shot, const RunOptions& options, Progress& progress);
// The same without what needs all methods together: figures are not pooled, no results are written. `errors` receives
// the tile errors that finish() asks for.
RunResults runMethods(const ShotReader& shot, const RunOptions& options, Progress& progress,
                      std::vector<TileErrors>& errors);

// Throws InputError naming the first method that asks for a pass which the shot lacks.
void requirePasses(const ShotReader& shot, const std::vector<MethodSpec>& methods);

// Frames as a list `1-16,20` (frame numbers of the manifest; empty = all). Throws UsageError, InputError (no such
// frame).
std::vector<size_t> selectFrames(const Manifest& manifest, const std::string& list);

}  // namespace aa
