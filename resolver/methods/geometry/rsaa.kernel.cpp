#include "methods/geometry/rsaa.h"

#include "kernels/lanes.h"
#include "kernels/resample.h"
#include "kernels/subsamples.h"

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
            return surfacePoint<S>(depthView, normalWorld, o);
    }
    AA_INLINE SurfacePoint<R> centre(long o) const { return point<R>(g.depthView, g.normalWorld, o); }
    AA_INLINE SurfacePoint<R> sample(int k, long o) const {
        return point<R>(g.sample[k].depthView, g.sample[k].normalWorld, o);
    }

    AA_INLINE Mask<R> mayDiffer(int k, int x, int y, long o, R limit) const {
        return surfacesMayDiffer<measure>(centre(o), sample(k, o), toSample(g, columns<R>(x), y, k), limit);
    }
    // Marks the pixels in which some sub-sample may be another surface.
    AA_INLINE void markSuspects(int x0, int y, Marks<R>& marks) const {
        const R limit{T(a.floor)};
        if constexpr (measure == Dissimilarity::sadp) return markSadpSuspects(x0, y, marks);
        mark<R>(
            g, x0, y, marks, [&](int k, int x, long o) __attribute__((always_inline)) {
                const auto differs = mayDiffer(k, x, y, o, limit);
                return g.objectId ? either(differs, idsDiffer<R>(g.objectId + o, g.sample[k].objectId + o)) : differs;
            });
    }
    // The same, sooner. With normals na, nb = na + e and v = dz ray + s, where s is the step on the image plane:
    //   (|na.v| + |nb.v|) / |v| <= 2 |na.v| / |v| + |e|  and  |v| >= |s across the ray|,
    // so a sub-sample is on the centre's surface when 2 |na.v| < (limit - |e|) |s across the ray|, with |e| taken as
    // the sum of its components. That holds nearly everywhere on flat and on smooth surfaces and needs neither v nor
    // |v|; the whole test runs where it does not.
    AA_INLINE void markSadpSuspects(int x0, int y, Marks<R>& marks) const {
        const R limit{T(a.floor)};
        const int groups = chunkGroups<R>(g.width - x0);
        const vec3<R> rayX = broadcast3<R>(g.rayX);
        const vec3<R> rowRay = broadcast3<R>(g.ray) + broadcast3<R>(g.rayY) * R(T(y));
        R alongRay[kChunk / N<R>], skyFrom[kChunk / N<R>];  // na.ray, NaN where the test does not apply; depth of sky
        for (int i = 0; i < groups; i++) {
            const int x = x0 + i * N<R>;
            const auto own = centre(long(y) * a.stride + x);
            const auto empty = isBackground(own.depthView);
            const auto usable = both(negate(empty), hasNormal(own.normalWorld));
            alongRay[i] = select(usable, dot(own.normalWorld, rowRay + rayX * columns<R>(x)), R(T(NAN)));
            skyFrom[i] = select(empty, R(T(1e9)), R(T(INFINITY)));
            marks.lanes[i] = 0;
        }
        for (int k = 0; k < a.samples; k++) {
            const auto separationHere = toSample(g, R(T(x0)), y, k);
            const bool perspective = g.originX[0] == 0 && g.originX[1] == 0 && g.originX[2] == 0;
            const vec3<R> step = perspective ? separationHere.stepRay : separationHere.stepOrigin;
            const R across = stepAcrossRay(step, x0, y);
            for (int i = 0; i < groups; i++) {
                const int x = x0 + i * N<R>;
                const long o = long(y) * a.stride + x;
                prefetchNext(g, k, o);
                const auto own = centre(o), other = sample(k, o);
                const R scale = perspective ? other.depthView : R(T(1));
                const R alongV = (other.depthView - own.depthView) * alongRay[i] + scale * dot(own.normalWorld, step);
                const vec3<R> e = abs(other.normalWorld - own.normalWorld);
                const auto onSurface = R(T(2)) * abs(alongV) < (limit - (e.x + e.y + e.z)) * (scale * across);
                const auto same = either(onSurface, other.depthView >= skyFrom[i]);
                unsigned suspects = maskBits<R>(negate(same));
                if (suspects) suspects &= maskBits<R>(mayDiffer(k, x, y, o, limit));
                if (g.objectId) suspects |= maskBits<R>(idsDiffer<R>(g.objectId + o, g.sample[k].objectId + o));
                marks.lanes[i] |= suspects;
            }
        }
    }
    // A lower bound over the chunk of the length of `step` perpendicular to the ray: the least of the chunk's ends,
    // less a tenth for what lies between them.
    AA_INLINE R stepAcrossRay(vec3<R> step, int x0, int y) const {
        R least{T(INFINITY)};
        for (int x = x0; x <= x0 + kChunk; x += kChunk) {
            const vec3<R> ray =
                broadcast3<R>(g.ray) + broadcast3<R>(g.rayX) * R(T(x)) + broadcast3<R>(g.rayY) * R(T(y));
            const R along = dot(step, ray);
            least = min(least, dot(step, step) - along * along / dot(ray, ray));
        }
        return R(T(0.9)) * sqrt(max(R(T(0)), least));
    }
    AA_INLINE void markByPass(int x0, int y, Marks<R>& marks) const {
        uint32_t allOnes[16];
        for (uint32_t& m : allOnes) m = full;
        const int groups = chunkGroups<R>(a.width - x0);
        for (int i = 0; i < groups; i++) {
            const long o = long(y) * a.stride + x0 + i * N<R>;
            marks.lanes[i] = maskBits<R>(idsDiffer<R>(a.maskPass + o, allOnes));
            if (!marks.lanes[i] || !a.tuning) continue;
            uint32_t similar = full;  // what tuning will read
            for (int lane = 0; lane < N<R>; lane++) similar &= a.maskPass[o + lane];
            for (int k = 0; k < a.samples; k++)
                if (!(similar >> k & 1u)) prefetchSample(g, k, o);
        }
    }
    // Of sub-sample k from the centre sample of its pixel.
    AA_INLINE R fromCentre(int k, int x, int y, long o) const {
        const R d = dissimilarity<measure>(centre(o), sample(k, o), toSample(g, columns<R>(x), y, k));
        return g.objectId ? select(idsDiffer<R>(g.objectId + o, g.sample[k].objectId + o), R(T(kFarthest)), d) : d;
    }
    // Bit k of mask[lane] is 1 where sub-sample k is similar to the centre; farthest[lane] is the largest
    // dissimilarity.
    AA_INLINE void cluster(int x, int y, long o, int* mask, float* farthestOut) const {
        const R zero(T(0)), one(T(1)), limit{T(a.floor)};
        R d[16], farthest = zero;
        for (int k = 0; k < a.samples; k++) {
            d[k] = fromCentre(k, x, y, o);
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
        toInts(select(farthest < limit, R(T(full)), bits), mask);
        store(farthest, farthestOut);
    }

    // From the centre sample of pixel (qx, qy) to sub-sample k of pixel (x, y).
    struct Outside {
        SurfacePoint<T> neighbour, own;
        Separation<T> way;
        bool otherObject;
        AA_INLINE T dissimilarity() const {
            return otherObject ? T(kFarthest) : AA_ARCH::dissimilarity<measure>(neighbour, own, way);
        }
    };
    AA_INLINE Outside outside(int k, int x, int y, int qx, int qy) const {
        const SubSampleArgs& s = g.sample[k];
        const long o = long(y) * a.stride + x, q = long(qy) * a.stride + qx;
        return {point<T>(g.depthView, g.normalWorld, q), point<T>(s.depthView, s.normalWorld, o),
                separation(g, T(qx), qy, 0.0f, 0.0f, s.offsetPx[0] - float(qx - x), s.offsetPx[1] - float(qy - y)),
                g.objectId && g.objectId[q] != s.objectId[o]};
    }
    // Keeps a different sub-sample only when a neighbouring pixel shows its surface: else resampling toward it would
    // fetch a third surface.
    AA_INLINE bool shownByNeighbour(int k, int x, int y) const {
        const T half = a.tuneAdaptive ? outside(k, x, y, x, y).dissimilarity() * T(0.5) : T(0);
        const T limit = max(T(a.floor), half);
        const RsaaNeighbours& n = a.neighbours[k];
        const uint32_t sampleObject = g.objectId ? g.sample[k].objectId[long(y) * a.stride + x] : 0;
        for (int i = 0; i < n.count; i++) {
            const int qx = clampIndex(x + n.at[i][0], a.width), qy = clampIndex(y + n.at[i][1], a.height);
            if (g.objectId && g.objectId[long(qy) * a.stride + qx] != sampleObject) continue;
            const Outside to = outside(k, x, y, qx, qy);
            if (!surfacesMayDiffer<measure>(to.neighbour, to.own, to.way, limit) || to.dissimilarity() < limit)
                return true;
        }
        return false;
    }
    // The same for the lanes `asked` of the group of pixels at (x, y), all of whose neighbours lie in the picture.
    AA_INLINE unsigned shownByNeighbours(int k, int x, int y, unsigned asked) const {
        const SubSampleArgs& s = g.sample[k];
        const long o = long(y) * a.stride + x;
        const auto own = sample(k, o);
        R limit{T(a.floor)};
        if (a.tuneAdaptive) limit = max(limit, fromCentre(k, x, y, o) * R(T(0.5)));
        const RsaaNeighbours& n = a.neighbours[k];
        unsigned missing = asked;
        for (int i = 0; i < n.count && missing; i++) {
            const int dx = n.at[i][0], dy = n.at[i][1];
            const long q = o + long(dy) * a.stride + dx;
            unsigned open = missing;
            if (g.objectId) open &= ~maskBits<R>(idsDiffer<R>(g.objectId + q, s.objectId + o));
            if (!open) continue;
            const auto other = centre(q);
            const auto way = separation(g, columns<R>(x + dx), y + dy, 0.0f, 0.0f, s.offsetPx[0] - float(dx),
                                        s.offsetPx[1] - float(dy));
            unsigned shown = open & ~maskBits<R>(surfacesMayDiffer<measure>(other, own, way, limit));
            if (open & ~shown) shown |= open & maskBits<R>(AA_ARCH::dissimilarity<measure>(other, own, way) < limit);
            missing &= ~shown;
        }
        return asked & ~missing;
    }
    static AA_INLINE unsigned lanesWithout(const int* mask, int bit) {
        using I = typename IntsOf<N<R>>::unaligned;
        return maskBits<R>((Mask<R>)(typename IntsOf<N<R>>::type(*(const I*)mask & bit) == 0));
    }
    // All lanes at once: worth it from two pixels on.
    AA_INLINE void tuneGroup(unsigned marked, int* mask, int x, int y) const {
        for (int k = 0; k < a.samples; k++) {
            const unsigned asked = marked & lanesWithout(mask, 1 << k);
            if (!asked) continue;
            unsigned alone = asked & ~shownByNeighbours(k, x, y, asked);
            for (; alone; alone &= alone - 1u) mask[__builtin_ctz(alone)] |= 1 << k;
        }
    }
    AA_INLINE uint32_t tuned(uint32_t mask, int x, int y) const {
        for (int k = 0; k < a.samples; k++)
            if (!(mask >> k & 1u) && !shownByNeighbour(k, x, y)) mask |= 1u << k;
        return mask;
    }
    static AA_INLINE int clampIndex(int i, int size) { return i < 0 ? 0 : i >= size ? size - 1 : i; }

    // `last` is the mask after tuning.
    AA_INLINE void edgePixel(uint32_t mask, uint32_t last, int x, int y) const {
        const long o = long(y) * a.stride + x;
        const T u = a.offsetsPx[2 * last], v = a.offsetsPx[2 * last + 1];
        if (last != full) {
            const vec3<T> c = AA_ARCH::resample<T>(a.color, a.stride, x, y, u, v);
            a.out.c[0][o] = float(c.x), a.out.c[1][o] = float(c.y), a.out.c[2][o] = float(c.z);
        }
        if (a.maskLayer) {
            a.maskLayer[o] = float(mask), a.tunedLayer[o] = float(last);
            a.offsetXLayer[o] = float(u), a.offsetYLayer[o] = float(v);
        }
    }
    // The rows above and below, which tuning and resampling read: nothing else has brought them near yet.
    AA_INLINE void prefetchNeighbours(long o) const {
        for (long row = -a.stride; row <= a.stride; row += a.stride) {
            for (int c = 0; c < 3; c++) __builtin_prefetch(a.color.c[c] + o + row);
            if (!a.tuning) continue;
            __builtin_prefetch(g.depthView + o + row);
            if (measure != Dissimilarity::depth)
                for (int c = 0; c < 3; c++) __builtin_prefetch(g.normalWorld.c[c] + o + row);
            if (g.objectId) __builtin_prefetch(g.objectId + o + row);
        }
    }
    AA_INLINE void keepColors(int x0, int y) const {
        const long o = long(y) * a.stride + x0;
        const int width = a.width - x0;
        copyChunk<R>(a.color, a.out, width, o);
        if (!a.maskLayer) return;
        fillChunk<R>(float(full), a.maskLayer + o, width), fillChunk<R>(float(full), a.tunedLayer + o, width);
        fillChunk<R>(0, a.dissimilarityLayer + o, width);
        fillChunk<R>(0, a.offsetXLayer + o, width), fillChunk<R>(0, a.offsetYLayer + o, width);
    }
    AA_INLINE void resample(unsigned marked, int x, int y) const {
        const long o = long(y) * a.stride + x;
        int mask[16];
        if (a.maskPass) {
            for (int i = 0; i < N<R>; i++) mask[i] = int(a.maskPass[o + i] & full);
        } else {
            float farthest[16];
            cluster(x, y, o, mask, farthest);
            for (int i = 0; i < N<R>; i++)
                if (a.dissimilarityLayer && marked >> i & 1u) a.dissimilarityLayer[o + i] = farthest[i];
        }
        unsigned edges = 0;
        for (int i = 0; i < N<R> && x + i < a.width; i++)
            if (marked >> i & 1u && uint32_t(mask[i]) != full) edges |= 1u << i;
        const bool inner = x > 0 && x + N<R> < a.width && y > 0 && y + 1 < a.height;
        const bool together = N<R> > 1 && a.tuning && inner && (edges & (edges - 1u));
        int last[16];
        for (int i = 0; i < N<R>; i++) last[i] = mask[i];
        if constexpr (N<R> != 1)
            if (together) tuneGroup(edges, last, x, y);
        for (; edges; edges &= edges - 1u) {
            const int i = __builtin_ctz(edges);
            const uint32_t own = uint32_t(mask[i]);
            edgePixel(own, together ? uint32_t(last[i]) : a.tuning ? tuned(own, x + i, y) : own, x + i, y);
        }
    }
    AA_INLINE void rows(int y0, int y1) const {
        for (int y = y0; y < y1; y++)
            for (int x0 = 0; x0 < a.width; x0 += kChunk) {
                Marks<R> marks;
                if (a.maskPass)
                    markByPass(x0, y, marks);
                else
                    markSuspects(x0, y, marks);
                for (int i = 0; i < chunkGroups<R>(a.width - x0); i++)
                    if (marks.lanes[i]) prefetchNeighbours(long(y) * a.stride + x0 + i * N<R>);
                keepColors(x0, y);
                for (int i = 0; i < chunkGroups<R>(a.width - x0); i++)
                    if (marks.lanes[i]) resample(marks.lanes[i], x0 + i * N<R>, y);
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

AA_DEFINE_TABLE(aa::RsaaKernels, rsaaKernels) = {AA_WIDE_ROWS(rsaaRows)};
