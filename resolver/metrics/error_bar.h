// How far a figure can be trusted when the reference itself has finitely many samples (conventions 13.9), and whether
// two methods differ by more than chance gives.
//
// What an interval is of: the mean squared error of pictures like this one, against the exact truth. It holds two
// doubts, that of the truth's noise and that of where in the picture the methods differ.
//
//  - The truth's noise biases a squared error, to first order by its variance and, through the curved display encoding,
//    to second order by its shift. With the halves a and b and their mean m, 2 e(m) - e(a)/2 - e(b)/2 is free of both
//    (the jackknife of two; without an encoding that is the product of the errors against a and against b). Where noise
//    exceeds the light itself, higher orders remain: what the second took off a difference widens its interval.
//  - The picture is cut into 16 parts (9 where those hang together), whose sums are compared by Student's t: right for
//    few parts, and not too narrow when they differ in spread [Ibragimov 2010]. What neighbouring parts still have in
//    common widens it, and takes half of the degrees of freedom, being estimated from the same parts; where it is too
//    much, the picture is too small to judge.
//  - Errors that sit in few places spread so widely over the parts that Student's t sees nothing. Where all parts agree
//    but for one at most, the sign test tells: it does not ask how large an error is.
//
// Deterministic: no resampling.
#pragma once
#include <optional>
#include <span>
#include <string_view>

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

// One picture's (or sequence's) squared error by parts of a grid, row-major.
struct ErrorParts {
    int columns = 0, rows = 0;
    std::vector<double> squares;  // sums, free of the truth's noise; may be below zero
    std::vector<double> halves;   // sum against one half of the truth less that against the other
    double measured = 0;          // sum over all parts, with the truth's noise
    std::vector<double> values;   // how many pixel channels each holds
};
// As 4 x 4 parts or 16 in another shape, and as 9: parts near square, of whole tiles. Neither for too small a picture.
std::vector<ErrorParts> errorParts(const TileErrors& errors);

// Why a difference is not resolved.
enum class Unresolved {
    no,          // it is resolved
    truthNoise,  // most of the doubt is the truth's noise: render the truth with more samples
    varies,      // the difference varies over the picture (or over time): more pictures would tell
    tooSmall,    // too few independent parts (or frames) for an interval
    equal        // there is no difference, or none beyond the rounding of float
};
std::string_view nameOf(Unresolved why);             // in results.json
Unresolved unresolvedByName(std::string_view name);  // throws std::runtime_error
std::string_view inWords(Unresolved why);
std::string_view inShort(Unresolved why);  // for tables

// Paired comparison of two methods over the same frames and truth.
struct Comparison {
    double mseDifference = 0;            // MSE(first) - MSE(second): negative when the first is nearer to the truth
    double low = 0, high = 0;            // its 95 % interval
    double gainDb = 0;                   // PSNR(first) - PSNR(second), against the exact truth
    double gainLow = 0, gainHigh = 0;    // its 95 % interval [Fieller 1954], which holds 0 where the difference's does
    bool resolved = false;               // the interval excludes zero
    Unresolved why = Unresolved::equal;  // then all of the above is 0
};
Comparison compareMethods(std::span<const ErrorParts> first, std::span<const ErrorParts> second);
Comparison compareMethods(const TileErrors& first, const TileErrors& second);
// PSNR(first) - PSNR(second) of this very picture, whose only doubt is the truth's noise: for two runs of one shot,
// where what differs over the picture is no chance. 95 %; zero width against an exact truth. Absent where the noise
// leaves nothing of an error.
struct GainInterval {
    double low = 0, high = 0;
};
std::optional<GainInterval> gainOnThisPicture(const ErrorParts& first, const ErrorParts& second);

// One frame's share of a mean over frames, which is all sums over all counts.
struct FrameSum {
    double sum = 0, count = 0;
};
// 95 % intervals of figures over time by the jackknife: 8 blocks of consecutive frames (or as many as there are frames)
// are left out in turn. Blocks, because frames that follow each other share their history; what neighbouring blocks
// still have in common widens the interval. Absent below 4 blocks, where the blocks hang together, and where a figure
// is zero.
std::optional<double> errorOverTime(std::span<const FrameSum> frames);  // half width, in the figure's unit
struct TimeComparison {
    double gainDb = 0;  // 10 log10(second / first): positive when the first has less of it
    double low = 0, high = 0;
    bool resolved = false;  // the interval excludes zero
};
// Both series belong to the same frames.
std::optional<TimeComparison> compareOverTime(std::span<const FrameSum> first, std::span<const FrameSum> second);

}  // namespace aa
