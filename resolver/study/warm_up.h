// A full history: the frames of a static shot run again and again before the judged ones (decisions 13).
#pragma once
#include "methods/driver.h"
#include "shot/reader.h"
#include "study/progress.h"
#include "study/run.h"

namespace aa {

// Whole passes over the frames before the judged one; 0 where the protocol or the methods want none.
size_t warmUpPasses(const RunOptions& options, const Manifest& manifest);
inline constexpr size_t kMostBytesOfWarmUp = size_t(512) << 20;  // a period of 16 frames at 1080p with three passes
// Runs the methods that accumulate, without a judge. Returns the camera of the last frame. Frames that together take at
// most `mostBytes` are decoded once for all passes.
std::optional<Camera> warmUp(const ShotReader& shot, const RunOptions& options, std::vector<RunningMethod>& methods,
                             size_t passes, const Progress& progress, size_t mostBytes = kMostBytesOfWarmUp);

}  // namespace aa
