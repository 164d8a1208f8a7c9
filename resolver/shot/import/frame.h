// One frame of Blender's passes becomes one frame of a shot.
#pragma once
#include "shot/import/blender_exr.h"
#include "shot/import/import.h"

namespace aa {

// Where the ids come from. An index of 0 is Blender's default: such surfaces get an id of their own.
enum class IdSource { none, index, cryptomatte };
inline constexpr uint32_t kNoPassIndex = 32768;  // one more than the largest pass index that Cycles writes

// What the first frame offers decides what all frames must have.
struct ImportPlan {
    std::string layer, view;
    int width = 0, height = 0;
    bool depth = false, normal = false, vector = false, albedo = false;
    IdSource ids = IdSource::none;
    PassSet passes() const;
};
// Throws UsageError (several layers), InputError (no Combined pass). Adds to report.missing and report.notes.
ImportPlan planImport(const std::filesystem::path& firstFile, const ImportOptions& options, ImportReport& report);

// Values that were not as a shot wants them, in one frame.
struct ImportCounts {
    uint64_t normalised = 0;  // normals averaged over several surfaces
    uint64_t noIndex = 0;     // pixels of objects without a pass index
    uint64_t idOnBackground = 0;
};
// Decodes and converts. `entry` brings number, jitter and camera; `before` is the camera of the frame before.
// Throws InputError: a pass that the plan promises is missing, another size, damaged.
Frame importFrame(const std::filesystem::path& file, const ImportPlan& plan, const FrameEntry& entry,
                  const std::optional<Camera>& before, ImportCounts& counts);

// Base colour without light. `diffuse`, `glossy`, `transmission`, `emission` and `denoising` may be empty.
struct AlbedoPasses {
    Rgb denoising, emission, diffuse, glossy, transmission, environment;
};
Rgb unlitAlbedo(const AlbedoPasses& passes, const PlaneF& depthView, const Rgb& combined);

// Names of cryptomatte ids from the manifest in the file's header; empty when there is none. A broken one is read as
// far as it can be, with a note.
std::map<uint32_t, std::string> cryptomatteNames(const BlenderExr& file, std::vector<std::string>& notes);

}  // namespace aa
