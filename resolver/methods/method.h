// What every anti-aliasing method is to the rest of the program.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "image/colour.h"
#include "kernels/dispatch.h"
#include "methods/params.h"
#include "shot/frame.h"

namespace aa {

enum class Space { linear, encoded };  // scene-referred radiance, or display-encoded sRGB in [0,1] (conventions 4)

// What a method may know of a shot before its first frame.
struct ShotInfo {
    int width = 0, height = 0;
    int jitterPeriod = 1;
    bool isStatic = false;
    size_t frameCount = 1;
    std::vector<glm::dvec2> subSamplePositionsPx =
        {};  // offsets from pixel centre + jitter, y down; empty without sub-samples
};

// An intermediate image for --debug-layers: 1 or 3 planes, any range.
using DebugLayer = NamedPlanes;

// A running method with its state. Same frames in, same bits out, for every Exec of float precision.
class Method {
  public:
    virtual ~Method() = default;
    // Resolves one frame into `out` (same size as the frame, in the method's output space; its border need not be
    // filled). Temporal methods drop their history when frame.reset is set.
    virtual void resolve(const Frame& frame, const Exec& exec, Rgb& out) = 0;
    virtual size_t stateBytes() const { return 0; }  // history and working memory, of the last frame
    // Of the last frame: at least one when keepDebugLayers was set, none otherwise. Only the family `reference` may
    // have none at all: what a method found (an edge, a weight, a reason) is what `--debug-layers` is asked for.
    virtual std::vector<DebugLayer> debugLayers() const { return {}; }
    bool keepDebugLayers = false;  // set by the driver before the first frame
    // Where history was not used, 0 = it was, in the last frame (methods/temporal/temporal_kernels.h, Rejection); null
    // unless the method is temporal and keepRejection was set before the first frame.
    virtual const PlaneF* rejection() const { return nullptr; }
    bool keepRejection = false;
    // Seconds that a graphics device took for the last frame, by its own clock; none on the CPU.
    virtual std::optional<double> deviceSeconds() const { return {}; }
};

inline constexpr int kAnyReachPx = -1;

// Memory beside the picture that a published GPU implementation reports at 1920 x 1080.
struct PublishedMemory {
    int subSamples;  // per pixel; 0: it does not depend on them
    double megabytes;
    std::string_view source;
};

struct MethodDescriptor {
    std::string_view id, title, family;  // family: reference, spatial, geometry, temporal
    std::string_view summary;            // one sentence
    std::string_view source;             // paper or seed section
    PassSet passes = {};
    Space input = Space::linear, output = Space::linear;
    bool temporal = false;  // accumulates frames: keeps state between them and reads jittered ones
    // The mean of a fixed set of frames, which a history longer than the shot would only weigh unevenly: run without
    // one
    // (--history full).
    bool fixedSet = false;
    bool wantsHistory() const { return temporal && !fixedSet; }
    Sampling sampling() const { return temporal ? Sampling::jittered : Sampling::centre; }
    std::vector<ParamSpec> params = {};
    // Throws UsageError/InputError when the shot cannot serve the method (a static-only method on a moving shot).
    std::function<std::unique_ptr<Method>(const Params&, const ShotInfo&)> create;
    // Passes that depend on the parameters (depth edges need depth); may be empty.
    std::function<PassSet(const Params&)> morePasses = {};
    // Output space that depends on the parameters (blending encoded or linear); empty: `output`.
    std::function<Space(const Params&)> outputSpace = {};
    // Largest distance in px at which a pixel may influence another in one frame: kAnyReachPx where nothing limits it.
    // A method of the family `spatial` states it; for others 0 leaves it unsaid.
    int reachPx = 0;
    // Sub-sample patterns (shot/patterns.h) that serve the method, the best first; empty: any.
    std::vector<std::string_view> patterns = {};
    std::vector<PublishedMemory> publishedMemory = {};
    CodePlace writtenAt = {};  // the file of this descriptor: leave it out, the compiler fills it
};

// Of the method with these parameters.
PassSet passesOf(const MethodDescriptor& method, const Params& params);

// Parameter `space` of the methods that average samples (conventions 4), and what it makes the output.
ParamSpec averagedSpaceParam();
Space averagedSpace(const Params& params);

// All methods, in the order of the documentation.
const std::vector<MethodDescriptor>& registry();
// Throws UsageError with a suggestion.
const MethodDescriptor& findMethod(std::string_view id, const std::vector<MethodDescriptor>& among = registry());

}  // namespace aa
