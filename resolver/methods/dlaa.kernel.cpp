#include "kernels/lanes.h"
#include "methods/dlaa_kernels.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
AA_INLINE vec3<R> colour_at(const RgbIn& in, long o) {
    return {load<R>(in.c[0] + o), load<R>(in.c[1] + o), load<R>(in.c[2] + o)};
}
template <class R>
__attribute__((flatten)) void edgeRows(const DlaaEdgeArgs& a, int y0, int y1) {
    const R four(Elem<R>(4));
    const R fromHere = R(Elem<R>(kDlaaStrong));
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += 8) {
            unsigned bits = 0;
            for (int i = 0; i < 8; i += N<R>) {
                const long o = long(y) * a.stride + x + i;
                const vec3<R> c = colour_at<R>(a.in, o);
                const vec3<R> highPass = (colour_at<R>(a.in, o - 1) - c) + (colour_at<R>(a.in, o + 1) - c) +
                                         (colour_at<R>(a.in, o - a.stride) - c) +
                                         (colour_at<R>(a.in, o + a.stride) - c);
                const R strength = saturate(luma709(abs(highPass) * four));  // 8-bit storage clamped it
                store(strength, a.edge + o);
                bits |= mask_bits<R>(strength >= fromHere) << i;
            }
            a.strong[long(y) * ((a.width + 7) / 8) + (x >> 3)] = uint8_t(bits);
        }
}
// Twice the sum of two bilinear taps at +-1.5 px is the sum of the four pixels at +-1 and +-2; here minus 4 times the
// centre, which keeps constants exact.
template <class R>
AA_INLINE vec3<R> wide_difference(const DlaaArgs& a, long o, long step, vec3<R> c) {
    return ((colour_at<R>(a.in, o - step) - c) + (colour_at<R>(a.in, o + step) - c)) +
           ((colour_at<R>(a.in, o - 2 * step) - c) + (colour_at<R>(a.in, o + 2 * step) - c));
}
// How strongly an edge that runs the other way calls for this blur.
template <class R>
AA_INLINE R short_strength(const DlaaArgs& a, vec3<R> difference) {
    using T = Elem<R>;
    return R(T(a.lambda)) * luma709(abs(difference) * R(T(0.25))) - R(T(a.epsilon));
}
template <class R>
AA_INLINE R short_mask(R strength, vec3<R> blur) {
    using T = Elem<R>;
    const R zero(T(0)), one(T(1)), level = luma709(blur);
    const R ratio = saturate(strength / max(R(T(1e-12)), level));
    return select(level > zero, ratio, select(strength > zero, one, zero));
}
// Mean of the taps at +-1.5, +-3.5, +-5.5, +-7.5 px: of 16 pixels.
template <class R>
AA_INLINE R mean_of_16(const float* p, long step) {
    R sum(Elem<R>(0));
    for (int i = 1; i <= 8; i++) sum = sum + (load<R>(p - i * step) + load<R>(p + i * step));
    return sum * R(Elem<R>(1.0 / 16));
}
template <class R>
AA_INLINE vec3<R> mean_of_16(const DlaaArgs& a, long o, long step) {
    return {mean_of_16<R>(a.in.c[0] + o, step), mean_of_16<R>(a.in.c[1] + o, step), mean_of_16<R>(a.in.c[2] + o, step)};
}
// numerator / denominator, or 1 (no shift) where there is nothing to divide by.
template <class R>
AA_INLINE R ratio_or_one(R numerator, R denominator) {
    const R one(Elem<R>(1));
    const auto usable = abs(denominator) > R(Elem<R>(1e-12));
    return select(usable, numerator / select(usable, denominator, one), one);
}
// The shift across a long edge whose luma matches the blur along it, from the neighbours before and behind.
template <class R>
AA_INLINE vec3<R> shifted_to(R target, vec3<R> before, vec3<R> c, vec3<R> behind, R& sum) {
    const R one(Elem<R>(1)), own = luma709(c), lumaBefore = luma709(before), lumaBehind = luma709(behind);
    const R near = saturate(ratio_or_one(target - lumaBefore, own - lumaBefore));
    const auto flat = abs(own - lumaBehind) <= R(Elem<R>(1e-12));
    const R far = saturate(select(flat, one, one + ratio_or_one(target - own, own - lumaBehind)));
    sum = sum + near + far;
    return mix(behind, mix(before, c, near), far);
}
template <class R>
AA_INLINE vec3<R> long_edges(const DlaaArgs& a, long o, vec3<R> centre, vec3<R> c, R maskH, R maskV) {
    const vec3<R> left = colour_at<R>(a.in, o - 1), right = colour_at<R>(a.in, o + 1),
                  top = colour_at<R>(a.in, o - a.stride), bottom = colour_at<R>(a.in, o + a.stride);
    R sum(Elem<R>(0));
    vec3<R> vertical = shifted_to(luma709(mean_of_16<R>(a, o, a.stride)), left, centre, right, sum);
    vec3<R> horizontal = shifted_to(luma709(mean_of_16<R>(a, o, 1)), top, centre, bottom, sum);
    const auto none = sum == R(Elem<R>(0));  // all four zero: no shift
    vertical = select(none, centre, vertical);
    horizontal = select(none, centre, horizontal);
    c = mix(c, vertical, maskV);
    return mix(c, horizontal, maskH);
}
template <class R>
AA_INLINE R bilinear_corner(const float* p, long across, long down) {  // tap at (+-1.5, +-1.5)
    return (load<R>(p + across + down) + load<R>(p + 2 * across + down)) +
           (load<R>(p + across + 2 * down) + load<R>(p + 2 * across + 2 * down));
}
template <class R>
AA_INLINE R highlight_mask(const DlaaArgs& a, long o) {
    using T = Elem<R>;
    const float* const e = a.edge + o;
    const long s = a.stride;
    const R corners = bilinear_corner<R>(e, 1, s) + bilinear_corner<R>(e, 1, -s) + bilinear_corner<R>(e, -1, s) +
                      bilinear_corner<R>(e, -1, -s);  // 4 * mean of 4 pixels each
    R cross = load<R>(e);
    for (int i = 1; i <= 2; i++)
        cross = cross + (load<R>(e - i) + load<R>(e + i)) + (load<R>(e - i * s) + load<R>(e + i * s));
    return saturate((corners + cross) * R(T(3.0 / 25)) - R(T(1.5)));
}
// Rows y - 8 to y + 8 with a strong pixel in each group of 8 columns, kept up to date from row to row.
inline constexpr int kMostGroups = 16384 / 8;
struct StrongRows {
    const DlaaArgs& a;
    int groups;
    uint8_t count[kMostGroups];
    AA_INLINE const uint8_t* row(int y) const {
        return a.strong + long(y < 0 ? 0 : y < a.height ? y : a.height - 1) * groups;
    }
    AA_INLINE void add(int y, int sign) {
        const uint8_t* const r = row(y);
        for (int g = 0; g < groups; g++) count[g] = uint8_t(count[g] + (r[g] ? sign : 0));
    }
    // Can a long edge cross this group? Groups at the border are not told apart.
    AA_INLINE bool maybe_long(int y, int g) const {
        if (g == 0 || g + 2 >= groups) return true;
        const uint8_t* const r = row(y);
        const int beside = __builtin_popcount(unsigned(r[g - 1]) | unsigned(r[g]) << 8 | unsigned(r[g + 1]) << 16);
        return beside >= kDlaaFewestStrong || count[g] - (r[g] ? 1 : 0) >= kDlaaFewestStrong;
    }
};
template <class R>
AA_INLINE void filter_pixels(const DlaaArgs& a, long o, bool maybeLong) {
    using T = Elem<R>;
    const R sixth(T(1.0 / 6)), zero(T(0)), one(T(1)), two(T(2));
    const vec3<R> centre = colour_at<R>(a.in, o);
    const vec3<R> wideH = wide_difference(a, o, 1, centre), wideV = wide_difference(a, o, a.stride, centre);
    const R strengthH = short_strength(a, wideH), strengthV = short_strength(a, wideV);
    vec3<R> c = centre;
    R maskH = zero, maskV = zero;
    if (mask_bits<R>(either(strengthH > zero, strengthV > zero))) {
        const vec3<R> blurH = centre + wideH * sixth, blurV = centre + wideV * sixth;
        maskH = short_mask(strengthH, blurV), maskV = short_mask(strengthV, blurH);
        c = mix(centre, blurH, maskV);
        c = mix(c, blurV, maskH * R(T(0.5)));  // half: the two passes would over-blur
    }
    R onlyLong = zero;
    if (maybeLong) {
        const R longH = saturate(mean_of_16<R>(a.edge + o, 1) * two - one);
        const R longV = saturate(mean_of_16<R>(a.edge + o, a.stride) * two - one);
        const auto dominant = abs(longH - longV) > R(T(a.longThreshold));
        if (mask_bits<R>(dominant))
            c = long_edges(a, o, centre, c, select(dominant, longH, zero), select(dominant, longV, zero));
        onlyLong = select(dominant, longH - longV, zero);
    }
    if (a.preserveHighlights) c = mix(c, centre, highlight_mask<R>(a, o));
    store(c.x, a.out.c[0] + o);
    store(c.y, a.out.c[1] + o);
    store(c.z, a.out.c[2] + o);
    if (a.shortMask) {
        store(maskH - maskV, a.shortMask + o);
        store(onlyLong, a.longMask + o);
    }
}
template <class R>
__attribute__((flatten)) void filterRows(const DlaaArgs& a, int y0, int y1) {
    StrongRows strong{a, (a.width + 7) / 8, {}};
    for (int y = y0 - 8; y <= y0 + 8; y++) strong.add(y, 1);
    for (int y = y0; y < y1; y++) {
        for (int x = 0; x < a.width; x += 8) {
            const bool maybeLong = strong.maybe_long(y, x >> 3);
            for (int i = 0; i < 8; i += N<R>) filter_pixels<R>(a, long(y) * a.stride + x + i, maybeLong);
        }
        strong.add(y + 9, 1);
        strong.add(y - 8, -1);
    }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::DlaaKernels, dlaaKernels) = {AA_ROWS(edgeRows), AA_ROWS(filterRows)};
