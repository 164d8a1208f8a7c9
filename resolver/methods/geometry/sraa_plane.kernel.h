// sraa of pixels that lie on one plane with all pixels around them. There the geometry's share of every exponent is
// rounded away beside that of the place, so that all have the same weights. Included by *.kernel.cpp files.
#pragma once
#include "methods/geometry/sraa_base.kernel.h"

namespace AA_ARCH {

template <class R>
struct SraaPlane : SraaBase<R> {
    using typename SraaBase<R>::T;
    using SraaBase<R>::SraaBase, SraaBase<R>::a, SraaBase<R>::g, SraaBase<R>::kMostTaps, SraaBase<R>::kMostSamples,
        SraaBase<R>::spatial, SraaBase<R>::unusable, SraaBase<R>::lit;

    // The weights there, for every sub-sample, and how far from a plane all may be: x + g is x for g <= 2^-26 x, on
    // either side of x, where x is the exponent that the place gives.
    struct Limits {
        bool any;
        // Of distances from the plane, relative to the depth, of 1 - cosine, and of a normal's components from
        // another's; near: between a sub-sample and its own pixel, whose exponents are the least.
        float distance, distanceNear, cosine, cosineNear, turn;
        float rayMost, stepMost, originMost;  // no sum of components is larger
        R share;
        R divisor[kMostSamples], weight[kMostSamples * kMostTaps];
    };
    AA_INLINE void findLimits(Limits& f) const {
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
        f.distance = 0.3f * limit(least, a.depth), f.distanceNear = 0.3f * limit(leastNear, a.depth);
        const float cosine = limit(least, a.normal);
        f.cosine = 0.22f * cosine, f.cosineNear = min(f.cosine, limit(leastNear, a.normal));
        f.turn = sqrt(cosine * (1.0f / 12));
        f.rayMost = f.stepMost = f.originMost = 0;
        const float most = float(a.radius + 1);
        for (int i = 0; i < 3; i++) {
            f.rayMost += abs(g.ray[i]) + abs(g.rayX[i]) * float(g.width) + abs(g.rayY[i]) * float(g.height);
            f.stepMost += most * (abs(g.rayX[i]) + abs(g.rayY[i]));
            f.originMost += most * (abs(g.originX[i]) + abs(g.originY[i]));
        }
        const bool oneKind = f.stepMost == 0 || f.originMost == 0;  // of camera
        f.any = !a.maxMetric && oneKind && cosine > 5e-6f;          // below, a cosine's own rounding is more
    }

    // ---- which pixels these are

    // N<R> pixels' own planes, along which all shaded pixels and sub-samples around them are to lie. With n' = n + u
    // and n" = n + v, 1 - n' n" is (1 - n n') + (1 - n n") - (1 - n n) - u v; and the distance between two points along
    // n' is the difference of theirs along n, and u times what lies between them.
    struct Own {
        SurfacePoint<R> point;
        R alongRay, perX, perY;  // the normal's parts of the ray and of what changes per pixel: Apart
    };
    // What was seen of the points around.
    struct Seen {
        R nearest, farthest;  // depth
        R turned;             // sum of the components of normals' differences: none differs more from the own one
        Mask<R> same;         // on one plane so far
    };
    // A piece of a row, group by group. Long, because memory gives most where few planes are read far along: at 1080p
    // sub-samples took twice the time in pieces of 256 pixels.
    static constexpr int kPiece = 2048, kGroups = kPiece / N<R>;
    struct Piece {
        int x0, y, groups;
        long o;  // of its first pixel
        Own own[kGroups];
        Seen seen[kGroups];
        bool any[kGroups];  // some lane may be on one plane, or all background
    };
    static AA_INLINE int groupsOf(int width) { return ((width < kPiece ? width : kPiece) + N<R> - 1) / N<R>; }
    static constexpr float kPlain = 0.05f;  // of the depth: no point of one plane is deeper or nearer by more
    AA_INLINE R fromUnit(const Own& own) const {
        const vec3<R> n = own.point.normalWorld;
        return abs(R(T(1)) - dot(n, n));
    }
    // What tells a point's distance. A perspective camera's rays differ from pixel to pixel, a parallel one's origins.
    enum class Apart { perspective, parallel, depth };
    AA_INLINE Apart apart(const Limits& f) const {
        return a.plainDepth ? Apart::depth : f.originMost > 0 ? Apart::parallel : Apart::perspective;
    }
    template <Apart kind>
    AA_INLINE R distanceLimit(const Own& own, float relative) const {
        return own.point.depthView * R(T(kind == Apart::depth ? kPlain : relative));
    }
    // Whether a point of this depth lies on its plane; step: of perX and perY, to where it is seen.
    template <Apart kind>
    AA_INLINE Mask<R> onPlane(const Own& own, R depth, R step, R distance) const {
        const R deeper = depth - own.point.depthView;
        if constexpr (kind == Apart::depth) return abs(deeper) <= distance;
        if constexpr (kind == Apart::perspective) step = depth * step;
        return abs(deeper * own.alongRay + step) <= distance;
    }
    AA_INLINE R stepTo(const Own& own, int dx, int dy) const {
        if (dx == 0) return own.perY * R(T(dy));
        if (dy == 0) return own.perX * R(T(dx));
        return own.perX * R(T(dx)) + own.perY * R(T(dy));
    }
    static AA_INLINE R difference(vec3<R> m, vec3<R> n) { return abs(m.x - n.x) + abs(m.y - n.y) + abs(m.z - n.z); }

