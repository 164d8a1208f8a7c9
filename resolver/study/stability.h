// Stability as a measurement: what the fast form of a method, narrow histories and shaders cost in accuracy, and how a
// method answers small changes, long sequences and single bright pixels. What each figure means: docs/stability.md.
//
// Everything is measured on frames that are made here, the same on every machine (study/stability_frames.h); errors,
// amplification and ties on a shot's frames where one is given. Colours are display-encoded sRGB, without exposure.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "image/input_policy.h"
#include "methods/spec.h"
#include "study/progress.h"

namespace aa {
namespace gpu {
class Session;
}

struct StabilityOptions {
    std::vector<MethodSpec> methods;
    std::string shot;  // folder; empty: synthetic frames of `width` x `height`
    InputPolicy policy = InputPolicy::sanitise;
    int width = 96, height = 54;
    int frames = 64;       // that methods with a history see; others see at most kStatelessFrames of them
    int longFrames = 512;  // of the picture at rest: drift and recovery
    uint32_t seed = 1;
    Exec exec;  // its precision is not used
    // The shaders' two forms on one device; null: left out, `noDevice` says why.
    gpu::Session *exact = nullptr, *fast = nullptr;
    std::string noDevice;
};
inline constexpr int kStatelessFrames = 8;

// Differences from the double form (double arithmetic, float storage) over all channels, pixels and frames, in the
// method's output space.
struct Deviation {
    double max = 0, rms = 0;      // by max(1, |value|): absolute where values are displayed, relative above
    double ulp = 0, ulpMost = 0;  // units in the last place of float at the value: 99 % of them at most, and the most
    size_t notFinite = 0;         // values that are no number in one form alone; not in the others
};
// Where light spans 1e-6 to 1e6 by chance: largest error of the float lanes as a share of the value (no value less than
// 1e-6) and of the largest value in 7x7 pixels around.
struct WideLightError {
    double ofValue = 0, ofLargest = 0;
};
// A change of one unit in the last place, up or down by chance, of every colour of every frame: what becomes of it, in
// units in the last place of the output.
struct Amplification {
    std::vector<double> most, rms;  // by frame
    double largest() const;
};
// What a history does to a picture at rest.
struct Settling {
    double stallCodes = 0;    // 8-bit codes that pixels still miss of a step of 8 codes, kSettlingFrames after it
    double bandingCodes = 0;  // steps on a slow gradient, RMS (metrics/banding.h)
    double drift = 0;         // change of the mean, relative
};
inline constexpr int kSettlingFrames = 256;
struct Recovery {
    std::optional<int> frames;  // until the picture is as if the bright pixel had never been; none: not within `tried`
    int tried = 0;
};

struct MethodStability {
    std::string id, text, title, family;
    bool keepsHistory = false;
    Deviation lanes;
    std::optional<Deviation> half, byte;         // historyBits=16f and 8, where the method has them
    std::optional<Deviation> gpuExact, gpuFast;  // where there is a device and a shader
    WideLightError wideLight;
    Amplification amplification;
    std::optional<Settling> settling, settlingHalf, settlingByte;  // of methods with a history
    std::optional<Recovery> recovery;                              // the same
    double tieShare = 0;                                           // of pixels
    size_t tiePixels = 0;                                          // over which that is
};
struct StabilityResults {
    std::string program, material;  // the frames, in words
    std::string shot;               // its name; empty: synthetic
    int width = 0, height = 0, frames = 0, longFrames = 0;
    uint32_t seed = 0;
    std::string device, deviceKind, driver;     // empty without one
    std::string noDevice;                       // why there is none
    bool complete = true;                       // false: interrupted, methods are missing
    std::map<std::string, uint64_t> sanitised;  // values of a shot's frames that were replaced
    std::vector<MethodStability> methods;
};

// One step of progress per method. Throws InputError, UsageError, gpu::DeviceError.
StabilityResults measureStability(const StabilityOptions& options, const Progress& progress);
// Of one method, by itself.
WideLightError wideLightError(const MethodSpec& method);

// The single measurements, on frames that are encoded for the display. `info` is what the frames' shot says of itself.
namespace stability {
// The same method with another history: "32f", "16f", "8"; nothing where it has none such.
std::optional<MethodSpec> withHistory(const MethodSpec& method, std::string_view bits);
// `form` on the float lanes, or `device` on its device, against the double form of `method`.
Deviation deviation(const MethodSpec& method, const MethodSpec& form, const std::vector<Frame>& frames,
                    const ShotInfo& info, gpu::Session* device = nullptr);
Amplification amplification(const MethodSpec& method, const std::vector<Frame>& frames, const ShotInfo& info,
                            uint32_t seed);
struct Ties {
    size_t pixels = 0, of = 0;
};
// Pixels of the last of `frames` whose value in the double form jumps where every value of this last frame is moved by
// kTieDistance of itself.
Ties ties(const MethodSpec& method, const std::vector<Frame>& frames, const ShotInfo& info, uint32_t seed);
Settling settling(const MethodSpec& form, int longFrames);
Recovery recovery(const MethodSpec& method, int longFrames);
}  // namespace stability
inline constexpr double kTieDistance = 1e-6, kTieJump = 100 * kTieDistance;

// stability.json: docs/format.md. Table for a terminal, and the page docs/results/stability.md.
std::string toJsonText(const StabilityResults& results);
std::string toText(const StabilityResults& results);
std::string toMarkdown(const StabilityResults& results);
// Whether `file` is a stability.json that was not interrupted. False of a file that is damaged or something else.
bool holdsCompleteStability(const std::filesystem::path& file);

}  // namespace aa
