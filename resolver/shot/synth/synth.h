// Analytic shots: every pass and the ground truth by formula, without a renderer.
//
// A scene is a list of flat-coloured convex polygons and discs, front to back, each on a plane in space and each moving
// rigidly in the picture. A pass is the front-most shape at the sample; the truth is the exact area of every visible
// shape in the pixel, in linear light (coverage.h), so its error bar is 0. Only the zone plate, whose colour varies,
// has a truth of samples: 32 x 32 strata per half. Units and signs are those of frame.h.
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "shot/frame.h"
#include "shot/jitter.h"
#include "shot/manifest.h"
#include "shot/synth/coverage.h"

namespace aa {

inline constexpr const char* kSynthProducer = "aaresolve synth";  // as its manifests say

struct SynthOptions {
    std::string scene = "half_planes";
    int width = 480, height = 270;
    int frames = 16;
    std::string jitter = "halton23";
    int jitterStart = -1;  // as JitterSpec
    int period = 16;
    bool centred = false;
    // The jitter moves the geometry before the projection instead of after it: Manifest::jitterPremultiplied.
    bool premultiplied = false;
    std::string subsamples;       // pattern name; empty: none
    bool subsampleColor = false;  // colour at the sub-samples, too
    uint32_t seed = 1;            // of the colours
    // Scene half_plane: direction of the edge's normal, x towards y, and its distance from the middle of the picture.
    double angleDegrees = 20, offsetPx = 0.25;
    // What writeSynth writes of the frames: everything, or what the chosen methods read. An empty centreWanted leaves
    // the centre-sampled frames out; an unjittered shot needs none in any case.
    std::optional<PassSet> wanted, centreWanted;
    std::optional<glm::ivec2> nanPixel;  // a NaN in the written colours of every frame: to see what becomes of it
};

struct SynthScene {
    std::string_view name, meaning;
};
const std::vector<SynthScene>& synthScenes();

// A shape's place: at rest in its own coordinates, moved by time.
struct RigidMotion {
    glm::dvec2 velocityPx{0.0};  // per frame
    double turn = 0;             // radians per frame, x towards y
    glm::dvec2 pivotPx{0.0};     // at frame time 0
    bool rests() const { return velocityPx == glm::dvec2(0.0) && turn == 0; }
    glm::dvec2 apply(glm::dvec2 p, double time) const;
    glm::dvec2 invert(glm::dvec2 p, double time) const;
};

struct SynthShape {
    Region region;  // px, at time 0
    uint32_t object = 0;
    glm::dvec3 color{0.0};  // linear
    // The plane that it lies on in view space: dot(normalView, P) = distance; the normal faces the camera.
    glm::dvec3 normalView{0.0, 0.0, 1.0};
    double distance = -10;
    RigidMotion motion;
    // Bit i: behind the polygon's edge from corner i the same surface goes on in another shape, so it is no edge to
    // see.
    uint32_t seams = 0;
};

// A shot that can be asked for any frame, in any order. Thread-safe.
class SynthShot {
  public:
    // Throws UsageError: unknown scene, jitter or pattern; sizes out of range; premultiplied without perspective.
    explicit SynthShot(const SynthOptions& options);

    const Manifest& manifest() const { return manifest_; }
    PassSet passes() const { return passes_; }
    Frame frame(size_t index, Sampling sampling = Sampling::jittered) const;
    Truth truth(size_t index) const;

    const std::vector<SynthShape>& shapes() const;  // front to back
    // The picture of frame `index` as a function: linear colour at a position in px. Valid while the shot lives.
    std::function<glm::dvec3(glm::dvec2)> picture(size_t index) const;

  private:
    struct Scene;
    Manifest manifest_;
    PassSet passes_;
    std::shared_ptr<const Scene> scene_;
};

// Writes the shot below `folder` and returns its manifest. A static shot gets one truth and one centre-sampled frame.
// Calls goOn(frame) after each frame; when that returns false the shot ends there, complete in itself.
Manifest writeSynth(const SynthOptions& options, const std::filesystem::path& folder,
                    const std::function<bool(const FrameEntry&)>& goOn = {});

}  // namespace aa
