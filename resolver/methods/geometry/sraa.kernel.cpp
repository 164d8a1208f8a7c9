#include "methods/geometry/sraa.h"

#include "kernels/lanes.h"
#include "kernels/math.h"
#include "kernels/sparse.h"
#include "kernels/subsamples.h"
#include "kernels/texels.h"

// Most pixels lie on one plane with all pixels around them. There the geometry's share of every exponent is rounded
// away beside that of the place, so that all have the same weights. Only the others, whose planes, normals or objects
// differ, need weights of their own: lanes put them on a list and compute N of them together.
namespace AA_ARCH {
using namespace aa;

// N pixels of a row, side by side or not.
template <class R>
struct SraaPixels {
    Offsets<R> at;  // columns
    R column;
    int y;
    long row;  // offset of its first pixel

    AA_INLINE R read(const float* plane, long offset) const { return gather<R>(plane + row + offset, at); }
    AA_INLINE vec3<R> read3(const RgbIn& image, long offset) const {
        return {read(image.c[0], offset), read(image.c[1], offset), read(image.c[2], offset)};
    }
    AA_INLINE Mask<R> idsApart(const uint32_t* a, const uint32_t* b, long offset) const {
        a += row, b += row + offset;
        if (at.together) return idsDiffer<R>(a + at.k[0], b + at.k[0]);
        if constexpr (N<R> == 1)
            return false;  // one pixel is together with itself
        else {
            Mask<R> m{};
            for (int i = 0; i < N<R>; i++) m[i] = a[at.k[i]] != b[at.k[i]] ? -1 : 0;
            return m;
        }
    }
};

template <class R>
struct Sraa {
    using T = Elem<R>;
    const SraaArgs& a;
    const GeometryArgs& g = *a.geometry;
    static constexpr int kMostTaps = 25, kMostSamples = 64;

    static AA_INLINE R unusable() { return R(T(-1e9)); }  // the log of weight 0
    AA_INLINE T spatial(float stepX, float stepY) const {
        return a.maxMetric ? T(0) : (T(stepX) * T(stepX) + T(stepY) * T(stepY)) * T(a.spatial);
    }

    // ---- any pixels

