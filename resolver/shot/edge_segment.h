// An edge of the scene's geometry, projected: a silhouette, a border or a crease. Plain, so that kernels may read it.
#pragma once

namespace aa {

// Both ends: position in the un-jittered picture, px, x right, y down, also outside of it; planar view-space depth > 0.
struct EdgeSegment {
    float x0, y0, z0, x1, y1, z1;
    bool operator==(const EdgeSegment&) const = default;
};

}  // namespace aa
