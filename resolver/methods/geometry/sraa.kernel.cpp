#include "methods/geometry/sraa.h"

#include "kernels/lanes.h"
#include "kernels/math.h"
#include "kernels/subsamples.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
struct Sraa {
    using T = Elem<R>;
    const SraaArgs& a;
    const GeometryArgs& g = *a.geometry;
    static constexpr int kMaxTaps = 25;

    static AA_INLINE R unusable() { return R(T(-1e9)); }  // the log of weight 0

    // Base-2 log of the weight of pixel (x + dx, y + dy)'s colour for sub-sample k of pixel (x, y).
    AA_INLINE R logWeight(const SurfacePoint<R>& own, int k, int x, int y, int dx, int dy) const {
        const R zero(T(0)), one(T(1));
        const long q = long(y + dy) * g.stride + x + dx;
        const SubSampleArgs& s = g.sample[k];
        const float stepX = float(dx) - s.offsetPx[0], stepY = float(dy) - s.offsetPx[1];
        const SurfacePoint<R> other = centrePoint<R>(g, q);
        const R relative = abs(other.depthView - own.depthView) / min(other.depthView, own.depthView);
        R apart = relative;
        if (!a.plainDepth) {
            const auto v = separation(g, columns<R>(x), y, s.offsetPx[0], s.offsetPx[1], stepX, stepY)
                               .vector(own.depthView, other.depthView);
            apart = select(hasNormal(own.normalWorld), abs(dot(own.normalWorld, v)) / own.depthView, relative);
        }
        const R cosine = dot(validNormal(own.normalWorld), validNormal(other.normalWorld));
        const R turned = one - saturate(cosine);
        const R geometry = a.maxMetric ? max(one - cosine, apart) * R(T(a.sharpness))
                                       : apart * apart * R(T(a.depth)) + turned * turned * R(T(a.normal));
        const R spatial = a.maxMetric ? zero : R((T(stepX) * T(stepX) + T(stepY) * T(stepY)) * T(a.spatial));
        const auto emptyOwn = isBackground(own.depthView), emptyOther = isBackground(other.depthView);
        const auto bothEmpty = both(emptyOwn, emptyOther);
        R log = -(spatial + select(bothEmpty, zero, geometry));
        log = select(both(either(emptyOwn, emptyOther), negate(bothEmpty)), unusable(), log);
        if (a.ids != SraaIds::off) {
            const long o = long(y) * g.stride + x;
            auto otherObject = idsDiffer<R>(s.objectId + o, g.objectId + q);
            if (a.ids == SraaIds::depth) otherObject = both(otherObject, relative > R(T(a.depthSigma)));
            log = select(otherObject, unusable(), log);
        }
        const R column = columns<R>(x + dx);
        return select(both(column >= zero, column <= R(T(g.width - 1))), max(unusable(), log), unusable());
    }
    // Colour of sub-sample k from the shaded pixels around it. Logs are taken from the largest, so that the sum is at
    // least 1 however unlike all pixels are; without any usable one the pixel's own colour stands.
    AA_INLINE vec3<R> reconstruct(int k, int x, int y, R& ownShare) const {
        const R zero(T(0)), one(T(1));
        const long o = long(y) * g.stride + x;
        const SurfacePoint<R> own = samplePoint<R>(g, k, o);
        R logs[kMaxTaps], largest = unusable();
        int count = 0;
        for (int dy = -a.radius; dy <= a.radius; dy++)
            for (int dx = -a.radius; dx <= a.radius; dx++, count++) {
                const bool inside = y + dy >= 0 && y + dy < g.height;
                logs[count] = inside ? logWeight(own, k, x, y, dx, dy) : unusable();
                largest = max(largest, logs[count]);
            }
        const vec3<R> centre = load3<R>(a.color, o);
        vec3<R> sum(zero);  // about the pixel's own colour: constants stay exact
        R weights = zero, ownWeight = zero;
        count = 0;
        for (int dy = -a.radius; dy <= a.radius; dy++)
            for (int dx = -a.radius; dx <= a.radius; dx++, count++) {
                R w = exp2Clamped(logs[count] - largest);
                w = select(logs[count] > unusable() * R(T(0.5)), w, zero);
                if (y + dy < 0 || y + dy >= g.height) continue;
                const vec3<R> c = load3<R>(a.color, o + long(dy) * g.stride + dx);
                sum = sum + select(w > zero, (c - centre) * w, vec3<R>(zero));
                weights = weights + w;
                if (dx == 0 && dy == 0) ownWeight = w;
            }
        const R divisor = select(weights > zero, weights, one);
        ownShare = ownShare + select(weights > zero, ownWeight, one) / divisor;
        return sum / divisor;
    }
    AA_INLINE void rows(int y0, int y1) const {
        for (int y = y0; y < y1; y++)
            for (int x = 0; x < g.width; x += N<R>) {
                const long o = long(y) * g.stride + x;
                vec3<R> sum(R(T(0)));
                R ownShare(T(0));
                for (int k = 0; k < g.samples; k++) sum = sum + reconstruct(k, x, y, ownShare);
                const R samples{T(g.samples)};
                // A dark result beside a bright own colour is rounded, which must not make light negative.
                const vec3<R> c = max(load3<R>(a.color, o) + sum / samples, vec3<R>(R(T(0))));
                store(c.x, a.out.c[0] + o), store(c.y, a.out.c[1] + o), store(c.z, a.out.c[2] + o);
                if (a.ownShareLayer) store(ownShare / samples, a.ownShareLayer + o);
            }
    }
};

template <class R>
__attribute__((flatten)) void sraaRows(const SraaArgs& a, int y0, int y1) {
    Sraa<R>{a}.rows(y0, y1);
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::SraaKernels, sraaKernels) = {AA_WIDE_ROWS(sraaRows)};