    // The shaded pixels around N pixels. `step`: their colours from the pixels' own, so that constants stay exact.
    struct Around {
        int count, own;
        bool anyBeyond, anyEmpty;
        float dx[kMostTaps], dy[kMostTaps];
        long offset[kMostTaps];
        R depthView[kMostTaps];
        vec3<R> normalWorld[kMostTaps], step[kMostTaps];
        Mask<R> empty[kMostTaps], within[kMostTaps];
    };
    AA_INLINE void readAround(const SraaPixels<R>& p, Around& n) const {
        const R zero(T(0));
        const vec3<R> centre = p.read3(a.color, 0);
        n.count = n.own = 0, n.anyBeyond = n.anyEmpty = false;
        for (int dy = -a.radius; dy <= a.radius; dy++) {
            if (p.y + dy < 0 || p.y + dy >= g.height) continue;
            for (int dx = -a.radius; dx <= a.radius; dx++, n.count++) {
                const int i = n.count;
                const long offset = long(dy) * g.stride + dx;
                if (!dx && !dy) n.own = i;
                n.dx[i] = float(dx), n.dy[i] = float(dy), n.offset[i] = offset;
                n.depthView[i] = p.read(g.depthView, offset);
                n.normalWorld[i] = validNormal(p.read3(g.normalWorld, offset));
                n.step[i] = p.read3(a.color, offset) - centre;
                n.empty[i] = isBackground(n.depthView[i]);
                const R column = p.column + R(T(dx));
                n.within[i] = both(column >= zero, column <= R(T(g.width - 1)));
                n.anyEmpty |= maskBits<R>(n.empty[i]) != 0;
                n.anyBeyond |= maskBits<R>(negate(n.within[i])) != 0;
            }
        }
    }
    // Colour of sub-sample k from the shaded pixels around it, and the share of the pixel's own. Logs of the weights,
    // to base 2, are taken from the largest, so that the sum is at least 1 however unlike all pixels are; without any
    // usable one the pixel's own colour stands.
    AA_INLINE vec3<R> reconstruct(const SraaPixels<R>& p, const Around& n, int k, R& ownShare) const {
        const R zero(T(0)), one(T(1));
        const SubSampleArgs& s = g.sample[k];
        const R depth = p.read(s.depthView, 0);
        const vec3<R> normal = p.read3(s.normalWorld, 0), validOwn = validNormal(normal);
        const auto known = hasNormal(normal), empty = isBackground(depth);
        const bool needsRelative =
            a.plainDepth || a.ids == SraaIds::depth || maskBits<R>(known) != maskBits<R>(zero == zero);
        const bool anyEmpty = n.anyEmpty || maskBits<R>(empty);
        R logs[kMostTaps], largest = unusable();
        for (int i = 0; i < n.count; i++) {
            const float stepX = n.dx[i] - s.offsetPx[0], stepY = n.dy[i] - s.offsetPx[1];
            const R other = n.depthView[i];
            R relative = zero;
            if (needsRelative) relative = abs(other - depth) / min(other, depth);
            R apart = relative;
            if (!a.plainDepth) {
                const auto v =
                    separation(g, p.column, p.y, s.offsetPx[0], s.offsetPx[1], stepX, stepY).vector(depth, other);
                apart = select(known, abs(dot(normal, v)) / depth, relative);
            }
            const R cosine = dot(validOwn, n.normalWorld[i]), turned = one - saturate(cosine);
            R geometry = a.maxMetric ? max(one - cosine, apart) * R(T(a.sharpness))
                                     : apart * apart * R(T(a.depth)) + turned * turned * R(T(a.normal));
            if (anyEmpty) geometry = select(both(empty, n.empty[i]), zero, geometry);
            R log = -(R(spatial(stepX, stepY)) + geometry);
            if (anyEmpty)
                log = select(both(either(empty, n.empty[i]), negate(both(empty, n.empty[i]))), unusable(), log);
            if (a.ids != SraaIds::off) {
                auto otherObject = p.idsApart(s.objectId, g.objectId, n.offset[i]);
                if (a.ids == SraaIds::depth) otherObject = both(otherObject, relative > R(T(a.depthSigma)));
                log = select(otherObject, unusable(), log);
            }
            log = max(unusable(), log);
            logs[i] = n.anyBeyond ? select(n.within[i], log, unusable()) : log;
            largest = max(largest, logs[i]);
        }
        vec3<R> sum(zero);
        R weights = zero, ownWeight = zero;
        for (int i = 0; i < n.count; i++) {
            R w = exp2Clamped(logs[i] - largest);
            w = select(logs[i] > unusable() * R(T(0.5)), w, zero);
            sum = sum + select(w > zero, n.step[i] * w, vec3<R>(zero));
            weights = weights + w;
            if (i == n.own) ownWeight = w;
        }
        const R divisor = select(weights > zero, weights, one);
        ownShare = ownShare + select(weights > zero, ownWeight, one) / divisor;
        return sum / divisor;
    }
    // A dark result beside a bright own colour is rounded, which must not make light negative.
    AA_INLINE R lit(R own, R sum) const { return max(own + sum / R(T(g.samples)), R(T(0))); }
    AA_INLINE vec3<R> resolve(const SraaPixels<R>& p, R& ownShare) const {
        Around n;
        readAround(p, n);
        vec3<R> sum(R(T(0)));
        ownShare = R(T(0));
        for (int k = 0; k < g.samples; k++) sum = sum + reconstruct(p, n, k, ownShare);
        ownShare = ownShare / R(T(g.samples));
        const vec3<R> own = p.read3(a.color, 0);
        return {lit(own.x, sum.x), lit(own.y, sum.y), lit(own.z, sum.z)};
    }

    // ---- pixels of one plane

