#include "methods/spatial/deaa.h"

#include "kernels/sparse.h"

// The fit and the isolines are computed in double in every precision: they are sparse, and a fit near its tolerance
// must not depend on the form.
namespace AA_ARCH {
using namespace aa;

template <class R>
AA_INLINE vec3<R> sampleAt(const DeaaArgs& a, int k, long o) {
    const RgbIn& s = a.samples[k];
    return {load<R>(s.c[0] + o), load<R>(s.c[1] + o), load<R>(s.c[2] + o)};
}
// Mean of the samples (the box resolve), and the pixels whose samples are not all of one colour.
template <class R>
__attribute__((flatten)) void markRows(const DeaaArgs& a, int y0, int y1) {
    using T = Elem<R>;
    const R share(T(1) / T(a.sampleCount)), same(T(a.sameColour));
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            const vec3<R> first = sampleAt<R>(a, 0, o);
            vec3<R> sum(R(T(0))), lowest = first, highest = first;
            for (int k = 1; k < a.sampleCount; k++) {
                const vec3<R> c = sampleAt<R>(a, k, o);
                sum = sum + (c - first);
                lowest = min(lowest, c);
                highest = max(highest, c);
            }
            const vec3<R> mean = first + sum * share;
            store(mean.x, a.out.c[0] + o);
            store(mean.y, a.out.c[1] + o);
            store(mean.z, a.out.c[2] + o);
            const auto edge = maxComponent(highest - lowest) > same;
            storeMaskBytes<R>(edge, edge, a.edgesOut + long(y) * a.edgeStride + x);
        }
}
AA_INLINE int edgePixelsAround(const DeaaArgs& a, int x, int y) {
    int n = 0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) n += a.edges[long(y + j) * a.edgeStride + x + i] != 0;
    return n;
}
struct Plane {
    double gx, gy, mean;
    bool fits;
};
AA_INLINE double lumaOfSample(const DeaaArgs& a, int k, long o) {
    const RgbIn& s = a.samples[k];
    return 0.2126 * s.c[0][o] + 0.7152 * s.c[1][o] + 0.0722 * s.c[2][o];
}
// Least-squares plane through the luma of all samples of the window.
AA_INLINE Plane fittedPlane(const DeaaArgs& a, long o) {
    double values[9 * kDeaaMaxSamples], sum = 0, sx = 0, sy = 0, lowest = 1e30, highest = -1e30, mx = 0, my = 0;
    int n = 0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            for (int k = 0; k < a.sampleCount; k++, n++) {
                const double v = lumaOfSample(a, k, o + long(j) * a.stride + i);
                values[n] = v;
                sum += v;
                lowest = min(lowest, v);
                highest = max(highest, v);
                mx += a.xPx[k] + i;
                my += a.yPx[k] + j;
            }
    const double mean = sum / n;
    mx /= n;
    my /= n;
    n = 0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            for (int k = 0; k < a.sampleCount; k++, n++) {
                sx += (a.xPx[k] + i - mx) * (values[n] - mean);
                sy += (a.yPx[k] + j - my) * (values[n] - mean);
            }
    Plane p{a.invXX * sx + a.invXY * sy, a.invXY * sx + a.invYY * sy, mean, false};
    double squares = 0;
    n = 0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            for (int k = 0; k < a.sampleCount; k++, n++) {
                const double e = values[n] - mean - p.gx * (a.xPx[k] + i - mx) - p.gy * (a.yPx[k] + j - my);
                squares += e * e;
            }
    p.fits = sqrt(squares / n) <= a.fitTolerance * (highest - lowest);
    return p;
}
// Length of the line through (px, py) along (tx, ty) inside the unit square around the origin.
AA_INLINE double chord(double px, double py, double tx, double ty) {
    double from = -1e30, to = 1e30;
    for (int axis = 0; axis < 2; axis++) {
        const double p = axis ? py : px, t = axis ? ty : tx;
        if (abs(t) < 1e-12) {
            if (abs(p) > 0.5) return 0;
            continue;
        }
        const double a = (-0.5 - p) / t, b = (0.5 - p) / t;
        from = max(from, min(a, b));
        to = min(to, max(a, b));
    }
    return max(0.0, to - from);
}
AA_INLINE void filterPixel(const DeaaArgs& a, int x, int y) {
    const long o = long(y) * a.stride + x;
    const int around = edgePixelsAround(a, x, y);
    if (around < 2 || around == 9) return;  // isolated or complex: the box stays
    const Plane plane = fittedPlane(a, o);
    const double gradient = sqrt(plane.gx * plane.gx + plane.gy * plane.gy);
    if (!plane.fits || !(gradient > 1e-12)) return;
    const double tx = -plane.gy / gradient, ty = plane.gx / gradient;  // along the isolines
    double total = 0, sum[3] = {0, 0, 0};
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++)
            for (int k = 0; k < a.sampleCount; k++) {
                const double px = a.xPx[k] + i, py = a.yPx[k] + j;
                if (abs(px * tx + py * ty) > 0.5 * a.maxLengthPx) continue;
                const double w = chord(px, py, tx, ty);
                if (!(w > 0)) continue;
                total += w;
                for (int c = 0; c < 3; c++) sum[c] += w * a.samples[k].c[c][o + long(j) * a.stride + i];
            }
    if (!(total > 0)) return;
    for (int c = 0; c < 3; c++) a.out.c[c][o] = float(sum[c] / total);
    if (a.applied) a.applied[o] = 1;
}
template <class R>
__attribute__((flatten)) void filterRows(const DeaaArgs& a, int y0, int y1) {
    if (a.invXX == 0 && a.invYY == 0) return;  // singular fit: all samples on a line
    for (int y = y0; y < y1; y++)
        for (int x0 = 0; x0 < a.width; x0 += 8)
            forEachByte(
                loadBytes(a.edges + long(y) * a.edgeStride + x0), [&](int i) __attribute__((always_inline)) {
                    if (x0 + i < a.width) filterPixel(a, x0 + i, y);
                });
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::DeaaKernels, deaaKernels) = {AA_ROWS(markRows), AA_ROWS(filterRows)};
