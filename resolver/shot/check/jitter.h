// Where were the samples? Registers the edges of a point-sampled picture against the box mean of the same picture.
//
// At a straight edge of contrast K and normal n (towards the brighter side) the point sample is one of the two sides
// and the mean is the covered area. Over all offsets of such an edge the difference sample - mean averages to K (n . j)
// / w on the pixels that the edge crosses, w = |n_x| + |n_y| being the width of that band. So a least-squares fit of
// (sample - mean) / K on n / w gives the jitter j in px, without bias for isolated edges; thin or busy parts make it
// shorter, never turn it. Where the offsets are few the fit cannot be trusted: no frame is called wrong unless its edge
// pixels themselves side against what is stated (edge_votes.h).
#pragma once
#include "shot/check/check.h"
#include "shot/check/edge_votes.h"
#include "shot/manifest.h"

namespace aa {

struct Registration {
    glm::dvec2 offsetPx{0.0};  // sample position minus pixel centre, y down
    glm::dvec2 sigmaPx{0.0};   // standard error
    size_t pixels = 0;         // that an edge crosses
    EdgeVotes votes;
};
// The corners of a pixel: the extent of a box mean.
inline const std::vector<glm::dvec2> kPixelCorners = {{-0.5, -0.5}, {0.5, -0.5}, {-0.5, 0.5}, {0.5, 0.5}};
// Planes hold one or more channels of equal size. `meanOver`: positions in the pixel between which the mean is taken
// (the pixel's corners, or the samples of the frames averaged); the offset is relative to their mean. `usable`: pixels
// != 0 take part (empty: all).
Registration registerSamples(const std::vector<const PlaneF*>& sample, const std::vector<const PlaneF*>& mean,
                             const std::vector<glm::dvec2>& meanOver = kPixelCorners,
                             const Plane<uint8_t>& usable = {});

// Compares what was found in the pixels with the manifest.
class JitterCheck {
  public:
    // `meanOver`: as registerSamples took it, if not the pixel's corners.
    explicit JitterCheck(std::vector<glm::dvec2> meanOver = {}) : meanOver_(std::move(meanOver)) {}
    // `slackPx`: how far the mean picture itself may lie off.
    void add(const FrameEntry& entry, const Registration& found, double slackPx = 0);
    size_t size() const { return frames_.size(); }
    void judge(CheckReport& report) const;
    // found = scale x stated, per axis, over the frames that could be registered; nothing without any jitter.
    std::optional<glm::dvec2> scaleFound() const;

  private:
    struct Registered {
        int frame;
        glm::dvec2 statedPx;
        Registration found;
        double slackPx;
    };
    std::vector<Registered> registered() const;
    bool judgeTogether(const std::vector<Registered>& good, CheckReport& report) const;
    MeanOf meanOf(const glm::dmat2& change) const;
    // The stated jitter of all frames against `change` of it.
    Contest contest(const std::vector<Registered>& good, const glm::dmat2& change) const;
    void nameUntold(const std::vector<Registered>& good, CheckReport& report) const;
    std::vector<glm::dvec2> meanOver_;
    std::vector<Registered> frames_;
};

}  // namespace aa