    // How far normals turn on the way from each pixel's to any in its window: along its row, then along a column.
    template <int radius>
    AA_INLINE void turnsAround(Piece& p) const {
        constexpr int kMargin = 16;
        alignas(64) float along[kPiece + 2 * kMargin], down[kPiece + 2 * kMargin];
        for (int x = -N<R>; x < (p.groups + 1) * N<R>; x += N<R>) {
            const auto normal = [&](int dx, int dy) __attribute__((always_inline)) {
                return load3<R>(g.normalWorld, p.o + x + dx + long(dy) * g.stride);
            };
            store(difference(normal(0, 0), normal(1, 0)), along + kMargin + x);
            R sum(T(0));
            for (int dy = -radius; dy < radius; dy++) sum = sum + difference(normal(0, dy), normal(0, dy + 1));
            store(sum, down + kMargin + x);
        }
        for (int i = 0; i < p.groups; i++) {
            const int at = kMargin + i * N<R>;
            R sum = load<R>(down + at);
            for (int dx = 1; dx <= radius; dx++)
                sum = sum + (load<R>(down + at - dx) + load<R>(down + at + dx)) +
                      (load<R>(along + at - dx) + load<R>(along + at + dx - 1));
            p.seen[i].turned = sum;
        }
    }
    template <Apart kind, int radius>
    AA_INLINE void holdPixels(const Limits& f, Piece& p) const {
        turnsAround<radius>(p);
        for (int i = 0; i < p.groups; i++) {
            Own& own = p.own[i];
            Seen& s = p.seen[i];
            const R column = columns<R>(p.x0 + i * N<R>);
            const long o = p.o + i * N<R>;
            own.point = centrePoint<R>(g, o);
            const vec3<R> n = own.point.normalWorld;
            own.alongRay =
                dot(n, broadcast3<R>(g.ray) + broadcast3<R>(g.rayX) * column + broadcast3<R>(g.rayY) * R(T(p.y)));
            own.perX = dot(n, broadcast3<R>(kind == Apart::parallel ? g.originX : g.rayX));
            own.perY = dot(n, broadcast3<R>(kind == Apart::parallel ? g.originY : g.rayY));
            const auto within = both(column >= R(T(radius)), column <= R(T(g.width - 1 - radius)));
            Mask<R> same = both(within, both(own.point.depthView > R(T(1e-30)), fromUnit(own) <= R(T(f.cosine))));
            const R distance = distanceLimit<kind>(own, f.distance);
            R nearest(T(1e10)), farthest(T(0));
#pragma GCC unroll 5
            for (int dy = -radius; dy <= radius; dy++)
#pragma GCC unroll 5
                for (int dx = -radius; dx <= radius; dx++) {
                    const long q = o + long(dy) * g.stride + dx;
                    const R depth = load<R>(g.depthView + q);
                    nearest = min(nearest, depth), farthest = max(farthest, depth);
                    if (dx || dy) same = both(same, onPlane<kind>(own, depth, stepTo(own, dx, dy), distance));
                    if (a.ids != SraaIds::off) same = both(same, negate(idsDiffer<R>(g.objectId + o, g.objectId + q)));
                }
            s.nearest = select(within, nearest, R(T(0))), s.farthest = farthest, s.same = same;
            p.any[i] = maskBits<R>(either(same, isBackground(s.nearest))) != 0;
        }
    }
    template <Apart kind>
    AA_INLINE void holdSample(const Limits& f, const Own& own, Seen& s, int k, long o) const {
        const SubSampleArgs& sample = g.sample[k];
        const SurfacePoint<R> q = samplePoint<R>(g, k, o);
        const R step = own.perX * R(T(sample.offsetPx[0])) + own.perY * R(T(sample.offsetPx[1]));
        const R distance = distanceLimit<kind>(own, f.distanceNear);
        s.same = both(s.same, onPlane<kind>(own, q.depthView, step, distance));
        s.nearest = min(s.nearest, q.depthView), s.farthest = max(s.farthest, q.depthView);
        s.turned = s.turned + difference(q.normalWorld, own.point.normalWorld);
        if (a.ids != SraaIds::off) s.same = both(s.same, negate(idsDiffer<R>(g.objectId + o, sample.objectId + o)));
    }
    // Two sub-samples at a time: the fewer the visits, the less is read and written of what was seen; but of more
    // planes at once the processor foresees less. What lies a little farther along is fetched beside.
    template <Apart kind>
    AA_INLINE void holdSamples(const Limits& f, Piece& p) const {
        int k = 0;
        for (; k + 2 <= g.samples; k += 2) visit<kind, 2>(f, p, k);
        if (k < g.samples) visit<kind, 1>(f, p, k);
    }
    template <Apart kind, int count>
    AA_INLINE void visit(const Limits& f, Piece& p, int k) const {
        constexpr int kAhead = 448, kLine = 16;  // pixels
        for (int i = 0; i < p.groups; i++) {
            const long o = p.o + i * N<R>;
            if (i % (kLine / N<R>) == 0)
                for (int j = 0; j < count; j++) prefetch(g.sample[k + j], o + kAhead);
            if (!p.any[i]) continue;
            const Own own = p.own[i];
            Seen s = p.seen[i];
            for (int j = 0; j < count; j++) holdSample<kind>(f, own, s, k + j, o);
            p.seen[i] = s;
        }
    }
    // Into the second cache: the first has no room for so much.
    AA_INLINE void prefetch(const SubSampleArgs& sample, long o) const {
        __builtin_prefetch(sample.depthView + o, 0, 1);
        for (int c = 0; c < 3; c++) __builtin_prefetch(sample.normalWorld.c[c] + o, 0, 1);
    }
    template <Apart kind>
    AA_INLINE void hold(const Limits& f, Piece& p) const {
        a.radius == 1 ? holdPixels<kind, 1>(f, p) : holdPixels<kind, 2>(f, p);
        holdSamples<kind>(f, p);
    }

