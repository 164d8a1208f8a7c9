#include "kernels/hash.h"
#include "kernels/lanes.h"
#include "metrics/metrics_kernels.h"
#include "metrics/strip.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
__attribute__((flatten)) void squaredErrorRows(const SquaredErrorArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++) {
        Strands<R> reference;
        for (int tile = 0; tile < a.tilesX; tile++) {
            Strands<R> error;
            const int begin = tile * kErrorTilePx, tileEnd = begin + kErrorTilePx,
                      end = tileEnd < a.width ? tileEnd : a.width;
            for (int c = 0; c < 3; c++)
                for (int x = begin; x < end; x += N<R>) {
                    const long o = long(y) * a.stride + x;
                    const R r = load<R>(a.reference.c[c] + o), d = load<R>(a.test.c[c] + o) - r;
                    error.add(d * d, x, end - x);
                    reference.add(r * r, x, end - x);
                }
            a.tileRows[long(y) * a.tilesX + tile] = error.total();
        }
        a.referenceRows[y] = reference.total();
    }
}

template <class R>
__attribute__((flatten)) void relativeErrorRows(const RelativeErrorArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++) {
        Strands<R> error;
        for (int c = 0; c < 3; c++)
            for (int x = 0; x < a.width; x += N<R>) {
                const long o = long(y) * a.stride + x;
                const R r = load<R>(a.reference.c[c] + o), d = load<R>(a.test.c[c] + o) - r;
                // 0.01: the floor that keeps black from dividing by zero, conventions 13.8
                error.add(d * d / (r * r + R(Elem<R>(0.01))), x, a.width - x);
            }
        a.rows[y] = error.total();
    }
}

// ---- SSIM [Wang 2004] ----
//
// Works on the sum s = x + y and the difference d = x - y of the two images:
//   2 mu_x mu_y = (mu_s^2 - mu_d^2) / 2      mu_x^2 + mu_y^2       = (mu_s^2 + mu_d^2) / 2
//   2 sigma_xy  = (var_s - var_d) / 2        sigma_x^2 + sigma_y^2 = (var_s + var_d) / 2
// so that two variances are enough and identical images (d = 0) give exactly 1. A variance is gathered first along x
// about the row's own mean and then along y about the mean of those means; all its terms are >= 0 and none cancel:
//   var = sum_j w_j (var_j + (mean_j - mean)^2).

