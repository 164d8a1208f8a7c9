// How far apart two surface points are: depth, normal, or SADP, the sum of absolute dot products [Reshetov 2012].
// Included by *.kernel.cpp files after kernels/lanes.h.
//
// A point is its planar depth, its normal and its object. The vector between two points is formed from the difference
// of their depths, which is exact for close points, and from their distance on the image plane, never from the
// difference of two far positions: float keeps its direction at any distance from the camera.
#pragma once
#include "kernels/dissimilarity.h"
#include "kernels/lanes.h"

namespace AA_ARCH {

template <class R>
struct SurfacePoint {
    R depthView;
    vec3<R> normalWorld;
};
// !(z < 1e9) is background: 1e10 by convention, and NaN.
template <class R>
AA_INLINE Mask<R> isBackground(R depthView) {
    return negate(depthView < R(Elem<R>(1e9)));
}
// A missing normal is zero or NaN; unit ones may carry the error of half floats.
template <class R>
AA_INLINE Mask<R> hasNormal(vec3<R> n) {
    return dot(n, n) >= R(Elem<R>(0.25));
}
template <class R>
AA_INLINE vec3<R> validNormal(vec3<R> n) {
    return select(hasNormal(n), n, vec3<R>(R(Elem<R>(0))));
}

// World-space vector from a point a to a point b that lies (dx, dy) px beside it.
template <class R>
struct Separation {
    vec3<R> rayA;        // position of a per unit of depth, relative to the camera
    vec3<R> stepRay;     // dx * d(ray)/dx + dy * d(ray)/dy
    vec3<R> stepOrigin;  // the same for the depth-independent part; zero for a perspective camera
    AA_INLINE vec3<R> vector(R depthA, R depthB) const {
        return rayA * (depthB - depthA) + (stepRay * depthB + stepOrigin);
    }
};

inline constexpr double kFarthest = 2;  // SADP's largest value; what a surface and the background, or two objects, get

// In [0, 2]. Two background points are 0 apart, background and surface 2.
template <aa::Dissimilarity kind, class R>
AA_INLINE R dissimilarity(const SurfacePoint<R>& a, const SurfacePoint<R>& b, const Separation<R>& s) {
    using T = Elem<R>;
    const R zero(T(0)), one(T(1)), farthest{T(kFarthest)};
    R d = zero;
    if constexpr (kind == aa::Dissimilarity::depth) {
        d = min(farthest, abs(a.depthView - b.depthView) / min(a.depthView, b.depthView));
    } else {
        const vec3<R> na = validNormal(a.normalWorld), nb = validNormal(b.normalWorld);
        d = one - dot(na, nb);
        if constexpr (kind == aa::Dissimilarity::sadp) {
            const vec3<R> v = s.vector(a.depthView, b.depthView);
            const R length2 = dot(v, v), limit = R(T(1e-6)) * max(one, a.depthView);
            const auto complete = both(hasNormal(na), hasNormal(nb));
            const auto coincident = negate(length2 >= limit * limit);  // no direction: the normals alone decide
            const R along = (abs(dot(na, v)) + abs(dot(nb, v))) / sqrt(select(coincident, one, length2));
            d = select(coincident, d, along + select(complete, zero, one));
        }
    }
    const auto emptyA = isBackground(a.depthView), emptyB = isBackground(b.depthView);
    return select(both(emptyA, emptyB), zero, select(either(emptyA, emptyB), farthest, d));
}

// False only where dissimilarity() < limit, up to rounding, without its root and divisions: what most pixels of a
// picture need to know.
template <aa::Dissimilarity kind, class R>
AA_INLINE Mask<R> surfacesMayDiffer(const SurfacePoint<R>& a, const SurfacePoint<R>& b, const Separation<R>& s,
                                    R limit) {
    using T = Elem<R>;
    const auto emptyA = isBackground(a.depthView), emptyB = isBackground(b.depthView);
    Mask<R> same;
    if constexpr (kind == aa::Dissimilarity::depth) {
        same = abs(a.depthView - b.depthView) < limit * min(a.depthView, b.depthView);
    } else if constexpr (kind == aa::Dissimilarity::normal) {
        same = R(T(1)) - dot(a.normalWorld, b.normalWorld) < limit;
    } else {
        const vec3<R> v = s.vector(a.depthView, b.depthView);
        const R along = abs(dot(a.normalWorld, v)) + abs(dot(b.normalWorld, v)), length2 = dot(v, v);
        const R coincident = R(T(1e-6)) * max(R(T(1)), a.depthView);
        same = both(both(along * along < limit * limit * length2, length2 >= coincident * coincident),
                    both(hasNormal(a.normalWorld), hasNormal(b.normalWorld)));
    }
    // Two surfaces that are the same, or two backgrounds.
    return negate(either(both(emptyA, emptyB), both(both(negate(emptyA), negate(emptyB)), same)));
}

}  // namespace AA_ARCH
