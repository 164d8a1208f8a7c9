#include "metrics/temporal.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "metrics/metrics.h"
#include "metrics/temporal_kernels.h"

namespace aa {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

void fit(PlaneF& p, int w, int h) {
    if (p.width() != w || p.height() != h) p = PlaneF(w, h);
}
// Two sums over the rows of `area` in a fixed order, whatever the number of threads.
template <class Args>
std::array<double, 2> sumRows(const RowKernel<Args>& kernel, const Exec& exec, const Window& area, Args args) {
    std::vector<double> rows(2 * size_t(area.y + area.height));
    args.rows = rows.data(), args.first = area.x, args.end = area.x + area.width;
    const auto fn = rowsOf(kernel, exec.precision);
    forRows(exec, area.height, [&](int y0, int y1) { fn(args, area.y + y0, area.y + y1); });
    std::array<double, 2> total{};
    for (size_t i = 0; i < rows.size(); i++) total[i % 2] += rows[i];
    return total;
}
// Position (x, y) in px inside [0, W] x [0, H]; the border is filled, so the taps need no clamp.
float bilinear(const PlaneF& p, float x, float y) {
    const float u = x - 0.5f, v = y - 0.5f, fu = std::floor(u), fv = std::floor(v), s = u - fu, t = v - fv;
    const float* a = p.row(int(fv)) + int(fu);
    const float* b = a + p.stride();
    const float top = s == 0 ? a[0] : a[0] + (a[1] - a[0]) * s;
    if (t == 0) return top;
    const float bottom = s == 0 ? b[0] : b[0] + (b[1] - b[0]) * s;
    return top + (bottom - top) * t;
}
// Frames in which `fraction`, by age, falls to half of its first value; between two ages it is taken as exponential.
// Where nothing stale is to be seen, nothing halves.
std::optional<double> halfLife(const std::vector<double>& fraction) {
    if (fraction.empty()) return {};
    const double half = fraction[0] / 2;
    if (*std::max_element(fraction.begin(), fraction.begin() + std::min<ptrdiff_t>(3, std::ssize(fraction))) <= 0.05)
        return {};
    for (size_t a = 1; a < fraction.size(); a++) {
        const double before = fraction[a - 1], after = fraction[a];
        if (after > half) continue;
        const double share =
            after > 0 ? std::log(before / half) / std::log(before / after) : (before - half) / (before - after);
        return double(a - 1) + share;
    }
    return {};
}

}  // namespace

void TemporalScene::advance(const Frame& frame, const Rgb* truthEncoded, const Exec& exec) {
    const bool fresh = frame.reset || frames_ < 0 || frame.width != width_ || frame.height != height_;
    width_ = frame.width, height_ = frame.height;
    frames_ = fresh ? 0 : frames_ + 1;
    const bool hadTruth = !fresh && truth_ != nullptr;
    truth_ = truthEncoded;
    truthStep_ = alongMotion_ = false;
    if (static_) return;

    std::swap(luma_, previousLuma_);
    if (truth_) luma_ = pictureLuma(*truth_, exec);
    if (frame.motionXPx.empty() || frame.depthView.empty() || frame.objectId.empty()) return;
    if (fresh)
        age_ = PlaneU(width_, height_), trail_.assign(size_t(height_), {});
    else
        followSurfaces(frame, exec);
    alongMotion_ = !fresh;
    if (alongMotion_ && truth_ && hadTruth) {
        fit(step_, width_, height_);
        const StepArgs args{.luma = luma_.row(0),
                            .previous = previousLuma_.row(0),
                            .qx = qx_.row(0),
                            .qy = qy_.row(0),
                            .stride = luma_.stride(),
                            .end = width_,
                            .step = step_.row(0)};
        runKernel(temporalMetricKernelsFor(exec).step, exec, args, height_);
        truthStep_ = true;
    }
    previousDepth_ = frame.depthView;
    previousId_ = frame.objectId;
    if (truth_)
        previousPicture_ = *truth_;
    else if (!frame.colorLinear.empty())
        encode(frame.colorLinear, frame.display, exec, previousPicture_);
    else
        previousPicture_ = Rgb();
}

