// The segments part of a frame's file: a list of edges as a picture of its own size.
//
// N segments fill a data window of min(N, 4096) by ceil(N / 4096) pixels row by row, six float channels x0 y0 z0 x1 y1
// z1. What is left over, and the single pixel of an empty list, has z0 = 0.
#pragma once
#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "image/plane.h"
#include "shot/edge_segment.h"
#include "shot/sanitise.h"

namespace aa {

inline constexpr int kSegmentsPerRow = 4096;
inline constexpr std::array<std::string_view, 6> kSegmentChannels = {"x0", "y0", "z0", "x1", "y1", "z1"};
using SegmentPlanes = std::array<PlaneF, 6>;

bool isUsable(const EdgeSegment& segment);
SegmentPlanes packSegments(std::span<const EdgeSegment> segments);
// Numbers that are not finite and depths <= 0 make a segment unusable: an error under strict, else it is left out and
// counted; under raw it stays.
std::vector<EdgeSegment> unpackSegments(const SegmentPlanes& planes, InputPolicy policy, const PlaneName& name,
                                        SanitiseCounts& counts);

}  // namespace aa
