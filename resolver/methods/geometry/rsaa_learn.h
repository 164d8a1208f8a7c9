// Learns RSAA's look-up table: one resampling offset per mask of similar sub-samples (decisions 33).
//
// The talk [Reshetov 2012, slides 28-30] learns the table from "a simple set that can be anti-aliased analytically" and
// does not say which. Ours: black-and-white pictures around one pixel, with exact coverage by polygon clipping, of
// three classes with total weights 1 : 1/4 : 1/4:
//   half-planes  720 angles x 301 distances in [-0.75, 0.75] px on a regular grid;
//   wedges       2e5, two random half-planes whose lines cross at an apex in [-1, 1]^2;
//   strips       1e5, 0.2 to 1.5 px wide, every position that can touch the pixel.
// The offset of a mask minimises the squared error of the bilinear fetch at centre + offset over the cases that show
// this mask. Inside one quadrant of offsets the fetch is bilinear in |u| and |v|, so ten moments per mask and quadrant
// hold the whole training set and the search is exact at every grid point.
//
// Deterministic to the bit on every machine: only + - * / and integers (own sine, own random numbers).
#pragma once
#include <cstdint>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

namespace aa {

struct RsaaEntry {
    uint32_t mask;  // bit k: sub-sample k lies on the surface of the centre sample
    int16_t u, v;   // offset in units of 1/256 px, y down
    bool operator==(const RsaaEntry&) const = default;
};
inline constexpr double kRsaaOffsetUnitPx = 1.0 / 256;  // 1/32 grid, three halvings of the step
inline constexpr int kRsaaMaxSamples = 16;

// The training classes: all three, or half-planes alone (the alternative of decisions 33).
enum class RsaaTraining { all, halfPlanes };

// The D3D11 standard pattern of 1, 2, 4, 8 or 16 sub-samples (shot/patterns.h).
std::vector<glm::dvec2> d3dPattern(size_t samples);

// Entries of every mask with at least 20 training cases, by ascending mask; the all-ones mask is not an entry.
// 1 <= positionsPx.size() <= kRsaaMaxSamples; offsets from the pixel centre, y down.
std::vector<RsaaEntry> learnRsaa(const std::vector<glm::dvec2>& positionsPx, RsaaTraining training);

// The whole table of 2^samples offsets in px (u, v interleaved): trained entries, (0, 0) for all ones, and for the rest
// the mean over the trained masks at the smallest Hamming distance.
std::vector<float> rsaaTable(size_t samples, std::span<const RsaaEntry> trained);

// Mean squared errors of a black-and-white pixel against its exact coverage, over random half-planes (conventions 14):
// one sample at the centre, the mean of the sub-samples, and the resampled centre.
struct RsaaErrors {
    double noaa = 0, msaa = 0, rsaa = 0;
};
RsaaErrors halfPlaneErrors(const std::vector<glm::dvec2>& positionsPx, const std::vector<float>& table);

}  // namespace aa
