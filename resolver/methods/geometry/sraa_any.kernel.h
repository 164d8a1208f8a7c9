// sraa of any pixels: N of them, side by side or not, with weights of their own. Included by *.kernel.cpp
// files.
#pragma once
#include "kernels/sparse.h"
#include "kernels/texels.h"
#include "methods/geometry/sraa_base.kernel.h"

namespace AA_ARCH {

// N pixels anywhere, all of which have the same rows around them: those of the picture's edge are together in one row.
template <class R>
struct SraaPixels {
    Offsets<R> at;  // in the planes
    R x, y;
    int anyRow;  // the row of one of them

    AA_INLINE R read(const float* plane, long offset) const { return gather<R>(plane + offset, at); }
    AA_INLINE vec3<R> read3(const RgbIn& image, long offset) const {
        return {read(image.c[0], offset), read(image.c[1], offset), read(image.c[2], offset)};
    }
    AA_INLINE Mask<R> idsApart(const uint32_t* a, const uint32_t* b, long offset) const {
        b += offset;
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
struct SraaAny : SraaBase<R> {
    using typename SraaBase<R>::T;
    using SraaBase<R>::SraaBase, SraaBase<R>::a, SraaBase<R>::g, SraaBase<R>::kMostTaps, SraaBase<R>::spatial,
        SraaBase<R>::unusable, SraaBase<R>::lit;

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
            if (p.anyRow + dy < 0 || p.anyRow + dy >= g.height) continue;
            for (int dx = -a.radius; dx <= a.radius; dx++, n.count++) {
                const int i = n.count;
                const long offset = long(dy) * g.stride + dx;
                if (!dx && !dy) n.own = i;
                n.dx[i] = float(dx), n.dy[i] = float(dy), n.offset[i] = offset;
                n.depthView[i] = p.read(g.depthView, offset);
                n.normalWorld[i] = validNormal(p.read3(g.normalWorld, offset));
                n.step[i] = p.read3(a.color, offset) - centre;
                n.empty[i] = isBackground(n.depthView[i]);
                const R column = p.x + R(T(dx));
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
                const auto v = separation(g, p.x, p.y, s.offsetPx[0], s.offsetPx[1], stepX, stepY).vector(depth, other);
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

    AA_INLINE void put(const SraaPixels<R>& p, vec3<R> color, R ownShare, int count) const {
        alignas(64) float v[4][N<R>];
        store(color.x, v[0]), store(color.y, v[1]), store(color.z, v[2]), store(ownShare, v[3]);
        for (int i = 0; i < count; i++) {
            const int q = p.at.k[i];
            for (int c = 0; c < 3; c++) a.out.c[c][q] = v[c][i];
            if (a.ownShareLayer) a.ownShareLayer[q] = v[3][i];
        }
    }
    AA_INLINE void one(int x, int y) const {
        SraaPixels<R> p{{{y * g.stride + x}, true}, R(T(x)), R(T(y)), y};
        R ownShare;
        const vec3<R> color = resolve(p, ownShare);
        put(p, color, ownShare, 1);
    }
    // Pixels that wait until there are N of them.
    struct Waiting {
        int count = 0;
        int x[2 * N<R>], y[2 * N<R>];
    };
    // The first N, or all; the rest moves up. No part of who calls it: it is long.
    __attribute__((noinline)) void resolveFirst(Waiting& w) const {
        const int held = w.count < N<R> ? w.count : N<R>;
        if (held == 0) return;
        using I = typename IntsOf<N<R>>::type;
        I x, y;
        for (int j = 0; j < N<R>; j++) x[j] = w.x[j < held ? j : held - 1], y[j] = w.y[j < held ? j : held - 1];
        SraaPixels<R> p;
        p.at.set(y * g.stride + x);
        p.x = __builtin_convertvector(x, typename R::V), p.y = __builtin_convertvector(y, typename R::V);
        p.anyRow = w.y[0];
        R ownShare;
        const vec3<R> color = resolve(p, ownShare);
        put(p, color, ownShare, held);
        w.count -= held;
        for (int j = 0; j < w.count; j++) w.x[j] = w.x[held + j], w.y[j] = w.y[held + j];
    }
    AA_INLINE void take(Waiting& w, unsigned lanes, int x, int y) const {
        const int before = w.count;
        w.count = appendMarked(lanes, x, g.width, w.x, w.count);
        for (int j = before; j < w.count; j++) w.y[j] = y;
        if (w.count >= N<R>) resolveFirst(w);
    }
};

}  // namespace AA_ARCH
