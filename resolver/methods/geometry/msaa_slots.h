// What msaa and csaa read, which sub-samples hold a colour, and what the others and the filters make of them.
#pragma once
#include <glm/vec2.hpp>
#include <string_view>
#include <vector>

#include "methods/geometry/subsample_geometry.h"
#include "methods/reference/resolve_filters_kernels.h"

namespace aa {
class Params;

GeometryNeeds surfaceNeeds(const Params& params);

// Sub-samples are counted as in slotsFirst everywhere else.
struct CoverageSlots {
    std::vector<int> slotsFirst;   // the shot's sub-samples, those with a colour first
    int slots = 0;                 // how many hold one
    std::vector<int> order;        // by distance from the pixel centre
    std::vector<int> nearestSlot;  // of each sub-sample
    std::vector<ResolveTap> taps;  // of another filter than the box over the pixel; empty: no filter follows
};
// Throws InputError where the filter needs another pattern, UsageError where the pattern has fewer sub-samples than
// slots.
CoverageSlots msaaSlots(const Params& params, const std::vector<glm::dvec2>& positionsPx);
CoverageSlots csaaSlots(const Params& params, const std::vector<glm::dvec2>& positionsPx);

}  // namespace aa
