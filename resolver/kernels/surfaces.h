// When two geometry samples belong to one surface [Salvi 2012]: their normals agree and one lies near the other's
// tangent plane. Included by *.kernel.cpp files.
#pragma once
#include "kernels/subsamples.h"
#include "kernels/surface_rule.h"

namespace AA_ARCH {

// Two backgrounds are one surface. Without normals on both sides only the depths are compared.
template <class R>
AA_INLINE Mask<R> sameSurface(const aa::SurfaceRule& rule, const SurfacePoint<R>& a, const SurfacePoint<R>& b,
                              const Separation<R>& s) {
    using T = Elem<R>;
    const R tolerance = R(T(rule.planeDistance)) * a.depthView;
    const auto agree = both(dot(a.normalWorld, b.normalWorld) >= R(T(rule.cosine)),
                            abs(dot(a.normalWorld, s.vector(a.depthView, b.depthView))) <= tolerance);
    const auto known = either(hasNormal(a.normalWorld), hasNormal(b.normalWorld));
    const auto level = abs(a.depthView - b.depthView) <= tolerance;
    const auto emptyA = isBackground(a.depthView), emptyB = isBackground(b.depthView);
    const auto neither = both(negate(emptyA), negate(emptyB));
    return either(both(emptyA, emptyB), both(neither, either(agree, both(negate(known), level))));
}

// Pairs of one pixel's samples, scalar: -1 is the centre sample, 0 and up its sub-samples.
template <class T>
struct PixelSurfaces {
    const aa::GeometryArgs& g;
    const aa::SurfaceRule& rule;
    int x, y;

    AA_INLINE long at() const { return long(y) * g.stride + x; }
    AA_INLINE SurfacePoint<T> point(int k) const {
        return k < 0 ? centrePoint<T>(g, at()) : samplePoint<T>(g, k, at());
    }
    AA_INLINE Separation<T> between(int a, int b) const {
        const float ax = a < 0 ? 0.0f : g.sample[a].offsetPx[0], ay = a < 0 ? 0.0f : g.sample[a].offsetPx[1];
        const float bx = b < 0 ? 0.0f : g.sample[b].offsetPx[0], by = b < 0 ? 0.0f : g.sample[b].offsetPx[1];
        return separation(g, T(x), y, ax, ay, bx - ax, by - ay);
    }
    AA_INLINE uint32_t object(int k) const { return (k < 0 ? g.objectId : g.sample[k].objectId)[at()]; }
    AA_INLINE bool sameObject(int a, int b) const { return object(a) == object(b); }
    AA_INLINE bool sameGeometry(int a, int b) const { return sameSurface(rule, point(a), point(b), between(a, b)); }
};

}  // namespace AA_ARCH
