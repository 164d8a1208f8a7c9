#include "kernels/lanes.h"
#include "metrics/metrics_kernels.h"

namespace AA_ARCH {
using namespace aa;

// Adds the first `count` lanes to the strands of their x; x is a multiple of N<R>.
template <class R>
AA_INLINE void add_to_strands(R value, int x, int count, double* strands) {
    double* at = strands + x % kSumStrands;
    if constexpr (N<R> == 1)
        *at += double(value);
    else if (count >= N<R>)
        for (int i = 0; i < N<R>; i++) at[i] += double(value.v[i]);
    else
        for (int i = 0; i < count; i++) at[i] += double(value.v[i]);
}
AA_INLINE double sum_of_strands(const double* s) {
    return ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
}

template <class R>
__attribute__((flatten)) void squaredErrorRows(const SquaredErrorArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++) {
        double reference[kSumStrands] = {};
        for (int tile = 0; tile < a.tilesX; tile++) {
            double error[kSumStrands] = {};
            const int begin = tile * kErrorTilePx, tileEnd = begin + kErrorTilePx,
                      end = tileEnd < a.width ? tileEnd : a.width;
            for (int c = 0; c < 3; c++)
                for (int x = begin; x < end; x += N<R>) {
                    const long o = long(y) * a.stride + x;
                    const R r = load<R>(a.reference.c[c] + o), d = load<R>(a.test.c[c] + o) - r;
                    add_to_strands(d * d, x, end - x, error);
                    add_to_strands(r * r, x, end - x, reference);
                }
            a.tileRows[long(y) * a.tilesX + tile] = sum_of_strands(error);
        }
        a.referenceRows[y] = sum_of_strands(reference);
    }
}

template <class R>
__attribute__((flatten)) void relativeErrorRows(const RelativeErrorArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++) {
        double error[kSumStrands] = {};
        for (int c = 0; c < 3; c++)
            for (int x = 0; x < a.width; x += N<R>) {
                const long o = long(y) * a.stride + x;
                const R r = load<R>(a.reference.c[c] + o), d = load<R>(a.test.c[c] + o) - r;
                // 0.01: the floor that keeps black from dividing by zero, methods/07 s.8
                add_to_strands(d * d / (r * r + R(Elem<R>(0.01))), x, a.width - x, error);
            }
        a.rows[y] = sum_of_strands(error);
    }
}

// ---- SSIM, Wang et al. 2004 ----
//
// Works on the sum s = x + y and the difference d = x - y of the two images:
//   2 mu_x mu_y = (mu_s^2 - mu_d^2) / 2      mu_x^2 + mu_y^2       = (mu_s^2 + mu_d^2) / 2
//   2 sigma_xy  = (var_s - var_d) / 2        sigma_x^2 + sigma_y^2 = (var_s + var_d) / 2
// so that two variances are enough and identical images (d = 0) give exactly 1. A variance is gathered first along x
// about the row's own mean and then along y about the mean of those means; all its terms are >= 0 and none cancel:
//   var = sum_j w_j (var_j + (mean_j - mean)^2).

constexpr int kTaps = 11, kReach = 5;
constexpr int kStrip = 64;               // columns at a time: the ring of rows stays in the first-level cache
constexpr int kPadded = kStrip + 2 * 8;  // a strip and its neighbourhood, a whole number of lanes
// exp(-i^2 / (2 1.5^2)) / sum, i = 0..5 (methods/07 s.2; here to double precision)
constexpr double kGauss[kReach + 1] = {0.2660117248617943,  0.21300553771125366,  0.1093606895097,
                                       0.03600077212843082, 0.007598758135239184, 0.0010283800844791099};
constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;  // (K1 L)^2, (K2 L)^2, L = 1

