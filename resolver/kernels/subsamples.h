// Reading centre samples and sub-samples as surface points. Included by *.kernel.cpp files.
// R is lanes of neighbouring pixels or one of them.
#pragma once
#include "kernels/sadp.h"
#include "kernels/subsample_args.h"

namespace AA_ARCH {

template <class R>
AA_INLINE vec3<R> load3(const aa::RgbIn& image, long o) {
    return {load<R>(image.c[0] + o), load<R>(image.c[1] + o), load<R>(image.c[2] + o)};
}
template <class R>
AA_INLINE vec3<R> broadcast3(const float* v) {
    using T = Elem<R>;
    return {R(T(v[0])), R(T(v[1])), R(T(v[2]))};
}
template <class R>
AA_INLINE R columns(int x) {
    return R(Elem<R>(x)) + iota<R>();
}
// Finite means x - x == 0: Inf - Inf and NaN - NaN are NaN.
template <class R>
AA_INLINE Mask<R> is_finite(vec3<R> c) {
    const R zero(Elem<R>(0));
    return both(both(c.x - c.x == zero, c.y - c.y == zero), c.z - c.z == zero);
}

template <class R>
AA_INLINE SurfacePoint<R> surface_point(const float* depthView, const aa::RgbIn& normalWorld, long o) {
    return {load<R>(depthView + o), load3<R>(normalWorld, o)};
}
template <class R>
AA_INLINE SurfacePoint<R> centre_point(const aa::GeometryArgs& g, long o) {
    return surface_point<R>(g.depthView, g.normalWorld, o);
}
template <class R>
AA_INLINE SurfacePoint<R> sample_point(const aa::GeometryArgs& g, int k, long o) {
    return surface_point<R>(g.sample[k].depthView, g.sample[k].normalWorld, o);
}
// From the point seen (fromX, fromY) px beside the centre sample of pixel (x, y) to the one seen (dx, dy) px farther.
template <class R>
AA_INLINE Separation<R> separation(const aa::GeometryArgs& g, R x, int y, float fromX, float fromY, float dx,
                                   float dy) {
    using T = Elem<R>;
    const R sx{T(dx)}, sy{T(dy)};
    return {
        broadcast3<R>(g.ray) + broadcast3<R>(g.rayX) * (x + R(T(fromX))) + broadcast3<R>(g.rayY) * R(T(y) + T(fromY)),
        broadcast3<R>(g.rayX) * sx + broadcast3<R>(g.rayY) * sy,
        broadcast3<R>(g.originX) * sx + broadcast3<R>(g.originY) * sy};
}
// From the centre sample of pixel (x, y) to its sub-sample k.
template <class R>
AA_INLINE Separation<R> to_sample(const aa::GeometryArgs& g, R x, int y, int k) {
    return separation(g, x, y, 0.0f, 0.0f, g.sample[k].offsetPx[0], g.sample[k].offsetPx[1]);
}

}  // namespace AA_ARCH
