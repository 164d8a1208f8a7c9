#include "kernels/lanes.h"
#include "kernels/resample.h"
#include "kernels/subsamples.h"
#include "methods/rsaa_kernels.h"

namespace AA_ARCH {
using namespace aa;

template <Dissimilarity measure, class R>
struct Rsaa {
    using T = Elem<R>;
    const RsaaArgs& a;
    const GeometryArgs& g = *a.geometry;
    const uint32_t full = (1u << a.samples) - 1u;

    template <class S>  // R, or one lane of it
    static AA_INLINE SurfacePoint<S> point(const float* depthView, const RgbIn& normalWorld, long o) {
        if constexpr (measure == Dissimilarity::depth)
            return {load<S>(depthView + o), vec3<S>(S(Elem<S>(0)))};
        else
            return surface_point<S>(depthView, normalWorld, o);
    }
    AA_INLINE SurfacePoint<R> centre(long o) const { return point<R>(g.depthView, g.normalWorld, o); }
    AA_INLINE SurfacePoint<R> sample(int k, long o) const {
        return point<R>(g.sample[k].depthView, g.sample[k].normalWorld, o);
    }

    // Lanes in which some sub-sample may be another surface.
    AA_INLINE unsigned suspects(int x, int y, long o) const {
        const auto own = centre(o);
        const R limit{T(a.floor)};
        Mask<R> any = limit < R(T(0));
        for (int k = 0; k < a.samples; k++) {
            any = either(any, may_differ<measure>(own, sample(k, o), to_sample(g, columns<R>(x), y, k), limit));
            if (g.objectId) any = either(any, ids_differ<R>(g.objectId + o, g.sample[k].objectId + o));
        }
        return mask_bits<R>(any);
    }
    // Bit k of mask[lane] is 1 where sub-sample k is similar to the centre; farthest[lane] is the largest
    // dissimilarity.
    AA_INLINE void cluster(int x, int y, long o, int* mask, float* farthestOut) const {
        const R zero(T(0)), one(T(1)), limit{T(a.floor)};
        const auto own = centre(o);
        R d[16], farthest = zero;
        for (int k = 0; k < a.samples; k++) {
            d[k] = dissimilarity<measure>(own, sample(k, o), to_sample(g, columns<R>(x), y, k));
            if (g.objectId)
                d[k] = select(ids_differ<R>(g.objectId + o, g.sample[k].objectId + o), R(T(kFarthest)), d[k]);
            farthest = max(farthest, d[k]);
        }
        R bits = zero, bit = one;
        if (a.adaptive) {
            // Initial centroids 0 and the farthest; the centre itself counts with dissimilarity 0.
            R nearSum = zero, nearCount = one, farSum = zero, farCount = zero;
            for (int k = 0; k < a.samples; k++) {
                const auto near = d[k] <= farthest * R(T(0.5));
                nearSum = nearSum + select(near, d[k], zero);
                nearCount = nearCount + select(near, one, zero);
                farSum = farSum + select(near, zero, d[k]);
                farCount = farCount + select(near, zero, one);
            }
            const R nearMean = nearSum / nearCount, farMean = farSum / max(farCount, one);
            for (int k = 0; k < a.samples; k++, bit = bit + bit)
                bits = bits + select(abs(d[k] - nearMean) <= abs(d[k] - farMean), bit, zero);
        } else {
            for (int k = 0; k < a.samples; k++, bit = bit + bit) bits = bits + select(d[k] < limit, bit, zero);
        }
        to_ints(select(farthest < limit, R(T(full)), bits), mask);
        store(farthest, farthestOut);
    }

