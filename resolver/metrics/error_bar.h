// How far a figure can be trusted when the reference itself has finitely many samples (conventions 13.9), and whether
// two methods differ by more than that.
#pragma once
#include <optional>
#include <span>

#include "metrics/metrics.h"

namespace aa {

// The truth is the mean of two independent halves a and b; the expected squared error of that mean is MSE(a, b) / 4.
// It biases every measured MSE upward by as much.
inline double truthNoise(double mseOfHalves) { return mseOfHalves / 4; }

// An MSE measured against a noisy truth: the exact one lies near `corrected`, never above `raw` but for sampling error.
struct MseInterval {
    double corrected = 0, raw = 0;
};
MseInterval mseInterval(double raw, double noise);

// Paired comparison of two methods over the same frames and truth.
struct Comparison {
    double mseDifference = 0;          // MSE(first) - MSE(second): negative when the first is nearer to the truth
    double low = 0, high = 0;          // bootstrap 95 % interval of that difference over tiles of 32 x 32 px
    double gainDb = 0;                 // PSNR(first) - PSNR(second)
    double gainLow = 0, gainHigh = 0;  // its bootstrap 95 % interval, widened by what the truth's noise may hide
    bool resolved = false;             // |difference| exceeds the truth's noise and the interval excludes zero
};
// `noise` is truthNoise of the same frames. 1000 resamples with a fixed seed; same input, same result.
Comparison compareMethods(const TileErrors& first, const TileErrors& second, double noise);

// One frame's share of a mean over frames, which is all sums over all counts.
struct FrameSum {
    double sum = 0, count = 0;
};
// 95 % intervals of figures over time by the jackknife: up to 8 blocks of consecutive frames are left out in turn.
// Blocks, because frames that follow each other share their history. Absent below 3 blocks, and where a figure is zero.
std::optional<double> errorOverTime(std::span<const FrameSum> frames);  // half width, in the figure's unit
struct TimeComparison {
    double gainDb = 0;  // 10 log10(second / first): positive when the first has less of it
    double low = 0, high = 0;
    bool resolved = false;  // the interval excludes zero
};
// Both series belong to the same frames.
std::optional<TimeComparison> compareOverTime(std::span<const FrameSum> first, std::span<const FrameSum> second);

}  // namespace aa
