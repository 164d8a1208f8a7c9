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
AA_INLINE Mask<R> isFinite(vec3<R> c) {
    const R zero(Elem<R>(0));
    return both(both(c.x - c.x == zero, c.y - c.y == zero), c.z - c.z == zero);
}

template <class R>
AA_INLINE SurfacePoint<R> surfacePoint(const float* depthView, const aa::RgbIn& normalWorld, long o) {
    return {load<R>(depthView + o), load3<R>(normalWorld, o)};
}
template <class R>
AA_INLINE SurfacePoint<R> centrePoint(const aa::GeometryArgs& g, long o) {
    return surfacePoint<R>(g.depthView, g.normalWorld, o);
}
template <class R>
AA_INLINE SurfacePoint<R> samplePoint(const aa::GeometryArgs& g, int k, long o) {
    return surfacePoint<R>(g.sample[k].depthView, g.sample[k].normalWorld, o);
}
// From the point seen (fromX, fromY) px beside the centre sample of pixel (x, y) to the one seen (dx, dy) px farther.
template <class R>
AA_INLINE Separation<R> separation(const aa::GeometryArgs& g, R x, std::type_identity_t<R> y, float fromX, float fromY,
                                   float dx, float dy) {
    using T = Elem<R>;
    const R sx{T(dx)}, sy{T(dy)};
    return {
        broadcast3<R>(g.ray) + broadcast3<R>(g.rayX) * (x + R(T(fromX))) + broadcast3<R>(g.rayY) * (y + R(T(fromY))),
        broadcast3<R>(g.rayX) * sx + broadcast3<R>(g.rayY) * sy,
        broadcast3<R>(g.originX) * sx + broadcast3<R>(g.originY) * sy};
}
// From the centre sample of pixel (x, y) to its sub-sample k.
template <class R>
AA_INLINE Separation<R> toSample(const aa::GeometryArgs& g, R x, std::type_identity_t<R> y, int k) {
    return separation(g, x, y, 0.0f, 0.0f, g.sample[k].offsetPx[0], g.sample[k].offsetPx[1]);
}

// The dense part of a sparse method: marked[i] gets the lanes of the i-th group of pixels from column x0 in which
// differs(k, x, o) holds for some sub-sample. One sub-sample at a time over a chunk of a row, while the next one's
// chunk is fetched: all planes start at the same place in a memory page, so that forty of them side by side push each
// other out of the first-level cache, and a chunk is too short for the processor to foresee the next lines by itself.
inline constexpr int kChunk = 256;  // pixels
template <class R>
AA_INLINE int chunkGroups(int width) {  // groups of lanes that cover it, at most a chunk
    return ((width < kChunk ? width : kChunk) + N<R> - 1) / N<R>;
}
template <class R>
AA_INLINE void copyChunk(const aa::RgbIn& from, const aa::RgbOut& to, int width, long o) {
    const int groups = chunkGroups<R>(width);
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < groups; i++) store(load<R>(from.c[c] + o + i * N<R>), to.c[c] + o + i * N<R>);
}
template <class R>
AA_INLINE void fillChunk(float value, float* to, int width) {
    const int groups = chunkGroups<R>(width);
    for (int i = 0; i < groups; i++) store(R(Elem<R>(value)), to + i * N<R>);
}
template <class R>
struct Marks {
    uint32_t lanes[kChunk / N<R>];
};
// Fetches what the group of pixels at o will read of sub-sample k.
AA_INLINE void prefetchSample(const aa::GeometryArgs& g, int k, long o) {
    const aa::SubSampleArgs& s = g.sample[k];
    __builtin_prefetch(s.depthView + o);
    for (int c = 0; c < 3; c++)
        if (s.normalWorld.c[c]) __builtin_prefetch(s.normalWorld.c[c] + o);
    if (s.objectId) __builtin_prefetch(s.objectId + o);
}
// The same for the sub-sample that a chunk-wise loop visits after k: the next one, or the first of the next chunk.
AA_INLINE void prefetchNext(const aa::GeometryArgs& g, int k, long o) {
    k + 1 < g.samples ? prefetchSample(g, k + 1, o) : prefetchSample(g, 0, o + kChunk);
}
template <class R, class Differs>
AA_INLINE void mark(const aa::GeometryArgs& g, int x0, int y, Marks<R>& marks, const Differs& differs) {
    const int groups = chunkGroups<R>(g.width - x0);
    for (int i = 0; i < groups; i++) marks.lanes[i] = 0;
    for (int k = 0; k < g.samples; k++)
        for (int i = 0; i < groups; i++) {
            const int x = x0 + i * N<R>;
            const long o = long(y) * g.stride + x;
            prefetchNext(g, k, o);
            marks.lanes[i] |= maskBits<R>(differs(k, x, o));
        }
}
// Calls edgePixel(x, y) for every marked pixel of the chunk that starts at x0; not for row padding.
template <class R, class EdgePixel>
AA_INLINE void forMarked(const Marks<R>& marks, int width, int x0, int y, const EdgePixel& edgePixel) {
    for (int i = 0; i < chunkGroups<R>(width - x0); i++)
        for (int lane = 0; marks.lanes[i] >> lane; lane++) {
            const int x = x0 + i * N<R> + lane;
            if (marks.lanes[i] >> lane & 1u && x < width) edgePixel(x, y);
        }
}

}  // namespace AA_ARCH
