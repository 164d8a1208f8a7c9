// The input sanitiser (conventions 8): what a shot's planes may hold before any method sees them.
#pragma once
#include <span>
#include <string>

#include "image/exr.h"
#include "shot/reader.h"

namespace aa {

// Names a plane in strict mode's errors: file, frame, part and the channels' names.
struct PlaneName {
    std::string where;  // "SHOT/frames/000001.exr: frame 1, part 'color'"
    std::vector<std::string> channels;
};

// Radiance: NaN -> mean of the finite pixels of its 3x3 (none finite: 0), +Inf -> 1e30 (65504 where the file holds
// half), -Inf and negative -> 0. The counts are pixels times channels. Under strict any NaN or Inf throws.
void sanitiseColour(Rgb& colour, bool storedAsHalf, InputPolicy policy, const PlaneName& name, SanitiseCounts& counts);
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
