#include "methods/geometry/gbaa.h"

#include "kernels/lanes.h"
#include "kernels/resample.h"

namespace AA_ARCH {
using namespace aa;

// The edge distances of a pixel and of the neighbours that may point at it. R: lanes of pixels, or one.
template <class R>
struct EdgeDistances {
    R x, y, leftX, rightX, upY, downY;
    AA_INLINE EdgeDistances(const EdgeBlendArgs& a, long o)
        : x(load<R>(a.edgeXPx + o)),
          y(load<R>(a.edgeYPx + o)),
          leftX(load<R>(a.edgeXPx + o - 1)),
          rightX(load<R>(a.edgeXPx + o + 1)),
          upY(load<R>(a.edgeYPx + o - a.stride)),
          downY(load<R>(a.edgeYPx + o + a.stride)) {}
    // An edge between a neighbour's border and this pixel's centre, seen from that neighbour.
    static AA_INLINE Mask<R> ahead(R d) { return both(d > R(Elem<R>(0.5)), d < R(Elem<R>(1))); }
    static AA_INLINE Mask<R> behind(R d) { return both(d > R(Elem<R>(-1)), d < R(Elem<R>(-0.5))); }
    AA_INLINE Mask<R> cutHere() const {
        return either(abs(x) < R(Elem<R>(0.5)), abs(y) < R(Elem<R>(0.5)));  // false for NaN
    }
    AA_INLINE Mask<R> cutByNeighbour() const {
        return either(either(ahead(leftX), behind(rightX)), either(ahead(upY), behind(downY)));
    }
};
template <class T>
struct Shift {
    T x, y;
};
// Half a pixel beyond an edge at signed distance d: the fetch then blends as much of the neighbour as lies beyond it.
template <class T>
AA_INLINE T beyond(T d) {
    return !(abs(d) < T(0.5)) ? T(0) : (d >= T(0) ? T(0.5) : T(-0.5)) - d;
}

// The pixel's own edge, else the last neighbour's in the order left, right, up, down.
template <class T>
AA_INLINE Shift<T> gbaaShift(const EdgeDistances<T>& e) {
    if (e.cutHere()) return {beyond(e.x), beyond(e.y)};
    const T none = T(0.5);
    T x = none, y = none;
    if (e.ahead(e.leftX)) x = e.leftX - T(1), y = none;
    if (e.behind(e.rightX)) x = e.rightX + T(1), y = none;
    if (e.ahead(e.upY)) x = none, y = e.upY - T(1);
    if (e.behind(e.downY)) x = none, y = e.downY + T(1);
    return {beyond(x), beyond(y)};
}
// The nearest edge on each axis, from both sides of the pixel's borders.
template <class T>
AA_INLINE T nearest(T own, T before, T after) {
    T best = abs(own) < T(0.5) ? own : T(0.5);
    if (EdgeDistances<T>::ahead(before) && abs(before - T(1)) < abs(best)) best = before - T(1);
    if (EdgeDistances<T>::behind(after) && abs(after + T(1)) < abs(best)) best = after + T(1);
    return best;
}
template <class T>
AA_INLINE Shift<T> d2eShift(const EdgeDistances<T>& e) {
    return {beyond(nearest(e.x, e.leftX, e.rightX)), beyond(nearest(e.y, e.upY, e.downY))};
}

template <bool perAxis, class R>
AA_INLINE void blendRows(const EdgeBlendArgs& a, int y0, int y1) {
    using T = Elem<R>;
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            for (int c = 0; c < 3; c++) store(load<R>(a.color.c[c] + o), a.out.c[c] + o);
            const EdgeDistances<R> e(a, o);
            unsigned marked = maskBits<R>(e.cutHere());
            if (perAxis || a.searchNeighbours) marked |= maskBits<R>(e.cutByNeighbour());
            for (int i = 0; marked >> i && x + i < a.width; i++) {
                if (!(marked >> i & 1u)) continue;
                const EdgeDistances<T> own(a, o + i);
                const Shift<T> s = perAxis ? d2eShift(own) : gbaaShift(own);
                const vec3<T> c = resample<T>(a.color, a.stride, x + i, y, s.x, s.y);
                a.out.c[0][o + i] = float(c.x), a.out.c[1][o + i] = float(c.y), a.out.c[2][o + i] = float(c.z);
                if (a.offsetXLayer) a.offsetXLayer[o + i] = float(s.x), a.offsetYLayer[o + i] = float(s.y);
            }
        }
}
template <class R>
__attribute__((flatten)) void gbaaRows(const EdgeBlendArgs& a, int y0, int y1) {
    blendRows<false, R>(a, y0, y1);
}
template <class R>
__attribute__((flatten)) void d2eRows(const EdgeBlendArgs& a, int y0, int y1) {
    blendRows<true, R>(a, y0, y1);
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::GbaaKernels, gbaaKernels) = {AA_WIDE_ROWS(gbaaRows), AA_WIDE_ROWS(d2eRows)};
