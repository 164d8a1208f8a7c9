#include "methods/geometry/sbaa.h"

#include "kernels/lanes.h"
#include "kernels/surfaces.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
struct Sbaa {
    using T = Elem<R>;
    const SbaaArgs& a;
    const GeometryArgs& g = *a.geometry;

    struct Cluster {
        int representative;  // sub-sample
        uint32_t members;    // bit k: sub-sample k
        int coverage;
    };
    struct Pixel {
        const Sbaa& m;
        PixelSurfaces<T> pixel;
        Cluster clusters[kSbaaMaxSamples];
        int count = 0;

        AA_INLINE void onePerSurface() {
            for (int k = 0; k < m.g.samples; k++) {
                int i = 0;
                while (i < count && !(pixel.sameObject(clusters[i].representative, k) &&
                                      pixel.sameGeometry(clusters[i].representative, k)))
                    i++;
                if (i == count) clusters[count++] = {k, 0, 0};
                clusters[i].members |= 1u << k;
                clusters[i].coverage++;
            }
        }
        AA_INLINE void merge(int i, int j) {  // i < j
            if (clusters[j].coverage > clusters[i].coverage) clusters[i].representative = clusters[j].representative;
            clusters[i].members |= clusters[j].members;
            clusters[i].coverage += clusters[j].coverage;
            clusters[j] = clusters[--count];
        }
        // Pieces of one surface.
        AA_INLINE bool like(int k, int l) const {
            return (!m.a.ids || pixel.sameObject(k, l)) && pixel.sameGeometry(k, l);
        }
        AA_INLINE void mergeLike() {
            for (int i = 0; i < count; i++)
                for (int j = i + 1; j < count;)
                    if (like(clusters[i].representative, clusters[j].representative))
                        merge(i, j), j = i + 1;
                    else
                        j++;
        }
        AA_INLINE T apart(int i, int j) const {
            const int p = clusters[i].representative, q = clusters[j].representative;
            return dissimilarity<Dissimilarity::sadp>(pixel.point(p), pixel.point(q), pixel.between(p, q));
        }
        // The two that are least apart; of equals those that cover least.
        AA_INLINE void mergeNearest() {
            int bestI = 0, bestJ = 1;
            T best = apart(0, 1);
            for (int i = 0; i < count; i++)
                for (int j = i + 1; j < count; j++) {
                    const T d = apart(i, j);
                    const int covered = clusters[i].coverage + clusters[j].coverage;
                    if (d < best || (d == best && covered < clusters[bestI].coverage + clusters[bestJ].coverage))
                        best = d, bestI = i, bestJ = j;
                }
            merge(bestI, bestJ);
        }
        // Shaded once, at the member nearest to the cluster's centroid.
        AA_INLINE vec3<T> shade(const Cluster& c) const {
            T x = 0, y = 0;  // times the coverage: exact for positions on a grid of 1/16, so that equals tie
            for (int k = 0; k < m.g.samples; k++)
                if (c.members >> k & 1u) x = x + T(m.g.sample[k].offsetPx[0]), y = y + T(m.g.sample[k].offsetPx[1]);
            const T n = T(c.coverage);
            int nearest = -1;
            T least = 0;
            for (int k = 0; k < m.g.samples; k++) {
                if (!(c.members >> k & 1u)) continue;
                const T dx = n * T(m.g.sample[k].offsetPx[0]) - x, dy = n * T(m.g.sample[k].offsetPx[1]) - y;
                const T d = dx * dx + dy * dy;
                if (nearest < 0 || d < least) nearest = k, least = d;
            }
            return load3<T>(m.g.sample[nearest].color, pixel.at());
        }
        AA_INLINE vec3<T> resolve() const {
            vec3<T> sum(T(0)), origin(T(0));
            int covered = 0;
            for (int i = 0; i < count; i++) {
                const vec3<T> c = shade(clusters[i]);
                if (!isFinite(c)) continue;
                if (!covered) origin = c;  // about the first colour: constants stay exact
                covered += clusters[i].coverage;
                sum = sum + (c - origin) * T(clusters[i].coverage);
            }
            return covered ? origin + sum / T(covered) : vec3<T>(T(0));
        }
    };
    AA_INLINE void edgePixel(int x, int y) const {
        Pixel p{*this, {g, a.merge, x, y}, {}};
        p.onePerSurface();
        p.mergeLike();
        const int before = p.count;
        while (p.count > a.surfaces) p.mergeNearest();
        const vec3<T> c = p.resolve();
        const long o = p.pixel.at();
        a.out.c[0][o] = float(c.x), a.out.c[1][o] = float(c.y), a.out.c[2][o] = float(c.z);
        if (!a.clustersLayer) return;
        a.clustersLayer[o] = float(before), a.surfacesLayer[o] = float(p.count);
        const Cluster* largest = p.clusters;
        for (int i = 1; i < p.count; i++)
            if (p.clusters[i].coverage > largest->coverage) largest = p.clusters + i;
        a.largestLayer[o] = float(largest->members);
    }
    AA_INLINE void markEdges(int x0, int y, Marks<R>& marks) const {
        mark<R>(
            g, x0, y, marks, [&](int k, int x, long o) __attribute__((always_inline)) {
                const auto apart = negate(sameSurface(a.merge, centrePoint<R>(g, o), samplePoint<R>(g, k, o),
                                                      toSample(g, columns<R>(x), y, k)));
                return a.ids ? either(apart, idsDiffer<R>(g.objectId + o, g.sample[k].objectId + o)) : apart;
            });
    }
    AA_INLINE void rows(int y0, int y1) const {
        for (int y = y0; y < y1; y++)
            for (int x0 = 0; x0 < g.width; x0 += kChunk) {
                const long o = long(y) * g.stride + x0;
                Marks<R> marks;
                markEdges(x0, y, marks);
                copyChunk<R>(a.color, a.out, g.width - x0, o);
                if (a.clustersLayer) {
                    fillChunk<R>(1, a.clustersLayer + o, g.width - x0);
                    fillChunk<R>(1, a.surfacesLayer + o, g.width - x0);
                    fillChunk<R>(float((1u << g.samples) - 1u), a.largestLayer + o, g.width - x0);
                }
                forMarked<R>(marks, g.width, x0, y, [&](int x, int row) { edgePixel(x, row); });
            }
    }
};

template <class R>
__attribute__((flatten)) void sbaaRows(const SbaaArgs& a, int y0, int y1) {
    Sbaa<R>{a}.rows(y0, y1);
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::SbaaKernels, sbaaKernels) = {AA_WIDE_ROWS(sbaaRows)};