    // The lanes of a group in which all lie on one plane, or on none.
    AA_INLINE unsigned onOnePlane(const Limits& f, const Piece& p, int i) const {
        if (!p.any[i]) return 0;
        const Own& own = p.own[i];
        const Seen& s = p.seen[i];
        const R depth = own.point.depthView, deepest = max(s.farthest - depth, depth - s.nearest);
        auto same = both(s.same, deepest <= depth * R(T(kPlain)));
        if (a.plainDepth) same = both(same, deepest * R(T(2)) <= depth * R(T(f.distanceNear)));
        const R most = min(R(T(f.cosineNear)) - fromUnit(own), R(T(f.turn)));
        const auto still = both(s.turned <= most, shortEnough(f, depth, deepest, s.turned));
        auto found = either(both(same, still), isBackground(s.nearest));
        // Where a sum is beyond this, some normal is beyond f.turn: each of the way's pieces is twice as long at most.
        const int side = 2 * a.radius + 1, pieces = 2 * (side * side - 1) + g.samples;
        const auto open = both(both(same, negate(still)), s.turned <= R(T(f.turn * 3.1f * float(pieces))));
        if (maskBits<R>(open)) found = either(found, both(same, turnedLittle(f, own, deepest, p.o + i * N<R>)));
        return maskBits<R>(found);
    }
    // Whether such a turn between any two points is lost.
    AA_INLINE Mask<R> shortEnough(const Limits& f, R depth, R deepest, R turned) const {
        const R between = deepest * R(T(2 * f.rayMost)) + depth * R(T(1.05f * f.stepMost)) + R(T(f.originMost));
        return (turned + R(T(1e-6))) * between <= depth * R(T(f.distanceNear));
    }
    // Normals one by one, for surfaces that bend a little.
    __attribute__((noinline)) Mask<R> turnedLittle(const Limits& f, const Own& own, R deepest, long o) const {
        R turned(T(0));
        Mask<R> same = turned == turned;
        const auto see = [&](vec3<R> normal, float cosine) __attribute__((always_inline)) {
            turned = max(turned, maxComponent(abs(normal - own.point.normalWorld)));
            same = both(same, abs(R(T(1)) - dot(own.point.normalWorld, normal)) <= R(T(cosine)));
        };
        for (int dy = -a.radius; dy <= a.radius; dy++)
            for (int dx = -a.radius; dx <= a.radius; dx++)
                see(load3<R>(g.normalWorld, o + long(dy) * g.stride + dx), f.cosine);
        for (int k = 0; k < g.samples; k++) see(load3<R>(g.sample[k].normalWorld, o), f.cosineNear);
        return both(same, both(turned <= R(T(f.turn)), shortEnough(f, own.point.depthView, deepest, turned)));
    }

    // ---- their colours

    // N<R> pixels as if all of `lanes` lay on one plane.
    template <int radius>
    AA_INLINE void resolve(const Limits& f, unsigned lanes, long o) const {
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
};

}  // namespace AA_ARCH