template <class R>
struct Moments {
    R mean, variance;
};
// Storage of one strip of moments, of s and of d.
template <class T>
struct alignas(64) MomentRow {
    T mean[2][kStrip], variance[2][kStrip];
};
template <class R>
AA_INLINE R load_own(const Elem<R>* p) {  // storage in the arithmetic's own precision
    if constexpr (N<R> == 1)
        return *p;
    else
        return typename R::V(*(const typename R::Vu*)p);
}
template <class R>
AA_INLINE R weight(int i) {
    return R(Elem<R>(kGauss[i]));
}
// The window's mean and variance along x about p[0], p spans -5..5.
template <class R>
AA_INLINE Moments<R> moments_along_x(const Elem<R>* p) {
    R lo[kReach], hi[kReach];
    const R centre = load_own<R>(p);
    for (int i = 0; i < kReach; i++) lo[i] = load_own<R>(p - 1 - i), hi[i] = load_own<R>(p + 1 + i);
    R mean = centre * weight<R>(0);
    for (int i = 0; i < kReach; i++) mean = mean + (lo[i] + hi[i]) * weight<R>(i + 1);
    const R e = centre - mean;
    R variance = e * e * weight<R>(0);
    for (int i = 0; i < kReach; i++) {
        const R a = lo[i] - mean, b = hi[i] - mean;
        variance = variance + (a * a + b * b) * weight<R>(i + 1);
    }
    return {mean, variance};
}
template <class R, class T>
AA_INLINE Moments<R> moments_along_y(const MomentRow<T>* const* rows, int signal, int x) {
    R m[kTaps];
    for (int j = 0; j < kTaps; j++) m[j] = load_own<R>(rows[j]->mean[signal] + x);
    R mean = m[kReach] * weight<R>(0);
    for (int j = 1; j <= kReach; j++) mean = mean + (m[kReach - j] + m[kReach + j]) * weight<R>(j);
    const auto part = [&](int j) __attribute__((always_inline)) {
        const R e = m[j] - mean;
        return load_own<R>(rows[j]->variance[signal] + x) + e * e;
    };
    R variance = part(kReach) * weight<R>(0);
    for (int j = 1; j <= kReach; j++) variance = variance + (part(kReach - j) + part(kReach + j)) * weight<R>(j);
    return {mean, variance};
}

