// The input sanitiser (conventions 8): what a shot's planes may hold before any method sees them. Colours:
// image/input_policy.h. Under raw what would be replaced is counted and stays.
#pragma once
#include <span>
#include <string>

#include "image/exr.h"
#include "shot/reader.h"

namespace aa {

// NaN, <= 0, Inf -> background; everything beyond 1e9 becomes exactly 1e10 (uncounted). Under strict NaN, Inf and <= 0
// throw.
void sanitiseDepth(PlaneF& depth, InputPolicy policy, const PlaneName& name, SanitiseCounts& counts);
// Not finite -> (0, 0, 0).
void sanitiseNormal(Rgb& normal, InputPolicy policy, const PlaneName& name, SanitiseCounts& counts);
// Not finite -> kInvalidMotionPx in both components: no place in the previous picture.
void sanitiseMotion(PlaneF& motionXPx, PlaneF& motionYPx, InputPolicy policy, const PlaneName& name,
                    SanitiseCounts& counts);
// Not finite -> (0.5, 0.5): no edge cuts this pixel (conventions 3).
void sanitiseEdges(PlaneF& edgeXPx, PlaneF& edgeYPx, InputPolicy policy, const PlaneName& name, SanitiseCounts& counts);

// The same on the planes of one group of channels of a pass (shot/pass_table.h), in the order of the channels.
using SanitisePlanes = void(std::span<const PlaneRef> planes, bool storedAsHalf, InputPolicy policy,
                            const PlaneName& name, SanitiseCounts& counts);
SanitisePlanes sanitiseColourPlanes, sanitiseDepthPlanes, sanitiseNormalPlanes, sanitiseMotionPlanes,
    sanitiseEdgesPlanes;

}  // namespace aa
