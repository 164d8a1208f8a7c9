#include "metrics/error_bar.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>

#include "metrics/pcg32.h"

namespace aa {
namespace {
FrameSum total(std::span<const FrameSum> frames) {
    FrameSum t;
    for (const auto& f : frames) t.sum += f.sum, t.count += f.count;
    return t;
}
// Half width of the 95 % interval of statistic(frames kept), where frames [first, last) are left out block by block.
std::optional<double> jackknife(size_t frames, const std::function<double(size_t first, size_t last)>& statistic) {
    // Student's t, 97.5 %, for 2 to 7 degrees of freedom.
    constexpr double kStudent[] = {4.303, 3.182, 2.776, 2.571, 2.447, 2.365};
    const size_t blocks = std::min<size_t>(8, frames);
    if (blocks < 3) return {};
    std::vector<double> without;
    double mean = 0, squares = 0;
    for (size_t b = 0; b < blocks; b++) {
        without.push_back(statistic(b * frames / blocks, (b + 1) * frames / blocks));
        mean += without.back() / double(blocks);
    }
    for (const double v : without) squares += (v - mean) * (v - mean);
    const double half = kStudent[blocks - 3] * std::sqrt(squares * double(blocks - 1) / double(blocks));
    return std::isfinite(half) ? std::optional(half) : std::nullopt;
}
}  // namespace

MseInterval mseInterval(double raw, double noise) { return {std::max(0.0, raw - noise), raw}; }

Comparison compareMethods(const TileErrors& first, const TileErrors& second, double noise) {
    assert(first.sum.size() == second.sum.size() && !first.sum.empty());
    constexpr size_t kResamples = 1000;  // conventions 13.9
    const size_t tiles = first.sum.size();
    std::vector<double> difference(tiles);
    for (size_t i = 0; i < tiles; i++) difference[i] = first.sum[i] - second.sum[i];

    Comparison c;
    const double mseFirst = first.squaredError().mse, mseSecond = second.squaredError().mse;
    c.mseDifference = mseFirst - mseSecond;
    c.gainDb = mseFirst == mseSecond ? 0 : psnr(mseFirst) - psnr(mseSecond);

    Pcg32 random;
    std::vector<double> resampled(kResamples), gains(kResamples);
    for (size_t r = 0; r < kResamples; r++) {
        double sum = 0, values = 0, ofFirst = 0, ofSecond = 0;
        for (size_t i = 0; i < tiles; i++) {
            const size_t tile = random.below(tiles);
            sum += difference[tile];
            ofFirst += first.sum[tile];
            ofSecond += second.sum[tile];
            values += first.values[tile];
        }
        resampled[r] = sum / values;
        gains[r] = ofFirst == ofSecond ? 0 : psnr(ofFirst / values) - psnr(ofSecond / values);
    }
    std::sort(resampled.begin(), resampled.end());
    std::sort(gains.begin(), gains.end());
    c.low = resampled[size_t(0.025 * kResamples)];
    c.high = resampled[size_t(0.975 * kResamples) - 1];
    c.gainLow = gains[size_t(0.025 * kResamples)];
    c.gainHigh = gains[size_t(0.975 * kResamples) - 1];
    // Both errors are too large by the noise; without it the gain moves away from zero.
    if (mseFirst > noise && mseSecond > noise) {
        const double shift = psnr(mseFirst - noise) - psnr(mseSecond - noise) - (psnr(mseFirst) - psnr(mseSecond));
        (shift > 0 ? c.gainHigh : c.gainLow) += std::isfinite(shift) ? shift : 0;
    }
    c.resolved = std::abs(c.mseDifference) > noise && (c.low > 0 || c.high < 0);
    return c;
}

std::optional<double> errorOverTime(std::span<const FrameSum> frames) {
    const FrameSum all = total(frames);
    if (!(all.sum > 0)) return {};
    return jackknife(frames.size(), [&](size_t first, size_t last) {
        const FrameSum out = total(frames.subspan(first, last - first));
        return (all.sum - out.sum) / (all.count - out.count);
    });
}

std::optional<TimeComparison> compareOverTime(std::span<const FrameSum> first, std::span<const FrameSum> second) {
    assert(first.size() == second.size());
    const FrameSum a = total(first), b = total(second);
    if (!(a.sum > 0) || !(b.sum > 0)) return {};
    const auto half = jackknife(first.size(), [&](size_t from, size_t to) {
        return 10 * std::log10((b.sum - total(second.subspan(from, to - from)).sum) /
                               (a.sum - total(first.subspan(from, to - from)).sum));
    });
    if (!half) return {};
    const double gain = 10 * std::log10(b.sum / a.sum);
    return TimeComparison{gain, gain - *half, gain + *half, std::abs(gain) > *half};
}

}  // namespace aa
