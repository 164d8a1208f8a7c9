// The limits of kernels/surfaces.h.
#pragma once

namespace aa {
struct SurfaceRule {
    float cosine;         // of the normals, at least
    float planeDistance;  // of one point from the other's tangent plane, at most, relative to its depth
};
inline constexpr SurfaceRule kSameSurface{0.95f, 0.01f};  // [Salvi 2012]
}  // namespace aa
