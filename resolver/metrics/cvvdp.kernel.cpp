#include "kernels/math.h"
#include "kernels/srgb.h"
#include "metrics/cvvdp_kernels.h"
#include "metrics/strip.h"

namespace AA_ARCH {
using namespace aa;
using namespace aa::cvvdp_constants;

constexpr int kStrip = 256;  // columns of a pass that needs its neighbours along x
constexpr int kMargin = 16;  // computed beside a strip: kBlurReach rounded up to whole pairs of lanes
constexpr int kSpan = kStrip + 2 * kMargin;

template <class R>
AA_INLINE R constant(double v) {
    return R(Elem<R>(v));
}
// Values 0, 2, 4, ... and 1, 3, 5, ... of two successive groups, and back.
template <class R>
AA_INLINE void splitPairs(R a, R b, R& even, R& odd) {
    if constexpr (N<R> == 1)
        even = a, odd = b;
    else
        for (int i = 0; i < N<R> / 2; i++) {
            even.v[i] = a.v[2 * i], odd.v[i] = a.v[2 * i + 1];
            even.v[N<R> / 2 + i] = b.v[2 * i], odd.v[N<R> / 2 + i] = b.v[2 * i + 1];
        }
}
template <class R>
AA_INLINE void joinPairs(R even, R odd, R& a, R& b) {
    if constexpr (N<R> == 1)
        a = even, b = odd;
    else
        for (int i = 0; i < N<R> / 2; i++) {
            a.v[2 * i] = even.v[i], a.v[2 * i + 1] = odd.v[i];
            b.v[2 * i] = even.v[N<R> / 2 + i], b.v[2 * i + 1] = odd.v[N<R> / 2 + i];
        }
}

// ---- light and time ----
template <class R>
__attribute__((flatten)) void lightRows(const CvvdpLightArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            R light[3];
            for (int c = 0; c < 3; c++) {
                const R value = max(constant<R>(0), load<R>(a.picture.c[c] + long(y) * a.stride + x));  // NaN: 0
                const R linear = a.isLinear ? value : srgbDecode(min(value, constant<R>(1)));
                light[c] = clamp(linear * constant<R>(a.gain), constant<R>(a.least), constant<R>(a.most)) +
                           constant<R>(a.background);
            }
            for (int c = 0; c < 3; c++)
                store(light[0] * constant<R>(a.toOpponent[c][0]) + light[1] * constant<R>(a.toOpponent[c][1]) +
                          light[2] * constant<R>(a.toOpponent[c][2]),
                      a.opponent.c[c] + long(y) * a.opponentStride + x);
        }
}
// Four groups of lanes at a time: the addresses and weights of many frames cost as much as the sums. A row has room for
// what that writes beyond its end.
template <class R>
__attribute__((flatten)) void filterRows(const CvvdpFilterArgs& a, int y0, int y1) {
    constexpr int kGroups = 32 / N<R> < 4 ? 32 / N<R> : 4;
    const int middle = a.taps / 2;
    for (int y = y0; y < y1; y++)
        for (int c = 0; c < 3; c++) {
            const double *sustained = a.weights + c * (middle + 1), *transient = a.weights + 3 * (middle + 1);
            const bool both = c == 0 && a.channels == kChannels;
            for (int x = 0; x < a.width; x += kGroups * N<R>) {
                const long at = long(y) * a.stride + x;
                R sum[kGroups], sumTransient[kGroups];
                for (int g = 0; g < kGroups; g++) {
                    const R own = load<R>(a.frames[3 * middle + c] + at + g * N<R>);
                    sum[g] = own * constant<R>(sustained[0]), sumTransient[g] = own * constant<R>(transient[0]);
                }
                for (int i = 1; i <= middle; i++) {
                    const float *before = a.frames[3 * (middle - i) + c] + at,
                                *after = a.frames[3 * (middle + i) + c] + at;
                    for (int g = 0; g < kGroups; g++) {
                        const R pair = load<R>(before + g * N<R>) + load<R>(after + g * N<R>);
                        sum[g] = sum[g] + pair * constant<R>(sustained[i]);
                        if (both) sumTransient[g] = sumTransient[g] + pair * constant<R>(transient[i]);
                    }
                }
                for (int g = 0; g < kGroups; g++) {
                    store(sum[g], a.out.c[c] + at + g * N<R>);
                    if (both) store(sumTransient[g], a.out.c[3] + at + g * N<R>);
                }
            }
        }
}

