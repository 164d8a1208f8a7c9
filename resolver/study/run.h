// A run: every chosen method on every frame while it is in memory, side by side where there are threads; the next frame
// is decoded meanwhile; only the passes that the methods need are read. Memory does not grow with the number of frames.
// The way of the data is that of the files here: prepare -> (warm_up) -> frame_work: resolve -> judge -> images ->
// results.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <memory>

#include "image/trace.h"
#include "methods/spec.h"
#include "metrics/maps.h"
#include "shot/reader.h"
#include "study/progress.h"
#include "study/results.h"

namespace aa {
namespace gpu {
class Session;
}

struct RunOptions {
    std::vector<MethodSpec> methods;
    std::vector<size_t> frames;  // indices into the manifest, ascending; the methods see them all, in order
    Protocol protocol;
    Provenance provenance;  // of the command line; empty: found where the run begins
    Exec exec;
    std::shared_ptr<gpu::Session> device;  // null: the processor
    bool timeOnly = false;                 // the methods run on the processor, and on the device for its time beside
    MeasureOptions measure;
    std::vector<const MapKind*> maps;  // of the frames that are written: OUT/maps/KIND/METHOD/<frame>.png
    std::filesystem::path out;
    bool writeExr = true, writePng = false;
    bool dither = false;          // codes of PNG files are rounded up or down by chance (metrics/metrics.h)
    bool writeAllFrames = false;  // otherwise: frames with ground truth of their own; of a static shot, the last
    bool debugLayers = false;
    std::shared_ptr<Trace> trace;  // null: none is kept
    // Of a run that goes on with an earlier one (study/resume.h): every method of the results, of which `methods` run
    // now, and what is known of the frames of these. Empty: `methods` are all.
    std::vector<MethodSpec> allMethods;
    std::map<std::string, std::vector<FrameResult>> known;
    const std::vector<MethodSpec>& every() const { return allMethods.empty() ? methods : allMethods; }
    // Told what is there before the first frame and after each one.
    std::function<void(RunResults&)> checkpoint;
};

// Metrics that watch the sequence: those asked for, and those that a map is drawn from.
std::vector<const Metric*> watchingMetrics(const RunOptions& options);
// Steps that a run shows as progress: its frames, before them those of a full history.
size_t stepsOf(const RunOptions& options, const Manifest& manifest);

// Runs, measures and writes OUT/<method>/<frame>.*, OUT/truth/<frame>.exr, results.json and results.csv. When
// interrupted, the results cover the frames that were finished and say so. They are written as it goes, so that a run
// which is ended without asking leaves them, too. Throws InputError, UsageError.
RunResults run(const ShotReader& shot, const RunOptions& options, const Progress& progress);
// Goes on with the results in options.out: finishes what was interrupted and adds the methods that are new.
RunResults resume(const ShotReader& shot, const RunOptions& options, const Progress& progress);
// The same without what needs all methods together: figures are not pooled, no results are written. `errors` receives
// the tile errors that finish() asks for.
RunResults runMethods(const ShotReader& shot, const RunOptions& options, const Progress& progress,
                      std::vector<TileErrors>& errors);

}  // namespace aa
