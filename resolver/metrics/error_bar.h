// How far a figure can be trusted when the reference itself has finitely many samples (methods/07 s.9), and whether two
// methods differ by more than that.
#pragma once
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
    double mseDifference = 0;  // MSE(first) - MSE(second): negative when the first is nearer to the truth
    double low = 0, high = 0;  // bootstrap 95 % interval of that difference over tiles of 32 x 32 px
    double gainDb = 0;         // PSNR(first) - PSNR(second)
    bool resolved = false;     // |difference| exceeds the truth's noise and the interval excludes zero
};
// `noise` is truthNoise of the same frames. 1000 resamples with a fixed seed; same input, same result.
Comparison compareMethods(const TileErrors& first, const TileErrors& second, double noise);

}  // namespace aa