// ---- pyramid ----
constexpr double kOuter = 0.05, kInner = 0.25, kCentre = 0.4;  // [Burt 1983] with a = 0.4

// The reference program continues a row as the parity of the *height* asks: along y rows are mirrored about the edge;
// along x they are where both parities agree. Otherwise its last column has other weights, which viewers' answers were
// fitted with; the values here beyond the last column give the same sums.
template <class T>
AA_INLINE void continueRow(T* even, T* odd, int width, int height, int x0, int count) {
    if (x0 == 0) even[-1] = odd[0], odd[-1] = even[0];
    const int half = width / 2 - x0;  // of column `width` when it is even, of the last one when it is odd
    if (half > count) return;         // not of this strip
    const bool oddHeight = height % 2;
    if (width % 2 == 0) {
        even[half] = oddHeight ? odd[half - 1] * T(kInner / kOuter) + even[half - 1] : odd[half - 1];
    } else {
        const T last = even[half], before = odd[half - 1];
        odd[half] = oddHeight ? last : T(0);
        if (half + 1 <= count) even[half + 1] = oddHeight ? before : last;
    }
}
template <class R>
__attribute__((flatten)) void reduceRows(const CvvdpReduceArgs& a, int y0, int y1) {
    using T = Elem<R>;
    alignas(64) T evenRow[kSpan], oddRow[kSpan];
    T *const even = evenRow + kMargin, *const odd = oddRow + kMargin;
    for (int y = y0; y < y1; y++)
        for (int c = 0; c < a.channels; c++)
            for (int x0 = 0; x0 < a.outWidth; x0 += kStrip) {
                const float* rows[5];
                for (int i = 0; i < 5; i++) {
                    int r = 2 * y + i - 2;
                    r = r < 0 ? -1 - r : r >= a.inHeight ? 2 * a.inHeight - 1 - r : r;
                    rows[i] = a.in.c[c] + long(r) * a.inStride;
                }
                const auto alongY = [&](int x) __attribute__((always_inline)) {
                    return (load<R>(rows[0] + x) + load<R>(rows[4] + x)) * constant<R>(kOuter) +
                           (load<R>(rows[1] + x) + load<R>(rows[3] + x)) * constant<R>(kInner) +
                           load<R>(rows[2] + x) * constant<R>(kCentre);
                };
                const int columns = a.outWidth - x0 < kStrip ? a.outWidth - x0 : kStrip;
                for (int i = x0 == 0 ? 0 : -N<R>; i < columns + 1; i += N<R>) {
                    R e, o;
                    splitPairs(alongY(2 * (x0 + i)), alongY(2 * (x0 + i) + N<R>), e, o);
                    store(e, even + i), store(o, odd + i);
                }
                continueRow(even, odd, a.inWidth, a.inHeight, x0, columns);
                float* const out = a.out.c[c] + long(y) * a.outStride + x0;
                for (int i = 0; i < columns; i += N<R>)
                    store((loadOwn<R>(even + i - 1) + loadOwn<R>(even + i + 1)) * constant<R>(kOuter) +
                              (loadOwn<R>(odd + i - 1) + loadOwn<R>(odd + i)) * constant<R>(kInner) +
                              loadOwn<R>(even + i) * constant<R>(kCentre),
                          out + i);
            }
}
// Row y of the smaller level at twice its size, columns [x0, x0 + count) with x0 even; its border repeats its edge.
template <class R>
AA_INLINE void expandRow(const float* smaller, int stride, int y, int x0, int count, Elem<R>* out) {
    using T = Elem<R>;
    alignas(64) T columnsOfSmaller[kSpan / 2 + 4 * 16];
    T* const v = columnsOfSmaller + 16;
    const float* const row = smaller + long(y / 2) * stride + x0 / 2;
    const int half = (count + 1) / 2;
    for (int i = -N<R>; i < half + 1; i += N<R>)
        store(y % 2 ? (load<R>(row + i) + load<R>(row + stride + i)) * constant<R>(2 * kInner)
                    : (load<R>(row - stride + i) + load<R>(row + stride + i)) * constant<R>(2 * kOuter) +
                          load<R>(row + i) * constant<R>(2 * kCentre),
              v + i);
    for (int i = 0; i < half; i += N<R>) {
        const R own = loadOwn<R>(v + i), next = loadOwn<R>(v + i + 1);
        R a, b;
        joinPairs((loadOwn<R>(v + i - 1) + next) * constant<R>(2 * kOuter) + own * constant<R>(2 * kCentre),
                  (own + next) * constant<R>(2 * kInner), a, b);
        store(a, out + 2 * i), store(b, out + 2 * i + N<R>);
    }
}

