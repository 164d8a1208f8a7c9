// How an engine writes its frames: which file and channel holds which pass, and by which conventions. A JSON file that
// docs/format.md describes; members that it does not know are refused, because a misspelt convention would silently be
// another one.
#pragma once
#include <filesystem>
#include <glm/vec2.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "shot/frame_notes.h"
#include "shot/pass.h"

namespace aa {

// Where a pass lies: files named by a pattern with {frame}, and channels of one of their parts.
struct EngineSource {
    std::string files;                  // "color/frame_{frame}.exr", relative to the folder of frames
    std::string part;                   // of a multi-part file; empty: the first that has the channels
    std::vector<std::string> channels;  // as many as the pass has
};
// What a depth means. Device depth as it is after the division by w, 0..1: `device` is 0 at the near plane,
// `reversed` 1.
enum class DepthKind { planar, distance, device, reversed };
enum class MotionUnit { px, uv, ndc };
enum class NormalSpace { world, view };
struct EnginePasses {
    std::map<Pass, EngineSource> sources;  // colour is always there
    DepthKind depthKind = DepthKind::planar;
    double nearPlane = 0, farPlane = 0;  // of device depth, in scene units; farPlane 0: infinite
    double depthScale = 1;               // scene units per stored unit, of planar and distance
    std::optional<double> background;    // planar and distance: from here on there is no surface; otherwise from 1e9 on
    MotionUnit motionUnit = MotionUnit::px;
    bool motionYUp = false, motionFromNow = false, motionJittered = false;  // fromNow: previous - current
    NormalSpace normalSpace = NormalSpace::world;
    bool normalUnsigned = false;  // stored as n / 2 + 1/2
};
struct EngineLayout {
    std::string reads;  // the members that decide what pixels are read, as text
    std::string name = "shot";
    double fps = 24;
    bool isStatic = false;
    EnginePasses passes;
    std::optional<EnginePasses> centre;  // the same instants, sampled at the pixel centres
    std::vector<EngineSource> truth;     // one or two independent halves
    std::string truthFilter = "unknown";
    double truthFilterWidthPx = 0;
    int truthSamplesPerHalf = 0;
    std::string jitterSequence = "none";
    std::vector<glm::dvec2> jitterPx;  // of the first frames; repeats. As in a shot: sample - centre, y down
    std::optional<FrameNotes> notes;   // of single frames: jitter, camera, reset, as in shot.json
};
// `width` and `height` turn a jitter in UV or NDC into px. Throws InputError, one line that names the member.
EngineLayout readEngineLayout(const std::filesystem::path& file, int width, int height);
// Before the pictures' size is known: the first colour file's pattern.
std::string colourFilesOf(const std::filesystem::path& file);

}  // namespace aa