    // The weights there, for every sub-sample, and how far from a plane all may be: x + g is x for g <= 2^-26 x, on
    // either side of x, where x is the exponent that the place gives.
    struct OnePlane {
        bool any;
        // Limits of distances from the plane, relative to the depth, of 1 - cosine, and of a normal's components from
        // another's; near: between a sub-sample and its own pixel, whose exponents are the least.
        float distance, distanceNear, cosine, cosineNear, turn;
        float rayMost, stepMost, originMost;  // no sum of components is larger
        R share;
        R divisor[kMostSamples], weight[kMostSamples * kMostTaps];
    };
    AA_INLINE void findWeights(OnePlane& f) const {
        const int side = 2 * a.radius + 1, taps = side * side;
        float least = 1e30f, leastNear = 1e30f;
        R share(T(0));
        for (int k = 0; k < g.samples; k++) {
            const auto logOf = [&](int i) __attribute__((always_inline)) {
                return -R(spatial(float(i % side - a.radius) - g.sample[k].offsetPx[0],
                                  float(i / side - a.radius) - g.sample[k].offsetPx[1]));
            };
            R largest = unusable(), weights(T(0)), own(T(0));
            for (int i = 0; i < taps; i++) largest = max(largest, logOf(i));
            for (int i = 0; i < taps; i++) {
                const bool isOwn = i == taps / 2;
                const float exponent = -float(logOf(i).v[0]);
                if (!isOwn) least = min(least, exponent);
                if (isOwn && exponent > 0) leastNear = min(leastNear, exponent);
                const R w = exp2Clamped(logOf(i) - largest);
                weights = weights + w;
                if (isOwn) own = w;
                f.weight[k * taps + i] = w;
            }
            f.divisor[k] = weights;
            share = share + own / weights;
        }
        f.share = share / R(T(g.samples));
        leastNear = min(least, leastNear);
        // A little less than half of what may be lost for either difference.
        const auto limit = [](float exponent, float factor) __attribute__((always_inline)) {
            return sqrt(0.48f * 0x1p-26f * exponent / factor);
        };
        f.distance = limit(least, a.depth), f.distanceNear = limit(leastNear, a.depth);
        f.cosine = limit(least, a.normal), f.cosineNear = limit(leastNear, a.normal);
        f.turn = sqrt(f.cosine * (1.0f / 12));
        f.any = !a.maxMetric && f.cosine > 5e-6f;  // below, a cosine's own rounding is more
        f.rayMost = f.stepMost = f.originMost = 0;
        const float most = float(a.radius + 1);
        for (int i = 0; i < 3; i++) {
            f.rayMost += abs(g.ray[i]) + abs(g.rayX[i]) * float(g.width) + abs(g.rayY[i]) * float(g.height);
            f.stepMost += most * (abs(g.rayX[i]) + abs(g.rayY[i]));
            f.originMost += most * (abs(g.originX[i]) + abs(g.originY[i]));
        }
    }
    // N<R> pixels and their own planes, along which all shaded pixels and sub-samples around them are to lie. With
    // n' = n + u and n" = n + v, 1 - n' n" is (1 - n n') + (1 - n n") - (1 - n n) - u v; and the distance between two
    // points along n' is the difference of theirs along n, and u times what lies between them.
    struct Held {
        SurfacePoint<R> own;
        R alongRay, perX, perY, constantX, constantY;  // of the plane's normal
        R farthest, turned;                            // largest difference of depth and of a normal's component
        Mask<R> same, empty;                           // on one plane so far; all background so far
        bool any;                                      // in some lane
    };
    AA_INLINE void hold(const OnePlane& f, Held& h, const SurfacePoint<R>& q, float dx, float dy, bool near) const {
        const R one(T(1)), depth = h.own.depthView, deeper = q.depthView - depth, apart = abs(deeper);
        const float cosine = near ? min(0.22f * f.cosine, f.cosineNear) : 0.22f * f.cosine;
        h.same = both(h.same, both(apart <= depth * R(T(0.05)),
                                   abs(one - dot(h.own.normalWorld, q.normalWorld)) <= R(T(cosine))));
        h.turned = max(h.turned, maxComponent(abs(q.normalWorld - h.own.normalWorld)));
        h.farthest = max(h.farthest, apart);
        h.empty = both(h.empty, isBackground(q.depthView));
        if (a.plainDepth) return;
        R from = deeper * h.alongRay + q.depthView * (h.perX * R(T(dx)) + h.perY * R(T(dy)));
        if (f.originMost > 0) from = from + (h.constantX * R(T(dx)) + h.constantY * R(T(dy)));
        h.same = both(h.same, abs(from) <= depth * R(T(0.3f * (near ? f.distanceNear : f.distance))));
    }
    AA_INLINE void holdPixels(const OnePlane& f, Held& h, int x, int y) const {
        const R zero(T(0)), one(T(1)), column = columns<R>(x);
        const long o = long(y) * g.stride + x;
        const int radius = a.radius;
        h.own = centrePoint<R>(g, o);
        const vec3<R> n = h.own.normalWorld;
        h.alongRay = dot(n, broadcast3<R>(g.ray) + broadcast3<R>(g.rayX) * column + broadcast3<R>(g.rayY) * R(T(y)));
        h.perX = dot(n, broadcast3<R>(g.rayX)), h.perY = dot(n, broadcast3<R>(g.rayY));
        h.constantX = dot(n, broadcast3<R>(g.originX)), h.constantY = dot(n, broadcast3<R>(g.originY));
        h.farthest = h.turned = zero;
        const auto within = both(column >= R(T(radius)), column <= R(T(g.width - 1 - radius)));
        h.same = both(within, both(h.own.depthView > R(T(1e-30)), abs(one - dot(n, n)) <= R(T(0.22f * f.cosine))));
        h.empty = within;
        for (int dy = -radius; dy <= radius; dy++)
            for (int dx = -radius; dx <= radius; dx++) {
                const long q = o + long(dy) * g.stride + dx;
                hold(f, h, centrePoint<R>(g, q), float(dx), float(dy), false);
                if (a.ids != SraaIds::off) h.same = both(h.same, negate(idsDiffer<R>(g.objectId + o, g.objectId + q)));
            }
        h.any = maskBits<R>(either(h.same, h.empty)) != 0;
    }
    AA_INLINE void holdSample(const OnePlane& f, Held& h, int k, long o) const {
        const SubSampleArgs& s = g.sample[k];
        hold(f, h, samplePoint<R>(g, k, o), s.offsetPx[0], s.offsetPx[1], true);
        if (a.ids != SraaIds::off) h.same = both(h.same, negate(idsDiffer<R>(g.objectId + o, s.objectId + o)));
    }
    // Lanes in which all lie on one plane, or on none.
    AA_INLINE unsigned onOnePlane(const OnePlane& f, const Held& h) const {
        if (!h.any) return 0;
        const R limit = h.own.depthView * R(T(0.3f * f.distanceNear));
        const R between =
            h.farthest * R(T(2 * f.rayMost)) + h.own.depthView * R(T(1.05f * f.stepMost)) + R(T(f.originMost));
        auto same = both(h.same, both(h.turned <= R(T(f.turn)), (h.turned + R(T(1e-6))) * between <= limit));
        if (a.plainDepth) same = both(same, h.farthest * R(T(2)) <= limit);
        return maskBits<R>(either(same, h.empty));
    }
    // N<R> pixels as if all of `lanes` lay on one plane.
    template <int radius>
    AA_INLINE void resolvePlane(const OnePlane& f, unsigned lanes, long o) const {
        constexpr int kSide = 2 * radius + 1, kTaps = kSide * kSide;
        const R zero(T(0));
        for (int c = 0; c < 3; c++) {
            const float* const p = a.color.c[c] + o;
            const R own = load<R>(p);
            R step[kTaps], sum(zero);
            Mask<R> steps = zero != zero;
            for (int i = 0; i < kTaps; i++) {
                step[i] = load<R>(p + long(i / kSide - radius) * g.stride + (i % kSide - radius)) - own;
                steps = either(steps, step[i] != zero);
            }
            if (maskBits<R>(steps) & lanes)
                for (int k = 0; k < g.samples; k++) {
                    const R* const weight = f.weight + k * kTaps;
                    R ofSample(zero);
#pragma GCC unroll 25
                    for (int i = 0; i < kTaps; i++)
                        if (i != kTaps / 2) ofSample = ofSample + step[i] * weight[i];
                    sum = sum + ofSample / f.divisor[k];
                }
            store(lit(own, sum), a.out.c[c] + o);
        }
    }