constexpr int kTaps = 11, kReach = 5;
constexpr int kStrip = 64;               // columns; twice as many are slower here
constexpr int kPadded = kStrip + 2 * 8;  // a strip and its neighbourhood, a whole number of lanes
// exp(-i^2 / (2 1.5^2)) / sum, i = 0..5 (conventions 13.2; here to double precision)
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
AA_INLINE R weight(int i) {
    return R(Elem<R>(kGauss[i]));
}
// The window's mean and variance along x about p[0], p spans -5..5.
template <class R>
AA_INLINE Moments<R> momentsAlongX(const Elem<R>* p) {
    R lo[kReach], hi[kReach];
    const R centre = loadOwn<R>(p);
    for (int i = 0; i < kReach; i++) lo[i] = loadOwn<R>(p - 1 - i), hi[i] = loadOwn<R>(p + 1 + i);
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
// `rows` are the window's 11 rows in order.
template <class R, class T>
AA_INLINE Moments<R> momentsAlongY(const MomentRow<T>* rows, int signal, int x) {
    R m[kTaps];
    for (int j = 0; j < kTaps; j++) m[j] = loadOwn<R>(rows[j].mean[signal] + x);
    R mean = m[kReach] * weight<R>(0);
    for (int j = 1; j <= kReach; j++) mean = mean + (m[kReach - j] + m[kReach + j]) * weight<R>(j);
    const auto part = [&](int j) __attribute__((always_inline)) {
        const R e = m[j] - mean;
        return loadOwn<R>(rows[j].variance[signal] + x) + e * e;
    };
    R variance = part(kReach) * weight<R>(0);
    for (int j = 1; j <= kReach; j++) variance = variance + (part(kReach - j) + part(kReach + j)) * weight<R>(j);
    return {mean, variance};
}

AA_INLINE void prefetchRow(const SsimArgs& a, int signal, int y, int first) {
    if (y < 0 || y >= a.height) return;
    for (int c = 0; c < 3; c++) {
        if (signal < 3 && c != signal) continue;
        const long o = long(y) * a.stride + first;
        prefetch(a.test.c[c] + o, kPadded);
        prefetch(a.reference.c[c] + o, kPadded);
    }
}
// s and d of row y, columns [x0 - 8, x0 + kStrip + 8), coordinates clamped to the image.
template <class R>
AA_INLINE void loadRow(const SsimArgs& a, int signal, int x0, int y, Elem<R>* s, Elem<R>* d) {
    const long row = long(y < 0 ? 0 : y >= a.height ? a.height - 1 : y) * a.stride;
    const auto pixel = [&]<class Q>(const RgbIn& image, long o, Q) __attribute__((always_inline)) {
        if (signal < 3) return load<Q>(image.c[signal] + o);
        return luma601(vec3<Q>(load<Q>(image.c[0] + o), load<Q>(image.c[1] + o), load<Q>(image.c[2] + o)));
    };
    const int first = x0 - 8;
    if (first >= 0 && first + kPadded <= a.width) {
        prefetchRow(a, signal, y + kRowsAhead, first);
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
AA_INLINE R ssimOf(Moments<R> s, Moments<R> d) {
    using T = Elem<R>;
    const R half(T(0.5)), c1{T(kC1)}, c2{T(kC2)};
    const R s2 = s.mean * s.mean, d2 = d.mean * d.mean;
    return (((s2 - d2) * half + c1) * ((s.variance - d.variance) * half + c2)) /
           (((s2 + d2) * half + c1) * ((s.variance + d.variance) * half + c2));
}
// The third axis of a volume of three channels: tap o of channel c falls on channel clamp(c + o, 0, 2).
template <class R>
AA_INLINE Moments<R> momentsAcrossChannels(const Moments<R>* m, int channel) {
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
AA_INLINE void ssimStrip(const SsimArgs& a, int x0, int y0, int y1) {
    using T = Elem<R>;
    // Every row is stored twice, kTaps apart, so that any 11 successive rows lie one after the other.
    MomentRow<T> ring[Signals][2 * kTaps];
    alignas(64) T s[kPadded], d[kPadded];
    const int columns = a.width - x0 < kStrip ? a.width - x0 : kStrip;
    for (int y = y0 - kReach; y < y1 + kReach; y++) {
        const int slot = (y - y0 + kReach) % kTaps;
        for (int k = 0; k < Signals; k++) {
            loadRow<R>(a, Signals == 1 ? int(a.signal) : k, x0, y, s, d);
            MomentRow<T>&row = ring[k][slot], &again = ring[k][slot + kTaps];
            for (int signal = 0; signal < 2; signal++)
                for (int x = 0; x < columns; x += N<R>) {
                    const Moments<R> m = momentsAlongX<R>((signal ? d : s) + 8 + x);
                    store(m.mean, row.mean[signal] + x), store(m.variance, row.variance[signal] + x);
                    store(m.mean, again.mean[signal] + x), store(m.variance, again.variance[signal] + x);
                }
        }
        const int centre = y - kReach;
        if (centre < y0) continue;
        MomentRow<T> window[Signals];
        for (int k = 0; k < Signals; k++)
            for (int signal = 0; signal < 2; signal++)
                for (int x = 0; x < columns; x += N<R>) {
                    const Moments<R> m = momentsAlongY<R>(&ring[k][slot + 1], signal, x);
                    store(m.mean, window[k].mean[signal] + x), store(m.variance, window[k].variance[signal] + x);
                }
        Strands<R> sum;
        for (int x = 0; x < columns; x += N<R>) {
            Moments<R> ms[Signals], md[Signals];
            for (int k = 0; k < Signals; k++) {
                ms[k] = {loadOwn<R>(window[k].mean[0] + x), loadOwn<R>(window[k].variance[0] + x)};
                md[k] = {loadOwn<R>(window[k].mean[1] + x), loadOwn<R>(window[k].variance[1] + x)};
            }
            R value;
            if constexpr (Signals == 1)
                value = ssimOf(ms[0], md[0]);
            else {
                R sum(T(0));
                for (int k = 0; k < 3; k++)
                    sum = sum + ssimOf(momentsAcrossChannels(ms, k), momentsAcrossChannels(md, k));
                value = sum / R(T(3));
            }
            sum.add(value, x, columns - x);
            if (a.map) {
                float* out = a.map + long(centre) * a.mapStride + x0 + x;
                store(value, out);
            }
        }
        sum.addTo(a.rows + long(centre) * kSumStrands);
    }
}
template <class R>
__attribute__((flatten)) void ssimRows(const SsimArgs& a, int y0, int y1) {
    for (int x0 = 0; x0 < a.width; x0 += kStrip) {
        if (a.signal == SsimSignal::volume)
            ssimStrip<R, 3>(a, x0, y0, y1);
        else
            ssimStrip<R, 1>(a, x0, y0, y1);
    }
}
// Codes of an image file, so float in every precision. Channels draw on their own: grey noise would be seen better.
template <class R>
__attribute__((flatten)) void ditherRows(const DitherArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++) {
        const uint32_t seed = noiseSeed(NoiseStream::outputDither, a.frame, uint32_t(y));
        for (int c = 0; c < 3; c++)
            for (int x = 0; x < a.width; x++) {
                float& v = a.image.c[c][long(y) * a.stride + x];
                const float chance = noise<float>(seed, uint32_t(3 * x + c));
                v = min(floor(saturate(v) * 255.0f + chance), 255.0f) / 255.0f;
            }
    }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::MetricsKernels, metricsKernels) = {AA_ROWS(squaredErrorRows), AA_ROWS(relativeErrorRows),
                                                       AA_ROWS(ssimRows), AA_ROWS(ditherRows)};
