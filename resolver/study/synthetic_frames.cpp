#include "study/synthetic_frames.h"

#include "image/error.h"
#include "shot/patterns.h"
#include "shot/synth/synth.h"

namespace aa {

std::string subSamplePatternFor(const MethodSpec& m) {
    if (!m.passes().hasAnyOf(Pass::subsamples | Pass::subsampleColor)) return "";
    const std::string patterns[] = {"d3d8", "d3d4", "d3d2", "d3d16"};
    for (const auto& pattern : patterns) try {
            m.create({.width = 8,
                      .height = 8,
                      .jitterPeriod = 16,
                      .isStatic = true,
                      .frameCount = 16,
                      .subSamplePositionsPx = patternPositionsPx(pattern)});
            return pattern;
        } catch (const std::runtime_error&) {
            if (pattern == std::end(patterns)[-1]) throw;
        }
    return "";
}

std::string synthSceneFor(const MethodSpec& m, const std::string& asked) {
    const PassSet listed = Pass::edges | Pass::segments;
    const bool wantsEdges = !(m.passes().without(m.passes().without(listed))).empty();
    const std::string scene = !asked.empty() ? asked : wantsEdges ? "half_planes" : "moving";
    SynthOptions synth;
    synth.scene = scene, synth.width = synth.height = 8;
    if (wantsEdges && SynthShot(synth).passes().without(listed) == SynthShot(synth).passes())
        throw UsageError("--scene: " + scene + " has curved objects, and " + m.text +
                         " reads the edges of polygons; choose half_planes, or give a --shot");
    return scene;
}

}  // namespace aa