// ---- contrast ----
// One row of a band in a strip with its margins, column 0 of which is `x0`.
template <class R>
struct BandRow {
    using T = Elem<R>;
    alignas(64) T expanded[kChannels][kSpan + 2 * N<R>], inverse[kSpan + 2 * N<R>];
    AA_INLINE void load(const CvvdpBand& b, int y, int x0, int count) {
        for (int c = 0; c < b.channels; c++) expandRow<R>(b.smaller.c[c], b.smallerStride, y, x0, count, expanded[c]);
        for (int i = 0; i < count; i += N<R>) store(constant<R>(1) / background(i), inverse + i);
    }
    AA_INLINE R background(int i) const { return max(constant<R>(kLeastBackground), loadOwn<R>(expanded[0] + i)); }
    AA_INLINE R contrast(const CvvdpBand& b, int c, int y, int x0, int i) const {
        const R own = ::AA_ARCH::load<R>(b.level.c[c] + long(y) * b.stride + x0 + i);
        return min((own - loadOwn<R>(expanded[c] + i)) * loadOwn<R>(inverse + i), constant<R>(kMostContrast));
    }
};
template <class R>
__attribute__((flatten)) void sensitivityRows(const CvvdpSensitivityArgs& a, int y0, int y1) {
    BandRow<R> row;
    for (int y = y0; y < y1; y++)
        for (int x0 = 0; x0 < a.band.width; x0 += kStrip) {
            const int columns = a.band.width - x0 < kStrip ? a.band.width - x0 : kStrip;
            row.load(a.band, y, x0, columns);
            for (int i = 0; i < columns; i += N<R>) {
                const R place = clamp(
                    (log2Positive(row.background(i)) + constant<R>(-kCsfFirstLog2)) * constant<R>(kCsfStepsPerLog2),
                    constant<R>(0), constant<R>(kCsfSize - 1));
                const R whole = floor(place), share = place - whole;
                int index[N<R>];
                toInts(whole, index);
                const long at = long(y) * a.band.stride + x0 + i;
                for (int c = 0; c < a.band.channels; c++) {
                    const float* const table = a.log2Sensitivity + c * (kCsfSize + 1);
                    float below[N<R>], above[N<R>];
                    for (int k = 0; k < N<R>; k++) below[k] = table[index[k]], above[k] = table[index[k] + 1];
                    const R sensitivity =
                        exp2Clamped(mix(load<R>(below), load<R>(above), share)) * constant<R>(kGain[c] * a.bandGain);
                    store(sensitivity, a.sensitivity.c[c] + at);
                    store(row.contrast(a.band, c, y, x0, i) * sensitivity, a.response.c[c] + at);
                }
            }
        }
}

