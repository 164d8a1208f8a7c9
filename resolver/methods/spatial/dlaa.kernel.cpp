#include "methods/spatial/dlaa.h"

#include "kernels/lanes.h"

namespace AA_ARCH {
using namespace aa;

// The second difference of the colours: both neighbours at `step`, minus twice the centre.
template <class R>
AA_INLINE vec3<R> secondDifference(const RgbIn& in, long o, long step, vec3<R> c) {
    return (colourAt<R>(in.c, o - step) - c) + (colourAt<R>(in.c, o + step) - c);
}
// The border of a finished row, and of the planes when it is their first or last: its last pixels repeat.
AA_INLINE void repeatBorder(const DlaaEdgeArgs& a, float* plane, int y) {
    float* const row = plane + long(y) * a.stride;
    for (int k = 1; k <= kDlaaReach; k++) row[-k] = row[0], row[a.width - 1 + k] = row[a.width - 1];
    if (y > 0 && y < a.height - 1) return;
    for (int k = 1; k <= kDlaaReach; k++)
        for (int x = -kDlaaReach; x < a.width + kDlaaReach; x++) {
            if (y == 0) row[x - long(k) * a.stride] = row[x];
            if (y == a.height - 1) row[x + long(k) * a.stride] = row[x];
        }
}
template <class R>
__attribute__((flatten)) void edgeRows(const DlaaEdgeArgs& a, int y0, int y1) {
    const R four(Elem<R>(4)), calm(Elem<R>(a.busyAbove));
    const R fromHere = R(Elem<R>(kDlaaStrong));
    for (int y = y0; y < y1; y++) {
        for (int x = 0; x < a.width; x += 8) {
            unsigned strong = 0, busy = 0;
            for (int i = 0; i < 8; i += N<R>) {
                const long o = long(y) * a.stride + x + i;
                const vec3<R> c = colourAt<R>(a.in.c, o);
                const vec3<R> alongX = secondDifference(a.in, o, 1, c), alongY = secondDifference(a.in, o, a.stride, c);
                const R strength = saturate(luma709(abs(alongX + alongY)) * four);  // 8-bit storage clamped it
                store(strength, a.edge + o);
                store(luma709(c), a.luma + o);
                strong |= maskBits<R>(strength >= fromHere) << i;
                const R largest = max(maxComponent(abs(alongX)), maxComponent(abs(alongY)));
                busy |= maskBits<R>(largest > calm) << i;
            }
            const long group = long(y) * ((a.width + 7) / 8) + (x >> 3);
            a.strong[group] = uint8_t(__builtin_popcount(strong));
            a.busy[group] = uint8_t(busy);
        }
        repeatBorder(a, a.edge, y);
        repeatBorder(a, a.luma, y);
    }
}
// Twice the sum of two bilinear taps at +-1.5 px is the sum of the four pixels at +-1 and +-2; here minus 4 times the
// centre, which keeps constants exact.
template <class R>
AA_INLINE vec3<R> wideDifference(const DlaaArgs& a, long o, long step, vec3<R> c) {
    return ((colourAt<R>(a.in.c, o - step) - c) + (colourAt<R>(a.in.c, o + step) - c)) +
           ((colourAt<R>(a.in.c, o - 2 * step) - c) + (colourAt<R>(a.in.c, o + 2 * step) - c));
}
// How strongly an edge that runs the other way calls for this blur.
template <class R>
AA_INLINE R shortStrength(const DlaaArgs& a, vec3<R> difference) {
    using T = Elem<R>;
    return R(T(a.lambda)) * luma709(abs(difference) * R(T(0.25))) - R(T(a.epsilon));
}
template <class R>
AA_INLINE R shortMaskOf(R strength, vec3<R> blur) {
    using T = Elem<R>;
    const R zero(T(0)), one(T(1)), level = luma709(blur);
    const R ratio = saturate(strength / max(R(T(1e-12)), level));
    return select(level > zero, ratio, select(strength > zero, one, zero));
}
// Mean of the taps at +-1.5, +-3.5, +-5.5, +-7.5 px: of 16 pixels.
template <class R>
AA_INLINE R meanOf16(const float* p, long step) {
    R sum(Elem<R>(0));
    for (int i = 1; i <= kDlaaReach; i++) sum = sum + (load<R>(p - i * step) + load<R>(p + i * step));
    return sum * R(Elem<R>(1.0 / 16));
}
// The share of the pixel's own colour in its mix with a neighbour that gives it the luma of the blur: with the blur's
// luma y, its own yc and the neighbour's yn, (y - yn) / (yc - yn) = 1 + (y - yc) / (yc - yn). Where yc = yn that is 1,
// no shift; nearly equal lumas have no meaningful ratio and go there continuously. Their difference is that of the
// colours, which is exact when they are close.
template <class R>
AA_INLINE R shareOfOwn(R blurMinusOwn, R ownMinusNeighbour) {
    using T = Elem<R>;
    const R one(T(1)), least(T(kDlaaEqualLumas * kDlaaEqualLumas));
    return saturate(one + blurMinusOwn * ownMinusNeighbour / max(ownMinusNeighbour * ownMinusNeighbour, least));
}
// The shift across a long edge whose luma matches the blur along it, from the neighbours before and behind.
template <class R>
AA_INLINE vec3<R> shiftedBy(R missing, vec3<R> before, vec3<R> c, vec3<R> behind, R& sum) {
    const R near = shareOfOwn(missing, luma709(c - before)), far = shareOfOwn(missing, luma709(c - behind));
    sum = sum + near + far;
    return mix(behind, mix(before, c, near), far);
}
template <class R>
AA_INLINE vec3<R> longEdges(const DlaaArgs& a, long o, vec3<R> centre, vec3<R> c, R maskH, R maskV) {
    const vec3<R> left = colourAt<R>(a.in.c, o - 1), right = colourAt<R>(a.in.c, o + 1),
                  top = colourAt<R>(a.in.c, o - a.stride), bottom = colourAt<R>(a.in.c, o + a.stride);
    const R own = load<R>(a.luma + o);
    R sum(Elem<R>(0));
    const vec3<R> vertical = shiftedBy(meanOf16<R>(a.luma + o, a.stride) - own, left, centre, right, sum);
    const vec3<R> horizontal = shiftedBy(meanOf16<R>(a.luma + o, 1) - own, top, centre, bottom, sum);
    const R shifts = saturate(sum * R(Elem<R>(1 / kDlaaFade)));  // all four zero: no shift
    c = mix(c, mix(centre, vertical, shifts), maskV);
    return mix(c, mix(centre, horizontal, shifts), maskH);
}
template <class R>
AA_INLINE R bilinearCorner(const float* p, long across, long down) {  // tap at (+-1.5, +-1.5)
    return (load<R>(p + across + down) + load<R>(p + 2 * across + down)) +
           (load<R>(p + across + 2 * down) + load<R>(p + 2 * across + 2 * down));
}
template <class R>
AA_INLINE R highlightMask(const DlaaArgs& a, long o) {
    using T = Elem<R>;
    const float* const e = a.edge + o;
    const long s = a.stride;
    const R corners = bilinearCorner<R>(e, 1, s) + bilinearCorner<R>(e, 1, -s) + bilinearCorner<R>(e, -1, s) +
                      bilinearCorner<R>(e, -1, -s);  // 4 * mean of 4 pixels each
    R cross = load<R>(e);
    for (int i = 1; i <= 2; i++)
        cross = cross + (load<R>(e - i) + load<R>(e + i)) + (load<R>(e - i * s) + load<R>(e + i * s));
    return saturate((corners + cross) * R(T(3.0 / 25)) - R(T(1.5)));
}
// What each group of 8 columns of a row needs, from what the edge pass knows of it and its neighbours.
inline constexpr int kMostGroups = 16384 / 8;
enum Work : uint8_t { kNothing = 0, kShortEdges = 1, kLongEdges = 2 };
struct GroupWork {
    const DlaaArgs& a;
    int groups;
    uint8_t rows[kMostGroups];  // of y - 8 to y + 8, with a strong pixel in the group; kept up to date from row to row
    uint8_t work[kMostGroups];
    AA_INLINE const uint8_t* strong(int y) const {
        return a.strong + long(y < 0 ? 0 : y < a.height ? y : a.height - 1) * groups;
    }
    AA_INLINE void add(int y) {
        const uint8_t* __restrict const s = strong(y);
        uint8_t* __restrict const r = rows;
        for (int g = 0; g < groups; g++) r[g] = uint8_t(r[g] + (s[g] ? 1 : 0));
    }
    AA_INLINE void remove(int y) {
        const uint8_t* __restrict const s = strong(y);
        uint8_t* __restrict const r = rows;
        for (int g = 0; g < groups; g++) r[g] = uint8_t(r[g] - (s[g] ? 1 : 0));
    }
    // A group at the left or right border is not looked at more closely.
    AA_INLINE void classify(int y) {
        const uint8_t* __restrict const s = strong(y);
        const uint8_t* __restrict const b = a.busy + long(y) * groups;
        const uint8_t *const above = y > 0 ? b - groups : b, *const below = y + 1 < a.height ? b + groups : b;
        const uint8_t* __restrict const r = rows;
        uint8_t* __restrict const w = work;
        for (int g = 1; g + 2 < groups; g++) {
            const uint8_t busy = uint8_t(b[g] | above[g] | below[g] | b[g - 1] >> 7 | (b[g + 1] & 1));
            const uint8_t beside = uint8_t(s[g - 1] + s[g] + s[g + 1]), column = uint8_t(r[g] - (s[g] ? 1 : 0));
            const uint8_t most = beside > column ? beside : column;
            w[g] = uint8_t((busy ? kShortEdges : 0) | (most >= kDlaaFewestStrong ? kLongEdges : 0));
        }
        w[0] = w[groups - 1] = w[groups > 1 ? groups - 2 : 0] = kShortEdges | kLongEdges;
    }
};
template <class R>
AA_INLINE void filterPixels(const DlaaArgs& a, long o, uint8_t work) {
    using T = Elem<R>;
    const R sixth(T(1.0 / 6)), zero(T(0)), one(T(1)), two(T(2));
    const vec3<R> centre = colourAt<R>(a.in.c, o);
    vec3<R> c = centre;
    R maskH = zero, maskV = zero, onlyLong = zero;
    if (work & kShortEdges) {
        const vec3<R> wideH = wideDifference(a, o, 1, centre), wideV = wideDifference(a, o, a.stride, centre);
        const R strengthH = shortStrength(a, wideH), strengthV = shortStrength(a, wideV);
        if (maskBits<R>(either(strengthH > zero, strengthV > zero))) {
            const vec3<R> blurH = centre + wideH * sixth, blurV = centre + wideV * sixth;
            maskH = shortMaskOf(strengthH, blurV), maskV = shortMaskOf(strengthV, blurH);
            c = mix(centre, blurH, maskV);
            c = mix(c, blurV, maskH * R(T(0.5)));  // half: the two passes would over-blur
        }
    }
    if (work & kLongEdges) {
        const R longH = saturate(meanOf16<R>(a.edge + o, 1) * two - one);
        const R longV = saturate(meanOf16<R>(a.edge + o, a.stride) * two - one);
        const R dominance = saturate((abs(longH - longV) - R(T(a.longThreshold))) * R(T(1 / kDlaaFade)));
        if (maskBits<R>(dominance > zero)) c = longEdges(a, o, centre, c, longH * dominance, longV * dominance);
        onlyLong = (longH - longV) * dominance;
    }
    if (a.preserveHighlights) c = mix(c, centre, highlightMask<R>(a, o));
    store(c.x, a.out.c[0] + o);
    store(c.y, a.out.c[1] + o);
    store(c.z, a.out.c[2] + o);
    if (a.shortMask) {
        store(maskH - maskV, a.shortMask + o);
        store(onlyLong, a.longMask + o);
    }
}
template <class R>
AA_INLINE void keepPixels(const DlaaArgs& a, long o) {
    for (long p = o; p < o + 8; p += N<R>) {
        for (int c = 0; c < 3; c++) store(load<R>(a.in.c[c] + p), a.out.c[c] + p);
        if (a.shortMask) store(R(Elem<R>(0)), a.shortMask + p), store(R(Elem<R>(0)), a.longMask + p);
    }
}
template <class R>
__attribute__((flatten)) void filterRows(const DlaaArgs& a, int y0, int y1) {
    GroupWork groups{a, (a.width + 7) / 8, {}, {}};
    for (int y = y0 - kDlaaReach; y <= y0 + kDlaaReach; y++) groups.add(y);
    for (int y = y0; y < y1; y++) {
        groups.classify(y);
        for (int g = 0; g < groups.groups; g++) {
            const long o = long(y) * a.stride + 8 * g;
            const uint8_t work = groups.work[g];
            if (work == kNothing)
                keepPixels<R>(a, o);
            else
                for (int i = 0; i < 8; i += N<R>) filterPixels<R>(a, o + i, work);
        }
        groups.add(y + kDlaaReach + 1);
        groups.remove(y - kDlaaReach);
    }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::DlaaKernels, dlaaKernels) = {AA_ROWS(edgeRows), AA_ROWS(filterRows)};
