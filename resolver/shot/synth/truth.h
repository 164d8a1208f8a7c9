// The truth of a synthetic picture.
#pragma once
#include "image/plane.h"
#include "shot/synth/placed.h"

namespace aa {

// Exact: each visible shape counts by its area in the pixel.
void areaTruth(const std::vector<Placed>& frontToBack, glm::dvec3 background, Rgb& to);

inline constexpr int kZonePlateStrata = 32;  // per axis and half
void zonePlateTruth(uint32_t half, Rgb& to);

}  // namespace aa