    // ---- rows

    AA_INLINE void put(const SraaPixels<R>& p, vec3<R> color, R ownShare, int count) const {
        alignas(64) float v[4][N<R>];
        store(color.x, v[0]), store(color.y, v[1]), store(color.z, v[2]), store(ownShare, v[3]);
        for (int i = 0; i < count; i++) {
            const long q = p.row + p.at.k[i];
            for (int c = 0; c < 3; c++) a.out.c[c][q] = v[c][i];
            if (a.ownShareLayer) a.ownShareLayer[q] = v[3][i];
        }
    }
    AA_INLINE void one(int x, int y) const {
        SraaPixels<R> p{{{x}, true}, R(T(x)), y, long(y) * g.stride};
        R ownShare;
        const vec3<R> color = resolve(p, ownShare);
        put(p, color, ownShare, 1);
    }
    AA_INLINE void listed(const int* x, int count, int y) const {
        using I = typename IntsOf<N<R>>::type;
        for (int i = 0; i < count; i += N<R>) {
            const int held = count - i < N<R> ? count - i : N<R>;
            SraaPixels<R> p;
            I at;
            for (int j = 0; j < N<R>; j++) at[j] = x[i + (j < held ? j : held - 1)];
            p.at.set(at), p.column = __builtin_convertvector(at, typename R::V), p.y = y, p.row = long(y) * g.stride;
            R ownShare;
            const vec3<R> color = resolve(p, ownShare);
            put(p, color, ownShare, held);
        }
    }
    AA_INLINE void rows(int y0, int y1) const {
        if constexpr (N<R> == 1) {
            for (int y = y0; y < y1; y++)
                for (int x = 0; x < g.width; x++) one(x, y);
        } else {
            OnePlane plane;
            findWeights(plane);
            Held held[kChunk / N<R>];
            int list[kChunk + N<R>];
            for (int y = y0; y < y1; y++) {
                const bool any = plane.any && y >= a.radius && y + a.radius < g.height;
                for (int x0 = 0; x0 < g.width; x0 += kChunk) {
                    const int groups = chunkGroups<R>(g.width - x0);
                    const long o = long(y) * g.stride + x0;
                    int count = 0;
                    if (any) {
                        for (int i = 0; i < groups; i++) {
                            prefetchSample(g, 0, o + i * N<R>);
                            holdPixels(plane, held[i], x0 + i * N<R>, y);
                        }
                        for (int k = 0; k < g.samples; k++)
                            for (int i = 0; i < groups; i++) {
                                if (k + 1 < g.samples) prefetchSample(g, k + 1, o + i * N<R>);
                                if (held[i].any) holdSample(plane, held[i], k, o + i * N<R>);
                            }
                    }
                    for (int i = 0; i < groups; i++) {
                        const unsigned flat = any ? onOnePlane(plane, held[i]) : 0;
                        const long q = o + i * N<R>;
                        if (flat) a.radius == 1 ? resolvePlane<1>(plane, flat, q) : resolvePlane<2>(plane, flat, q);
                        if (flat && a.ownShareLayer) store(plane.share, a.ownShareLayer + q);
                        count = appendMarked(~flat & ((1u << N<R>)-1u), x0 + i * N<R>, g.width, list, count);
                    }
                    listed(list, count, y);
                }
            }
        }
    }
};

template <class R>
__attribute__((flatten)) void sraaRows(const SraaArgs& a, int y0, int y1) {
    Sraa<R>{a}.rows(y0, y1);
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::SraaKernels, sraaKernels) = {AA_WIDE_ROWS(sraaRows)};
