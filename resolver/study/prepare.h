// What a run needs to know before its first frame: that the shot serves the methods, which frames and passes are read,
// and what the results will say of shot, truth and program.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "methods/driver.h"
#include "shot/reader.h"
#include "study/results.h"
#include "study/run.h"

namespace aa {

// First and last of each part of a list `1-16,20`, where `1..16` is `1-16`. Throws UsageError.
std::vector<std::pair<int, int>> frameRanges(const std::string& list);
// Frames as such a list (frame numbers of the manifest; empty = all). Throws UsageError, InputError (no such
// frame).
std::vector<size_t> selectFrames(const Manifest& manifest, const std::string& list);
// Throws InputError naming the first method that asks for passes which the shot lacks, and what adds them for all.
void requirePasses(const ShotReader& shot, const std::vector<MethodSpec>& methods);
// Makes the methods fit options.protocol.history: ramp sets warmup=ramp wherever a method has the parameter and it was
// not given. Returns the methods that accumulate and have no ramp. Throws UsageError: a full history of a moving shot.
std::vector<std::string> applyHistory(RunOptions& options, const Manifest& manifest);

// The first step from a folder to what lies in it, "." where it is the folder itself; both paths canonical. Nothing: it
// lies elsewhere.
std::optional<std::filesystem::path> firstBelow(const std::filesystem::path& folder, const std::filesystem::path& path);
// Throws UsageError where the run's folder is a shot's, or one where that of this run keeps its frames: pictures that
// the run writes and clears would take their place.
void requireOwnFolder(const RunOptions& options, const Manifest& manifest);

// Holds the methods against another one instead of the shot's truth; one that is not among them is added. Throws
// UsageError.
void judgeAgainst(RunOptions& options, const std::string& method);

// A metric of a sequence needs a reference for every frame, and linear light for a display that is fed it. Throws
// UsageError.
void requireSequence(const RunOptions& options, const Manifest& manifest);

// Which passes are read of which frames: methods that accumulate read the jittered ones, all others the centre-sampled
// ones where the shot has them.
struct InputPlan {
    bool split = false;  // centre-sampled frames are read, too
    PassSet jittered, centre;
    bool overTime = false;  // a sequence is also judged over time, along the motion where the shot knows it
    bool readsCentre(const MethodSpec& method) const { return split && method.method->sampling() == Sampling::centre; }
};
InputPlan planInput(const ShotReader& shot, const RunOptions& options);
// The methods, ready to run; their folders and the truth's are made. Throws InputError, UsageError.
std::vector<RunningMethod> startMethods(const ShotReader& shot, const RunOptions& options);
// Everything that is known before the first frame.
RunResults describeRun(const Manifest& manifest, const RunOptions& options);

}  // namespace aa
