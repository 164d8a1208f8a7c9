// Temporal metrics (conventions 13.5), fed frame by frame; memory does not grow with the number of frames.
//
// All on display-encoded values. y = BT.601 luma; R = truth, T = the method's image. `q` = p - motion, the true
// un-jittered motion.
//  flickerStatic     255 * mean over pixels of the standard deviation of y_T over time (static shots; truth has 0)
//  flickerStep       255 * mean |y_T(t) - y_T(t-1)| (static shots)
//  flickerMoving     255 * rms over valid pixels of D_T - D_R, D = y(t, p) - B(y(t-1), q): what changes along the
//                    motion beyond what the truth changes
//  ghostMse          mean of (T-R)^2 over the trail: pixels whose surface came into view at most 16 frames ago
//  ghostFraction[a]  share of the stale colour O left at age a: sum (T-R).(O-R) / sum |O-R|^2, clipped to [-1, 1];
//                    O = the picture at q in the frame before the surface came into view (its truth, or its sampled
//                    colours where that frame has none), carried along the motion
//  ghostHalfLife     frames in which ghostFraction falls to half of its value at age 1: -1 / log2(k) for k^age;
//                    absent where no more than a twentieth is stale at each of the ages 1 to 3, and when
//                    the half is not reached
//  tPsnr             PSNR of the MSE pooled over the frames after the warm-up
//  convergence       frames after the start from which the PSNR stays within 0.5 dB of its last value (static shots)
// A pixel is valid, and its surface was visible before, when q is inside the image and the previous 3x3 around q has a
// pixel of the same object whose depth differs by at most 2 %. The window is needed because jittered frames show, at a
// silhouette, now one surface and now the other.
#pragma once
#include <array>
#include <optional>
#include <vector>

#include "image/colour.h"
#include "image/window.h"
#include "kernels/dispatch.h"
#include "shot/frame.h"

namespace aa {

inline constexpr int kGhostAges = 16;
// Frames left out at the start (conventions 13.5).
inline int temporalWarmup(size_t frames) { return int(std::min<size_t>(32, frames / 4)); }
// What the scene must offer for the figures along the motion.
inline PassSet temporalMetricPasses() { return Pass::motion | Pass::depth | Pass::object; }

// What all methods are measured against, computed once per frame.
class TemporalScene {
  public:
    explicit TemporalScene(bool isStatic) : static_(isStatic) {}
    // `truthEncoded` is null for a frame without ground truth. The frame needs the passes above unless it is static.
    void advance(const Frame& frame, const Rgb* truthEncoded, const Exec& exec);

    bool isStatic() const { return static_; }
    int width() const { return width_; }
    int height() const { return height_; }
    int framesSinceReset() const { return frames_; }
    bool alongMotion() const { return alongMotion_; }  // valid(), warp() and age() hold for this frame
    const Rgb* truth() const { return truth_; }        // of this frame, or null
    bool hasTruthStep() const { return truthStep_; }   // truthStep() holds
    const PlaneF& qx() const { return qx_; }           // previous position, px; NaN where not valid
    const PlaneF& qy() const { return qy_; }
    const PlaneF& truthStep() const { return step_; }  // D_R
    // A pixel on the trail: few are, and the same for all methods.
    struct TrailPixel {
        int x;
        uint32_t age;                // 1 to 16
        std::array<float, 3> stale;  // O; NaN when it is not known
    };
    const std::vector<TrailPixel>& trail(int y) const { return trail_[size_t(y)]; }  // of row y, by x

  private:
    using Trail = std::vector<std::vector<TrailPixel>>;
    void followSurfaces(const Frame& frame, const Exec& exec);
    std::array<float, 3> staleAt(const Frame& frame, int x, int y, uint32_t age, const Trail& before) const;

    bool static_;
    int width_ = 0, height_ = 0, frames_ = -1;
    bool alongMotion_ = false, truthStep_ = false;
    const Rgb* truth_ = nullptr;
    Rgb previousPicture_;  // encoded; its truth or, where there is none, its sampled colours
    PlaneF luma_, previousLuma_, qx_, qy_, step_, previousDepth_;
    PlaneU previousId_, age_;
    Trail trail_;
};

struct TemporalMetrics {
    int warmup = 0;  // frames left out at the start
    int frames = 0;  // frames that count
    std::optional<double> tPsnr, flickerStatic, flickerStep, flickerMoving;
    std::optional<double> ghostMse, ghostHalfLife;
    std::optional<double> ghostMseError, flickerError;  // half widths of 95 % intervals; filled by the caller
    std::optional<double> ghostExcess;  // ghostMse over that of noaa in the same run; filled by the caller
    std::vector<double> ghostFraction;  // [a - 1] for age a, up to the oldest that was seen; empty without a trail
    double trailShare = 0;              // mean share of pixels on the trail
    std::optional<int> convergence;
};

// What the latest frame added to the figures; their spread over the frames is the error bar.
struct TemporalFrame {
    double ghostSquares = 0, ghostValues = 0;      // (T-R)^2 on the trail
    double flickerSquares = 0, flickerPixels = 0;  // (D_T - D_R)^2 along the motion; static: (y_T(t) - y_T(t-1))^2
};

// One method's figures, of the whole picture or of a region, whose surfaces may have come from beside it.
class TemporalJudge {
  public:
    explicit TemporalJudge(int warmup, std::optional<Window> region = {}) : warmup_(warmup), region_(region) {}
    // After scene.advance() for the same frame. `encoded` has a filled border; `mse`: its squared error against the
    // truth, of the region where there is one, if that is known; `luma`: its pictureLuma(), or empty.
    void add(const TemporalScene& scene, const Rgb& encoded, const Exec& exec, std::optional<double> mse = {},
             PlaneF luma = {});
    TemporalMetrics result() const;
    const TemporalFrame& latest() const { return latest_; }  // zeros during the warm-up

  private:
    // Sums over the pixels on the trail, and of those of one age.
    struct TrailSums {
        double squares = 0, pixels = 0;
        std::array<double, kGhostAges> along{}, norm{};
        TrailSums& operator+=(const TrailSums& other);
    };
    void addStatic(const PlaneF& luma, bool hasPrevious, const Exec& exec);
    void addFlicker(const TemporalScene& scene, const PlaneF& luma, const Exec& exec);
    void addTrail(const TemporalScene& scene, const Rgb& encoded);
    int warmup_;
    std::optional<Window> region_;
    Window area_;  // the region, or the picture
    int seen_ = 0;
    TemporalFrame latest_;
    double squaredError_ = 0;
    int framesWithTruth_ = 0;
    // static: running mean and sum of squared deviations per pixel
    PlaneF mean_, spread_;
    int counted_ = 0;
    double stepSum_ = 0;
    int steps_ = 0;
    // moving
    PlaneF previousLuma_;
    bool isStatic_ = false;
    double motionSquares_ = 0, motionPixels_ = 0;
    TrailSums trail_;
    double trailFrames_ = 0;    // pixels of all frames
    std::vector<double> psnr_;  // per frame with truth
};

}  // namespace aa