    // Of sub-sample k of pixel (x, y) to the centre sample of pixel (qx, qy).
    AA_INLINE T outside(int k, int x, int y, int qx, int qy) const {
        const SubSampleArgs& s = g.sample[k];
        const long o = long(y) * a.stride + x, q = long(qy) * a.stride + qx;
        if (g.objectId && g.objectId[q] != s.objectId[o]) return T(kFarthest);
        return dissimilarity<measure>(
            point<T>(g.depthView, g.normalWorld, q), point<T>(s.depthView, s.normalWorld, o),
            separation(g, T(qx), qy, 0.0f, 0.0f, s.offsetPx[0] - float(qx - x), s.offsetPx[1] - float(qy - y)));
    }
    // Keeps a different sub-sample only when a neighbouring pixel shows its surface: else resampling toward it would
    // fetch a third surface.
    AA_INLINE bool shownByNeighbour(int k, int x, int y) const {
        const T half = a.tuneAdaptive ? outside(k, x, y, x, y) * T(0.5) : T(0), limit = max(T(a.floor), half);
        const RsaaNeighbours& n = a.neighbours[k];
        for (int i = 0; i < n.count; i++) {
            const int qx = clampIndex(x + n.at[i][0], a.width), qy = clampIndex(y + n.at[i][1], a.height);
            if (outside(k, x, y, qx, qy) < limit) return true;
        }
        return false;
    }
    AA_INLINE uint32_t tuned(uint32_t mask, int x, int y) const {
        for (int k = 0; k < a.samples; k++)
            if (!(mask >> k & 1u) && !shownByNeighbour(k, x, y)) mask |= 1u << k;
        return mask;
    }
    static AA_INLINE int clampIndex(int i, int size) { return i < 0 ? 0 : i >= size ? size - 1 : i; }

    AA_INLINE void edgePixel(uint32_t mask, int x, int y) const {
        const long o = long(y) * a.stride + x;
        const uint32_t last = a.tuning ? tuned(mask, x, y) : mask;
        const T u = a.offsetsPx[2 * last], v = a.offsetsPx[2 * last + 1];
        if (last != full) {
            const vec3<T> c = resample<T>(a.color, a.stride, x, y, u, v);
            a.out.c[0][o] = float(c.x), a.out.c[1][o] = float(c.y), a.out.c[2][o] = float(c.z);
        }
        if (a.maskLayer) {
            a.maskLayer[o] = float(mask), a.tunedLayer[o] = float(last);
            a.offsetXLayer[o] = float(u), a.offsetYLayer[o] = float(v);
        }
    }
    AA_INLINE void copy(long o) const {
        for (int c = 0; c < 3; c++) store(load<R>(a.color.c[c] + o), a.out.c[c] + o);
        if (!a.maskLayer) return;
        store(R(T(full)), a.maskLayer + o), store(R(T(full)), a.tunedLayer + o);
        store(R(T(0)), a.dissimilarityLayer + o);
        store(R(T(0)), a.offsetXLayer + o), store(R(T(0)), a.offsetYLayer + o);
    }
    AA_INLINE void rows(int y0, int y1) const {
        uint32_t allOnes[16];
        for (uint32_t& m : allOnes) m = full;
        for (int y = y0; y < y1; y++)
            for (int x = 0; x < a.width; x += N<R>) {
                const long o = long(y) * a.stride + x;
                copy(o);
                int mask[16];
                unsigned marked;
                if (a.maskPass) {
                    marked = mask_bits<R>(ids_differ<R>(a.maskPass + o, allOnes));
                    if (!marked) continue;
                    for (int i = 0; i < N<R>; i++) mask[i] = int(a.maskPass[o + i] & full);
                } else {
                    marked = suspects(x, y, o);
                    if (!marked) continue;
                    float farthest[16];
                    cluster(x, y, o, mask, farthest);
                    for (int i = 0; i < N<R>; i++)
                        if (a.dissimilarityLayer && marked >> i & 1u) a.dissimilarityLayer[o + i] = farthest[i];
                }
                for (int i = 0; i < N<R> && x + i < a.width; i++)
                    if (marked >> i & 1u && uint32_t(mask[i]) != full) edgePixel(uint32_t(mask[i]), x + i, y);
            }
    }
};

template <class R>
__attribute__((flatten)) void rsaaRows(const RsaaArgs& a, int y0, int y1) {
    switch (a.measure) {
        case Dissimilarity::sadp:
            return Rsaa<Dissimilarity::sadp, R>{a}.rows(y0, y1);
        case Dissimilarity::depth:
            return Rsaa<Dissimilarity::depth, R>{a}.rows(y0, y1);
        case Dissimilarity::normal:
            return Rsaa<Dissimilarity::normal, R>{a}.rows(y0, y1);
    }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::RsaaKernels, rsaaKernels) = {AA_ROWS(rsaaRows)};
