#include "methods/geometry/dmsaa.h"

#include "kernels/lanes.h"
#include "kernels/resample.h"
#include "kernels/subsamples.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
struct Dmsaa {
    using T = Elem<R>;
    const DmsaaArgs& a;
    const GeometryArgs& g = *a.geometry;

    // |z - zc| > tau min(z, zc); equal depths, the background's too, never differ. S: lanes or one pixel.
    template <class S>
    AA_INLINE Mask<S> differs(int k, long o) const {
        const S z = load<S>(g.sample[k].depthView + o), centre = load<S>(g.depthView + o);
        return abs(z - centre) > S(Elem<S>(a.depthThreshold)) * min(z, centre);
    }
    AA_INLINE void edgePixel(int x, int y) const {
        const long o = long(y) * g.stride + x;
        T sumX = 0, sumY = 0;
        int count = 0;
        for (int k = 0; k < g.samples; k++) {
            if (!differs<T>(k, o)) continue;
            sumX = sumX + T(a.positionsPx[2 * k]), sumY = sumY + T(a.positionsPx[2 * k + 1]);
            count++;
        }
        const T length = sqrt(sumX * sumX + sumY * sumY);
        T scale = 0;
        if (length > T(1e-6)) switch (a.vector) {
                case DmsaaVector::perS:
                    scale = T(1) / T(g.samples);
                    break;
                case DmsaaVector::perD:
                    scale = T(1) / T(count);
                    break;
                case DmsaaVector::ideal:
                    scale = T(count) / T(g.samples) / length;
                    break;
            }
        const T one(1), u = clamp(sumX * scale * T(a.gain), -one, one), v = clamp(sumY * scale * T(a.gain), -one, one);
        const vec3<T> c = resample<T>(a.color, g.stride, x, y, u, v);
        a.out.c[0][o] = float(c.x), a.out.c[1][o] = float(c.y), a.out.c[2][o] = float(c.z);
        if (a.countLayer) a.countLayer[o] = float(count), a.offsetXLayer[o] = float(u), a.offsetYLayer[o] = float(v);
    }
    AA_INLINE void markEdges(int x0, int y, Marks<R>& marks) const {
        mark<R>(
            g, x0, y, marks, [&](int k, int, long o) __attribute__((always_inline)) { return differs<R>(k, o); });
    }
    AA_INLINE void rows(int y0, int y1) const {
        for (int y = y0; y < y1; y++)
            for (int x0 = 0; x0 < g.width; x0 += kChunk) {
                const long o = long(y) * g.stride + x0;
                Marks<R> marks;
                markEdges(x0, y, marks);
                copyChunk<R>(a.color, a.out, g.width - x0, o);
                forMarked<R>(marks, g.width, x0, y, [&](int x, int row) { edgePixel(x, row); });
            }
    }
};

template <class R>
__attribute__((flatten)) void dmsaaRows(const DmsaaArgs& a, int y0, int y1) {
    Dmsaa<R>{a}.rows(y0, y1);
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::DmsaaKernels, dmsaaKernels) = {AA_ROWS(dmsaaRows)};