// Was the surface of each pixel visible one frame ago, and since when is it?
void TemporalScene::followSurfaces(const Frame& frame, const Exec& exec) {
    fit(qx_, width_, height_), fit(qy_, width_, height_);
    const PlaneU previousAge = std::exchange(age_, PlaneU::unset(width_, height_));
    const FollowArgs args{.motionXPx = frame.motionXPx.row(0),
                          .motionYPx = frame.motionYPx.row(0),
                          .depth = frame.depthView.row(0),
                          .previousDepth = previousDepth_.row(0),
                          .id = frame.objectId.row(0),
                          .previousId = previousId_.row(0),
                          .previousAge = previousAge.row(0),
                          .oldest = kGhostAges,
                          .stride = age_.stride(),
                          .width = width_,
                          .height = height_,
                          .qx = qx_.row(0),
                          .qy = qy_.row(0),
                          .age = age_.row(0)};
    runKernel(temporalMetricKernelsFor(exec).follow, exec, args, height_);
    const Trail before = std::exchange(trail_, Trail(size_t(height_)));
    forRows(exec, height_, [&](int y0, int y1) {
        for (int y = y0; y < y1; y++)
            for (int x = 0; x < width_; x++)
                if (const uint32_t age = age_.at(x, y); age > 0)
                    trail_[size_t(y)].push_back({x, age, staleAt(frame, x, y, age, before)});
    });
}

// What was to be seen where the pixel comes from; carried along the motion once it is on the trail.
std::array<float, 3> TemporalScene::staleAt(const Frame& frame, int x, int y, uint32_t age, const Trail& before) const {
    constexpr std::array kUnknown{kNan, kNan, kNan};
    const float px = float(x) + 0.5f - frame.motionXPx.at(x, y), py = float(y) + 0.5f - frame.motionYPx.at(x, y);
    if (age > 1) {
        const auto& row = before[size_t(std::min(int(py), height_ - 1))];
        const int column = std::min(int(px), width_ - 1);
        const auto at = std::lower_bound(row.begin(), row.end(), column,
                                         [](const TrailPixel& p, int sought) { return p.x < sought; });
        // In double precision it may have come from the pixel beside.
        return at != row.end() && at->x == column ? at->stale : kUnknown;
    }
    if (previousPicture_.empty()) return kUnknown;
    const auto channel = [&](size_t c) { return bilinear(previousPicture_.c[c], px, py); };
    return {channel(0), channel(1), channel(2)};
}

void TemporalJudge::add(const TemporalScene& scene, const Rgb& encoded, const Exec& exec, std::optional<double> mse,
                        PlaneF y) {
    area_ = region_.value_or(Window{0, 0, scene.width(), scene.height()});
    const bool counts = seen_ >= warmup_;
    latest_ = {};
    isStatic_ = scene.isStatic();
    const Rgb* truth = scene.truth();
    if (truth) {
        if (!mse)
            mse = (region_ ? squaredError(cropped(encoded, area_), cropped(*truth, area_), exec)
                           : squaredError(encoded, *truth, exec))
                      .mse;
        psnr_.push_back(psnr(*mse));
        if (counts) squaredError_ += *mse, framesWithTruth_++;
    }
    if (y.empty()) y = pictureLuma(encoded, exec);
    // A step between two frames that count.
    const bool hasPrevious = seen_++ > warmup_ && scene.framesSinceReset() > 0;
    if (counts && scene.isStatic()) addStatic(y, hasPrevious, exec);
    if (counts && scene.alongMotion()) {
        if (scene.hasTruthStep() && hasPrevious) addFlicker(scene, y, exec);
        if (truth) addTrail(scene, encoded);
    }
    previousLuma_ = std::move(y);
}

void TemporalJudge::addStatic(const PlaneF& y, bool hasPrevious, const Exec& exec) {
    fit(mean_, y.width(), y.height()), fit(spread_, y.width(), y.height());
    const auto sums = sumRows(temporalMetricKernelsFor(exec).spread, exec, area_,
                              SpreadArgs{.luma = y.row(0),
                                         .previous = hasPrevious ? previousLuma_.row(0) : nullptr,
                                         .stride = y.stride(),
                                         .count = ++counted_,
                                         .mean = mean_.row(0),
                                         .spread = spread_.row(0)});
    if (!hasPrevious) return;
    const double pixels = double(area_.width) * area_.height;
    stepSum_ += sums[0] / pixels, steps_++;
    latest_.flickerSquares = sums[1], latest_.flickerPixels = pixels;
}