// ---- masking ----
template <class R, class Load>
AA_INLINE R blurred(const Load& at) {
    R sum = at(0) * constant<R>(kBlur[0]);
    for (int i = 1; i <= kBlurReach; i++) sum = sum + (at(-i) + at(i)) * constant<R>(kBlur[i]);
    return sum;
}
template <class R>
__attribute__((flatten)) void responseRows(const CvvdpResponseArgs& a, int y0, int y1) {
    using T = Elem<R>;
    const CvvdpBand& b = a.band;
    BandRow<R> row;
    alignas(64) T lesser[kSpan + 2 * N<R>];
    for (int y = y0; y < y1; y++)
        for (int x0 = 0; x0 < b.width; x0 += kStrip) {
            const int first = x0 == 0 ? 0 : x0 - kMargin;  // columns [first, end) are computed
            const int end = x0 + kStrip + kMargin < b.width ? x0 + kStrip + kMargin : b.width;
            const int stop = x0 + kStrip < b.width ? x0 + kStrip : b.width;
            row.load(b, y, first, end - first);
            for (int c = 0; c < b.channels; c++) {
                T* const mutual = lesser + kMargin;  // of column x0
                for (int x = first; x < end; x += N<R>) {
                    const long at = long(y) * b.stride + x;
                    const R test = row.contrast(b, c, y, first, x - first) * load<R>(a.sensitivity.c[c] + at);
                    const R reference = load<R>(a.reference.c[c] + at);
                    store(min(abs(test), abs(reference)), mutual + (x - x0));
                    if (x >= x0 && x < stop) store(abs(test - reference), a.difference.c[c] + at);
                }
                float* const out = a.mutual.c[c] + long(y) * b.stride;
                if (!a.blurred) {
                    for (int x = x0; x < stop; x += N<R>) store(loadOwn<R>(mutual + (x - x0)), out + x);
                    continue;
                }
                for (int i = 1; i <= kBlurReach; i++) {  // mirrored about the middle of the first and last pixel
                    if (x0 == 0) mutual[-i] = mutual[i];
                    if (end == b.width) mutual[b.width - 1 + i - x0] = mutual[b.width - 1 - i - x0];
                }
                for (int x = x0; x < stop; x += N<R>)
                    store(blurred<R>([&](int i)
                                         __attribute__((always_inline)) { return loadOwn<R>(mutual + (x - x0 + i)); }),
                          out + x);
            }
        }
}
// (x + e)^p - e^p
template <class R>
AA_INLINE R power(R x, double p, double powerOfEpsilon) {
    return powPositive(x + constant<R>(kEpsilon), constant<R>(p)) - constant<R>(powerOfEpsilon);
}
template <class R>
__attribute__((flatten)) void maskRows(const CvvdpMaskArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++) {
        const auto mirrored = [&](int r) __attribute__((always_inline)) {
            return long(r < 0 ? -r : r >= a.height ? 2 * a.height - 2 - r : r) * a.stride;
        };
        long rows[2 * kBlurReach + 1];
        for (int i = -kBlurReach; i <= kBlurReach; i++) rows[i + kBlurReach] = a.blurred ? mirrored(y + i) : 0;
        Strands<R> sums[kChannels];
        for (int x = 0; x < a.width; x += N<R>) {
            const long at = long(y) * a.stride + x;
            R mutual[kChannels];
            for (int c = 0; c < a.channels; c++) {
                const R both = a.blurred ? blurred<R>([&](int i) __attribute__((always_inline)) {
                    return load<R>(a.mutual.c[c] + rows[i + kBlurReach] + x);
                })
                                         : load<R>(a.mutual.c[c] + at);
                mutual[c] = power(both * constant<R>(kMaskGain), kMaskQ[c], kEpsilonQ[c]);
            }
            R pooled = constant<R>(0);
            for (int c = 0; c < a.channels; c++) {
                R mask = constant<R>(1);
                for (int k = 0; k < a.channels; k++) mask = mask + mutual[k] * constant<R>(a.crossMasking[k][c]);
                const R raw = power(load<R>(a.difference.c[c] + at), kMaskP, kEpsilonP) / mask;
                const R masked = constant<R>(kMostDifference) * raw / (constant<R>(kMostDifference) + raw);
                const R shifted = masked + constant<R>(kEpsilon);
                sums[c].add(shifted * shifted - constant<R>(kEpsilon * kEpsilon), x, a.width - x);
                const R weighted = masked * constant<R>(a.weights[c]) + constant<R>(kEpsilon);
                pooled = pooled + (weighted * weighted) * (weighted * weighted);
            }
            if (a.map)  // to the fourth root, with the same shifts
                store(sqrt(sqrt(pooled + constant<R>(kEpsilon))) - constant<R>(kEpsilonFourthRoot), a.map + at);
        }
        for (int c = 0; c < a.channels; c++) sums[c].addTo(a.rows + (long(c) * a.height + y) * kSumStrands);
    }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::CvvdpKernels, cvvdpKernels) = {AA_ROWS(lightRows),       AA_ROWS(filterRows),   AA_ROWS(reduceRows),
                                                   AA_ROWS(sensitivityRows), AA_ROWS(responseRows), AA_ROWS(maskRows)};
