#include "methods/spatial/edge_blur.h"

#include "kernels/sparse.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
AA_INLINE R lumaAt(const EdgeBlurArgs& a, long o, int dx, int dy) {
    return load<R>(a.luma + o + long(dy) * a.stride + dx);
}
// Bilinear value minus the centre at a displacement from the pixel at p, |displacement| <= 6 px.
template <class T>
AA_INLINE T tapDifference(const float* p, long stride, T dx, T dy) {
    const T ax = floor(dx), ay = floor(dy), fx = dx - ax, fy = dy - ay, own = T(p[0]);
    const float* const q = p + long(ay) * stride + long(ax);
    const T top = (T(q[0]) - own) * (T(1) - fx) + (T(q[1]) - own) * fx;
    const T bottom = (T(q[stride]) - own) * (T(1) - fx) + (T(q[stride + 1]) - own) * fx;
    return top * (T(1) - fy) + bottom * fy;
}
template <class T>
AA_INLINE T pairDifference(const float* p, long stride, T dx, T dy) {
    return tapDifference(p, stride, dx, dy) + tapDifference(p, stride, -dx, -dy);
}
// Copies a group of pixels and calls blur(x, o, lane) for those that the mask marks.
template <class R, class Blur>
AA_INLINE void copyAndBlur(const EdgeBlurArgs& a, int x, long o, Mask<R> marked, const Blur& blur) {
    for (int c = 0; c < 3; c++) store(load<R>(a.in.c[c] + o), a.out.c[c] + o);
    const unsigned bits = maskBits<R>(marked);
    if (!bits) return;
    int list[N<R> + 1];
    const int count = appendMarked(bits, 0, a.width - x < N<R> ? a.width - x : N<R>, list, 0);
    for (int i = 0; i < count; i++) blur(o + list[i], list[i]);
}
template <class T>
AA_INLINE void writeDirection(const EdgeBlurArgs& a, long o, T nx, T ny) {
    if (!a.directionX) return;
    a.directionX[o] = float(nx);
    a.directionY[o] = float(ny);
}
template <class R>
__attribute__((flatten)) void nfaaRows(const EdgeBlurArgs& a, int y0, int y1) {
    using T = Elem<R>;
    const int s = a.scalePx;
    const R strength(T(a.strength)), zero(T(0));
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            const R nw = lumaAt<R>(a, o, -s, -s), n = lumaAt<R>(a, o, 0, -s), ne = lumaAt<R>(a, o, s, -s),
                    w = lumaAt<R>(a, o, -s, 0), e = lumaAt<R>(a, o, s, 0), sw = lumaAt<R>(a, o, -s, s),
                    so = lumaAt<R>(a, o, 0, s), se = lumaAt<R>(a, o, s, s);
            // The gradient turned by 90 degrees: along the edge, whatever its orientation.
            const R nx = strength * (((sw - nw) + (se - ne)) + (so - n)),
                    ny = strength * (((nw - ne) + (sw - se)) + (w - e));
            alignas(64) T along[2][N<R>];
            for (int k = 0; k < 2; k++)
                for (int i = 0; i < N<R>; i++) {
                    const R& v = k ? ny : nx;
                    if constexpr (N<R> == 1)
                        along[k][i] = v;
                    else
                        along[k][i] = v.v[i];
                }
            copyAndBlur<R>(
                a, x, o, either(nx != zero, ny != zero), [&](long p, int lane) __attribute__((always_inline)) {
                    T vx = along[0][lane], vy = along[1][lane];
                    const T length = sqrt(vx * vx + vy * vy), limit = T(a.longestPx);
                    if (length > limit) vx = vx * (limit / length), vy = vy * (limit / length);
                    for (int c = 0; c < 3; c++) {
                        const float* const q = a.in.c[c] + p;
                        const T sum = pairDifference(q, a.stride, vx, vy) +
                                      pairDifference(q, a.stride, vx * T(0.5), vy * T(-0.5));
                        a.out.c[c][p] = float(T(q[0]) + sum * T(0.2));
                    }
                    writeDirection(a, p, vx, vy);
                });
        }
}
template <class R>
AA_INLINE R lumaToward(const EdgeBlurArgs& a, long o, int dx, int dy, int wholePx, R fraction) {
    const R near = lumaAt<R>(a, o, dx * wholePx, dy * wholePx);
    return near + (lumaAt<R>(a, o, dx * (wholePx + 1), dy * (wholePx + 1)) - near) * fraction;
}
template <class R>
__attribute__((flatten)) void ssssaaRows(const EdgeBlurArgs& a, int y0, int y1) {
    using T = Elem<R>;
    const int whole = int(a.reachPx);
    const R fraction(T(a.reachPx) - T(whole)), threshold(T(a.threshold));
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            const R top = lumaToward<R>(a, o, 0, -1, whole, fraction),
                    bottom = lumaToward<R>(a, o, 0, 1, whole, fraction),
                    left = lumaToward<R>(a, o, -1, 0, whole, fraction),
                    right = lumaToward<R>(a, o, 1, 0, whole, fraction);
            const R nx = bottom - top, ny = right - left, length = sqrt(nx * nx + ny * ny);
            const auto edge = length >= threshold;
            const R scale = R(T(1)) / max(length, R(T(1e-12)));
            alignas(64) T along[2][N<R>];
            const R unit[2] = {nx * scale, ny * scale};
            for (int k = 0; k < 2; k++)
                for (int i = 0; i < N<R>; i++) {
                    if constexpr (N<R> == 1)
                        along[k][i] = unit[k];
                    else
                        along[k][i] = unit[k].v[i];
                }
            copyAndBlur<R>(
                a, x, o, edge, [&](long p, int lane) __attribute__((always_inline)) {
                    const T vx = along[0][lane], vy = along[1][lane];
                    for (int c = 0; c < 3; c++) {
                        const float* const q = a.in.c[c] + p;
                        const T sum = T(0.9) * pairDifference(q, a.stride, vx * T(0.5), vy * T(0.5)) +
                                      T(0.75) * pairDifference(q, a.stride, vx, vy);
                        a.out.c[c][p] = float(T(q[0]) + sum * T(1 / 4.3));
                    }
                    writeDirection(a, p, vx, vy);
                });
        }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::EdgeBlurKernels, edgeBlurKernels) = {AA_WIDE_ROWS(nfaaRows), AA_WIDE_ROWS(ssssaaRows)};