// s and d of row y, columns [x0 - 8, x0 + kStrip + 8), coordinates clamped to the image.
template <class R>
AA_INLINE void load_row(const SsimArgs& a, int signal, int x0, int y, Elem<R>* s, Elem<R>* d) {
    const long row = long(y < 0 ? 0 : y >= a.height ? a.height - 1 : y) * a.stride;
    const auto pixel = [&]<class Q>(const RgbIn& image, long o, Q) __attribute__((always_inline)) {
        if (signal < 3) return load<Q>(image.c[signal] + o);
        return luma601(vec3<Q>(load<Q>(image.c[0] + o), load<Q>(image.c[1] + o), load<Q>(image.c[2] + o)));
    };
    const int first = x0 - 8;
    if (first >= 0 && first + kPadded <= a.width) {
        for (int i = 0; i < kPadded; i += N<R>) {
            const R t = pixel(a.test, row + first + i, R{}), r = pixel(a.reference, row + first + i, R{});
            store(t + r, s + i), store(t - r, d + i);
        }
        return;
    }
    for (int i = 0; i < kPadded; i++) {
        using T = Elem<R>;
        const int x = first + i < 0 ? 0 : first + i >= a.width ? a.width - 1 : first + i;
        const T t = pixel(a.test, row + x, T{}), r = pixel(a.reference, row + x, T{});
        s[i] = t + r, d[i] = t - r;
    }
}
template <class R>
AA_INLINE R ssim_of(Moments<R> s, Moments<R> d) {
    using T = Elem<R>;
    const R half(T(0.5)), c1{T(kC1)}, c2{T(kC2)};
    const R s2 = s.mean * s.mean, d2 = d.mean * d.mean;
    return (((s2 - d2) * half + c1) * ((s.variance - d.variance) * half + c2)) /
           (((s2 + d2) * half + c1) * ((s.variance + d.variance) * half + c2));
}
// The third axis of a volume of three channels: tap o of channel c falls on channel clamp(c + o, 0, 2).
template <class R>
AA_INLINE Moments<R> moments_across_channels(const Moments<R>* m, int channel) {
    double w[3] = {};
    for (int o = -kReach; o <= kReach; o++) {
        const int k = channel + o < 0 ? 0 : channel + o > 2 ? 2 : channel + o;
        w[k] += kGauss[o < 0 ? -o : o];
    }
    const R w0{Elem<R>(w[0])}, w1{Elem<R>(w[1])}, w2{Elem<R>(w[2])};
    const R mean = m[0].mean * w0 + m[1].mean * w1 + m[2].mean * w2;
    const R e0 = m[0].mean - mean, e1 = m[1].mean - mean, e2 = m[2].mean - mean;
    return {mean, (m[0].variance + e0 * e0) * w0 + (m[1].variance + e1 * e1) * w1 + (m[2].variance + e2 * e2) * w2};
}
template <class R, int Signals>
AA_INLINE void ssim_strip(const SsimArgs& a, int x0, int y0, int y1) {
    using T = Elem<R>;
    MomentRow<T> ring[Signals][kTaps];
    alignas(64) T s[kPadded], d[kPadded];
    const int columns = a.width - x0 < kStrip ? a.width - x0 : kStrip;
    for (int y = y0 - kReach; y < y1 + kReach; y++) {
        const int slot = (y - y0 + kReach) % kTaps;
        for (int k = 0; k < Signals; k++) {
            load_row<R>(a, Signals == 1 ? 3 : k, x0, y, s, d);
            MomentRow<T>& row = ring[k][slot];
            for (int x = 0; x < columns; x += N<R>) {
                const Moments<R> ms = moments_along_x<R>(s + 8 + x), md = moments_along_x<R>(d + 8 + x);
                store(ms.mean, row.mean[0] + x), store(ms.variance, row.variance[0] + x);
                store(md.mean, row.mean[1] + x), store(md.variance, row.variance[1] + x);
            }
        }
        const int centre = y - kReach;
        if (centre < y0) continue;
        const MomentRow<T>* rows[Signals][kTaps];
        for (int k = 0; k < Signals; k++)
            for (int j = 0; j < kTaps; j++) rows[k][j] = &ring[k][(slot + 1 + j) % kTaps];
        for (int x = 0; x < columns; x += N<R>) {
            Moments<R> ms[Signals], md[Signals];
            for (int k = 0; k < Signals; k++) {
                ms[k] = moments_along_y<R>(rows[k], 0, x);
                md[k] = moments_along_y<R>(rows[k], 1, x);
            }
            R value;
            if constexpr (Signals == 1)
                value = ssim_of(ms[0], md[0]);
            else {
                R sum(T(0));
                for (int k = 0; k < 3; k++)
                    sum = sum + (a.signal == SsimSignal::volume
                                     ? ssim_of(moments_across_channels(ms, k), moments_across_channels(md, k))
                                     : ssim_of(ms[k], md[k]));
                value = sum / R(T(3));
            }
            add_to_strands(value, x, columns - x, a.rows + long(centre) * kSumStrands);
            if (a.map) {
                float* out = a.map + long(centre) * a.mapStride + x0 + x;
                store(value, out);
            }
        }
    }
}
template <class R>
__attribute__((flatten)) void ssimRows(const SsimArgs& a, int y0, int y1) {
    for (int x0 = 0; x0 < a.width; x0 += kStrip) {
        if (a.signal == SsimSignal::luma)
            ssim_strip<R, 1>(a, x0, y0, y1);
        else
            ssim_strip<R, 3>(a, x0, y0, y1);
    }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::MetricsKernels, metricsKernels) = {AA_ROWS(squaredErrorRows), AA_ROWS(relativeErrorRows),
                                                       AA_ROWS(ssimRows)};