void TemporalJudge::addFlicker(const TemporalScene& scene, const PlaneF& y, const Exec& exec) {
    const auto sums = sumRows(temporalMetricKernelsFor(exec).step, exec, area_,
                              StepArgs{.luma = y.row(0),
                                       .previous = previousLuma_.row(0),
                                       .qx = scene.qx().row(0),
                                       .qy = scene.qy().row(0),
                                       .stride = y.stride(),
                                       .truthStep = scene.truthStep().row(0)});
    motionSquares_ += sums[0], motionPixels_ += sums[1];
    latest_.flickerSquares = sums[0], latest_.flickerPixels = sums[1];
}

void TemporalJudge::addTrail(const TemporalScene& scene, const Rgb& encoded) {
    const Rgb& truth = *scene.truth();
    TrailSums frame;
    for (int y = area_.y; y < area_.y + area_.height; y++) {
        TrailSums row;
        for (const auto& [x, age, stale] : scene.trail(y)) {
            if (x < area_.x || x >= area_.x + area_.width) continue;
            double squares = 0, along = 0, norm = 0;
            for (size_t c = 0; c < 3; c++) {
                const double r = double(truth.c[c].at(x, y)), e = double(encoded.c[c].at(x, y)) - r;
                const double o = double(stale[c]) - r;
                squares += e * e, along += e * o, norm += o * o;
            }
            row.squares += squares, row.pixels++;
            if (norm == norm) row.along[age - 1] += along, row.norm[age - 1] += norm;
        }
        frame += row;
    }
    trail_ += frame;
    latest_.ghostSquares = frame.squares, latest_.ghostValues = 3 * frame.pixels;
    trailFrames_ += double(area_.width) * area_.height;
}
TemporalJudge::TrailSums& TemporalJudge::TrailSums::operator+=(const TrailSums& other) {
    squares += other.squares, pixels += other.pixels;
    for (size_t a = 0; a < kGhostAges; a++) along[a] += other.along[a], norm[a] += other.norm[a];
    return *this;
}

TemporalMetrics TemporalJudge::result() const {
    TemporalMetrics m;
    m.warmup = warmup_;
    m.frames = std::max(0, seen_ - warmup_);
    if (framesWithTruth_ > 0) m.tPsnr = psnr(squaredError_ / framesWithTruth_);
    if (counted_ > 1) {
        double sum = 0;
        for (int y = area_.y; y < area_.y + area_.height; y++) {
            double row = 0;
            for (int x = area_.x; x < area_.x + area_.width; x++)
                row += std::sqrt(std::max(0.0, double(spread_.at(x, y))) / counted_);
            sum += row;
        }
        m.flickerStatic = 255 * sum / (double(area_.width) * area_.height);
        if (steps_ > 0) m.flickerStep = 255 * stepSum_ / steps_;
    }
    if (motionPixels_ > 0) m.flickerMoving = 255 * std::sqrt(motionSquares_ / motionPixels_);
    if (trail_.pixels > 0) {
        m.ghostMse = trail_.squares / (3 * trail_.pixels);
        m.trailShare = trail_.pixels / trailFrames_;
        for (size_t a = 0; a < kGhostAges && trail_.norm[a] > 0; a++)
            m.ghostFraction.push_back(std::clamp(trail_.along[a] / trail_.norm[a], -1.0, 1.0));
        m.ghostHalfLife = halfLife(m.ghostFraction);
    }
    if (isStatic_ && psnr_.size() > 1) {
        const double last = psnr_.back();
        size_t from = psnr_.size();
        while (from > 0 && (psnr_[from - 1] == last || std::fabs(psnr_[from - 1] - last) <= 0.5)) from--;
        m.convergence = int(from);
    }
    return m;
}

}  // namespace aa
