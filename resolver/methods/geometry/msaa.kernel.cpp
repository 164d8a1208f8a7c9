#include "methods/geometry/msaa.h"

#include "kernels/display.h"
#include "kernels/surfaces.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
struct Msaa {
    using T = Elem<R>;
    const MsaaArgs& a;
    const GeometryArgs& g = *a.geometry;

    // Marks the pixels in which some sub-sample lies on another surface than the centre sample.
    AA_INLINE void markEdges(int x0, int y, Marks<R>& marks) const {
        mark<R>(
            g, x0, y, marks, [&](int k, int x, long o) __attribute__((always_inline)) {
                const auto otherObject = idsDiffer<R>(g.objectId + o, g.sample[k].objectId + o);
                if (!a.byGeometry) return otherObject;
                return either(otherObject, negate(sameSurface(a.rule, centrePoint<R>(g, o), samplePoint<R>(g, k, o),
                                                              toSample(g, columns<R>(x), y, k))));
            });
    }

    struct Surface {
        int seed;  // the sample that stands for it: -1 the centre, else its sub-sample nearest to the pixel centre
        int count;
        vec3<T> color;
    };
    struct Pixel {
        const Msaa& m;
        PixelSurfaces<T> pixel;
        Surface surfaces[kMsaaMaxSamples + 1];
        int surfaceOf[kMsaaMaxSamples];
        int count = 0;

        AA_INLINE bool same(int a, int b) const {
            return pixel.sameObject(a, b) && (!m.a.byGeometry || pixel.sameGeometry(a, b));
        }
        // A surface and the slots that lie on it; nothing when there are none.
        AA_INLINE void add(int seed) {
            int covered = 0, nearest = -1;
            for (int i = 0; i < m.g.samples; i++) {
                const int k = m.a.order[i];
                if (k >= m.a.slots || surfaceOf[k] >= 0 || !(k == seed || same(seed, k))) continue;
                surfaceOf[k] = count;
                covered++;
                if (nearest < 0) nearest = k;
            }
            if (!covered) return;
            const bool atCentre = seed < 0 && !(m.a.centroid && covered < m.a.slots);
            const vec3<T> color = load3<T>(atCentre ? m.a.color : m.g.sample[nearest].color, pixel.at());
            surfaces[count++] = {seed, covered, m.a.encoded && isFinite(color) ? display(m.a.display, color) : color};
        }
        // A coverage-only sample counts for a stored surface that it lies on, else for that of the nearest slot.
        AA_INLINE void cover(int k) {
            surfaceOf[k] = surfaceOf[m.a.nearestSlot[k]];
            for (int i = 0; i < count; i++)
                if (same(surfaces[i].seed, k)) {
                    surfaceOf[k] = i;
                    break;
                }
            surfaces[surfaceOf[k]].count++;
        }
        AA_INLINE void group() {
            for (int& s : surfaceOf) s = -1;
            add(-1);
            for (int i = 0; i < m.g.samples; i++) {
                const int k = m.a.order[i];
                if (k < m.a.slots && surfaceOf[k] < 0) add(k);
            }
            for (int k = m.a.slots; k < m.g.samples; k++) cover(k);
        }
        // Coverage-weighted mean about one surface's colour, which keeps constants exact; colours that are not finite
        // are left out. It is the first one's; but a bright one of next to no weight would take all digits from the
        // mean, so that weights by luminance take the least of every channel.
        AA_INLINE vec3<T> resolve() const {
            vec3<T> sum(T(0)), origin(T(0));
            T weights = 0;
            const bool aboutLeast = m.a.inverseLuminance;
            if (aboutLeast) {
                origin = vec3<T>(T(3e38));
                for (int i = 0; i < count; i++)
                    if (isFinite(surfaces[i].color)) origin = min(origin, surfaces[i].color);
            }
            for (int i = 0; i < count; i++) {
                const vec3<T> c = surfaces[i].color;
                if (!isFinite(c)) continue;
                T w = T(surfaces[i].count);
                if (m.a.inverseLuminance) w = w / (T(1) + max(T(0), luma709(c)));
                if (!aboutLeast && !(weights > T(0))) origin = c;
                weights = weights + w;
                sum = sum + (c - origin) * w;
            }
            return weights > T(0) ? origin + sum / weights : vec3<T>(T(0));
        }
    };
    AA_INLINE void edgePixel(int x, int y) const {
        Pixel p{*this, {g, a.rule, x, y}, {}, {}};
        p.group();
        const vec3<T> c = p.resolve();
        const long o = p.pixel.at();
        a.out.c[0][o] = float(c.x), a.out.c[1][o] = float(c.y), a.out.c[2][o] = float(c.z);
        for (int k = 0; a.sampleColors && k < g.samples; k++) {
            const vec3<T> own = p.surfaces[p.surfaceOf[k]].color, s = isFinite(own) ? own : c;
            const RgbOut& to = a.sampleColors[k];
            to.c[0][o] = float(s.x), to.c[1][o] = float(s.y), to.c[2][o] = float(s.z);
        }
        if (!a.surfacesLayer) return;
        a.surfacesLayer[o] = float(p.count);
        a.coverageLayer[o] = p.surfaces[0].seed < 0 ? float(p.surfaces[0].count) / float(g.samples) : 0.0f;
    }
    AA_INLINE void rows(int y0, int y1) const {
        for (int y = y0; y < y1; y++)
            for (int x0 = 0; x0 < g.width; x0 += kChunk) {
                const long o = long(y) * g.stride + x0;
                Marks<R> marks;
                markEdges(x0, y, marks);
                copyChunk<R>(a.copied, a.out, g.width - x0, o);
                for (int k = 0; a.sampleColors && k < g.samples; k++)
                    copyChunk<R>(a.copied, a.sampleColors[k], g.width - x0, o);
                if (a.surfacesLayer) {
                    fillChunk<R>(1, a.surfacesLayer + o, g.width - x0);
                    fillChunk<R>(1, a.coverageLayer + o, g.width - x0);
                }
                forMarked<R>(marks, g.width, x0, y, [&](int x, int row) { edgePixel(x, row); });
            }
    }
};

template <class R>
__attribute__((flatten)) void msaaRows(const MsaaArgs& a, int y0, int y1) {
    Msaa<R>{a}.rows(y0, y1);
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::MsaaKernels, msaaKernels) = {AA_WIDE_ROWS(msaaRows)};
