// The frames that `bench` times on: of a shot, or of a synthetic scene that has what a method reads.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "methods/spec.h"
#include "shot/reader.h"

namespace aa {

struct BenchFrames {
    std::string shot, scene;  // a shot's folder; or a synthetic scene, empty: the one that serves the method
    int width = 1920, height = 1080;
    int frames = 8;
    InputPolicy policy = InputPolicy::sanitise;  // of a shot's frames
};

// In the sampling that the methods read.
struct Frames {
    std::vector<Frame> jittered, centre;
    ShotInfo info;
    std::string scene, subsamples;  // of the synthetic frames
    double edgeShare = 0;
    SanitiseCounts counts;  // what a shot's frames held that the policy knows
    const std::vector<Frame>& of(const MethodSpec& m) const {
        return m.method->sampling() == Sampling::jittered ? jittered : centre;
    }
};
// Frames that serve `method`, with what all of `methods` read, encoded for the display; those of `before`, made
// with the same options, where they serve. Throws UsageError, InputError.
void framesFor(std::optional<Frames>& before, const BenchFrames& options, const MethodSpec& method,
               const std::vector<MethodSpec>& methods, const Exec& exec);

}  // namespace aa
