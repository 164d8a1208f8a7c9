// shot.json, version 1: what was rendered, with which jitter and camera, and where it lies.
//
// Optional members may be absent; unknown members are kept and ignored; a wrong type or a missing required member is an
// InputError that names the member and the file.
#pragma once
#include <filesystem>
#include <glm/vec2.hpp>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "shot/camera.h"

namespace aa {

struct FrameEntry {
    int frame = 1;
    std::string file;          // relative to the shot's folder
    std::string centre;        // relative; the same instant sampled at the pixel centres (no jitter), for methods that
                               // do not accumulate; empty when there is none
    std::string truth;         // relative; empty when this frame has no ground truth
    bool reset = false;        // history must be dropped before this frame (first frame, camera cut)
    glm::dvec2 jitterPx{0.0};  // sample position minus pixel centre, y down
    std::optional<Camera> camera;
    std::map<std::string, double> renderSeconds;  // by pass group and "truth"
    // Unknown members, kept as they were: the text of a JSON object; empty: none.
    std::string extra;
};

struct Manifest {
    std::string name = "shot";
    int width = 0, height = 0;
    double fps = 24;
    std::string jitterSequence = "none";
    int jitterStart = 1, jitterPeriod = 1;
    // A labelled variant, made on purpose to reproduce a published error [Stejmar n.d., 3.7.1, eq 3.12 and 3.14]: the
    // jitter's translation was multiplied to the wrong side of the projection P, so it moved the geometry by
    // (-2 jx / W, +2 jy / H) scene units in view space. A point at depth z is then sampled at (jx P[0][0] / z,
    // jy P[1][1] / z) px, while FrameEntry::jitterPx states (jx, jy), as the methods of that thesis believed: right at
    // the depth P[0][0] alone.
    bool jitterPremultiplied = false;
    bool isStatic = false;  // camera and every object at rest
    std::string subsamplePattern;
    std::vector<glm::dvec2> subsamplePositionsPx;  // offsets from pixel centre + jitter, y down
    std::map<uint32_t, std::string> objects;
    int truthSamplesPerHalf = 0;
    std::string truthFilter = "box";
    double truthFilterWidthPx = 1.0;
    std::optional<int> truthHalves;  // 1: a single render, whose noise nobody knows; otherwise two
    std::vector<FrameEntry> frames;
    nlohmann::json extra = nlohmann::json::object();  // unknown members and `producer`, kept as they were (also nested)
    std::filesystem::path folder;                     // where shot.json lies; not part of the file

    const FrameEntry* find(int frame) const;
};

inline constexpr int kMaxSubSamples = 256;
inline constexpr int kLastFrame = 1048574;  // Blender's MAXFRAME; its MINAFRAME is the same below 0

// What members may hold, for all who fill a Manifest: a shot is never written that cannot be read.
struct NumberRange {
    double min, max;
    const char* inWords;
    bool contains(double v) const { return v >= min && v <= max; }
};
inline constexpr NumberRange kFps{1e-3, 1e6, "frames per second in 0.001..1000000"};
inline constexpr NumberRange kTruthFilterWidthPx{0, 1000, "a width in px, 0..1000"};

// SHOT may be the folder or its shot.json. Throws InputError: missing, not JSON, a missing required member, a wrong
// type, a value out of range, frame numbers that do not increase, a path that leaves the shot's folder.
Manifest readManifest(const std::filesystem::path& shot);
// The same from text; `file` is named in errors and its folder becomes Manifest::folder.
Manifest parseManifest(const std::string& text, const std::filesystem::path& file);
// An object's id as the name of a member: 0 to 4294967295 in digits; nothing for any other text.
std::optional<uint32_t> objectIdIn(const std::string& name);
nlohmann::json toJson(const Manifest& manifest);
// Its members, for who goes through the frames of a long shot one by one.
nlohmann::json toJsonWithoutFrames(const Manifest& manifest);
nlohmann::json toJson(const FrameEntry& frame);
// Writes folder/shot.json through a temporary name.
void writeManifest(const Manifest& manifest);

}  // namespace aa
