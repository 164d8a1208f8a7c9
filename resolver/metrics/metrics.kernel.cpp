#include "kernels/hash.h"
#include "kernels/lanes.h"
#include "kernels/transpose.h"
#include "metrics/metrics_kernels.h"
#include "metrics/strip.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
__attribute__((flatten)) void pictureLumaRows(const LumaArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            store(luma601(colourAt<R>(a.in.c, o)), a.out + o);
        }
}

template <class R>
__attribute__((flatten)) void squaredErrorRows(const SquaredErrorArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int tile = 0; tile < a.tilesX; tile++) {
            Strands<R> error;
            const int begin = tile * kErrorTilePx, tileEnd = begin + kErrorTilePx,
                      end = tileEnd < a.width ? tileEnd : a.width;
            for (int c = 0; c < 3; c++)
                for (int x = begin; x < end; x += N<R>) {
                    const long o = long(y) * a.stride + x;
                    const R d = load<R>(a.test.c[c] + o) - load<R>(a.reference.c[c] + o);
                    error.add(d * d, x, end - x);
                }
            a.tileRows[long(y) * a.tilesX + tile] = error.total();
        }
}
// In the order of tiles.
template <class R>
__attribute__((flatten)) void squaresRows(const SquaresArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++) {
        Strands<R> sum;
        for (int begin = 0; begin < a.width; begin += kErrorTilePx)
            for (int c = 0; c < 3; c++)
                for (int x = begin; x < begin + kErrorTilePx && x < a.width; x += N<R>) {
                    const R v = load<R>(a.image.c[c] + long(y) * a.stride + x);
                    sum.add(v * v, x, a.width - x);
                }
        a.rows[y] = sum.total();
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
// so that two variances are enough and identical images (d = 0) give exactly 1. A variance is gathered first along y
// and then along x, of the columns' means and variances:
//   var = sum_i w_i (var_i + (mean_i - p)^2) - (mean - p)^2
// p is a value of the window itself, of weight w: var >= w (mean - p)^2, so that the difference loses at
// most a factor 1 + 1 / w of the precision, and that only where an edge lies between p and nearly all of the window:
// 1.3e-6 of one pixel's SSIM, 1e-10 of a picture's. One p serves kTile rows, then kTile columns, which are the same
// whatever rows a thread is given. So both passes are weighted sums, two per signal, and nothing is subtracted tap by
// tap. They run on registers whose lanes are columns, then rows: between them tiles are transposed, because of
// unaligned neighbours every other one lies in two cache lines.
//
// What limits it on AVX2: arithmetic, of which 117 additions per 8 pixels of a channel, two per cycle, are the most.

constexpr int kReach = 5;
constexpr int kTile = kTileRows;             // rows and columns about one pivot: at most 4 away, w >= 0.0076
constexpr int kPivot = kTile / 2 - 1;        // its place
constexpr int kWindow = kTile + 2 * kReach;  // rows or columns that a tile reads
constexpr int kStrip = 128;                  // columns
constexpr int kMargin = 8;                   // beside a strip: whole lanes
constexpr int kPadded = kStrip + 2 * kMargin;
// exp(-i^2 / (2 1.5^2)) / sum, i = 0..5 (conventions 13.2; here to double precision)
constexpr double kGauss[kReach + 1] = {0.2660117248617943,  0.21300553771125366,  0.1093606895097,
                                       0.03600077212843082, 0.007598758135239184, 0.0010283800844791099};
constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;  // (K1 L)^2, (K2 L)^2, L = 1

template <class R>
struct Moments {
    R mean, variance;
};
// Of s and of d, along y: mean and variance of kTile rows of each column, one column after the other.
template <class T>
struct alignas(64) ColumnMoments {
    T of[2][2][kPadded * kTile];
};
// p[0] .. p[10], and p[1] .. p[11].
template <class R>
AA_INLINE Two<R> windowed(const R* p) {
    const auto two = [&](int i) __attribute__((always_inline)) { return Two<R>{p[i], p[i + 1]}; };
    const auto pair = [&](int i) __attribute__((always_inline)) {
        return (two(kReach - i) + two(kReach + i)) * kGauss[i];
    };
    return (two(kReach) * kGauss[0] + pair(1)) + ((pair(2) + pair(3)) + (pair(4) + pair(5)));
}
// Of the kTile windows about `value` and what lies kReach before and behind; `within`: the variances of these values.
template <class R>
AA_INLINE void momentsOf(const R (&value)[kWindow], const R* within, Moments<R> (&out)[kTile]) {
    const R pivot = value[kReach + kPivot];
    R first[kWindow], second[kWindow];
#pragma GCC unroll 18  // kWindow
    for (int j = 0; j < kWindow; j++) {
        first[j] = value[j] - pivot;
        second[j] = first[j] * first[j];
        if (within) second[j] = within[j] + second[j];
    }
#pragma GCC unroll 4  // kTile / 2
    for (int k = 0; k < kTile; k += 2) {
        const Two<R> mean = windowed(first + k), square = windowed(second + k);
        out[k] = {pivot + mean.first, square.first - mean.first * mean.first};
        out[k + 1] = {pivot + mean.second, square.second - mean.second * mean.second};
    }
}

// Rows y0 .. y0 + kTile - 1 of the strip at x0 and what is needed beside it; coordinates are clamped to the image. Of
// the strip before it, the last columns are there already.
template <class R>
AA_INLINE void momentsAlongY(const SsimArgs& a, int signal, int x0, int y0, int columns, ColumnMoments<Elem<R>>& out) {
    long rows[kWindow];
#pragma GCC unroll 18  // kWindow
    for (int j = 0; j < kWindow; j++) {
        const int y = y0 - kReach + j;
        rows[j] = long(y < 0 ? 0 : y >= a.height ? a.height - 1 : y) * a.stride + x0;
    }
    const int reach = columns + kMargin, inside = a.width - x0, end = reach < inside ? reach : inside;
    const auto pixel = [&](const RgbIn& image, long o) __attribute__((always_inline)) {
        if (signal < 3) return load<R>(image.c[signal] + o);
        return luma601(colourAt<R>(image.c, o));
    };
    for (int x = x0 ? kMargin : 0; x < end; x += N<R>) {  // the last lanes may lie beyond the image, in its padding
        if (signal < 3 &&
            x % 16 == 0)  // a line of the cache, of the rows below that the next tile is the first to read
            for (int j = kWindow - kTile; j < kWindow; j++) {
                const long next = rows[j] + x + long(kTile) * a.stride;
                __builtin_prefetch(a.test.c[signal] + next, 0, 2);
                __builtin_prefetch(a.reference.c[signal] + next, 0, 2);
            }
        R value[2][kWindow];
#pragma GCC unroll 18  // kWindow
        for (int j = 0; j < kWindow; j++) {
            const R t = pixel(a.test, rows[j] + x), r = pixel(a.reference, rows[j] + x);
            value[0][j] = t + r, value[1][j] = t - r;
        }
        for (int signal = 0; signal < 2; signal++) {
            Moments<R> m[kTile];
            momentsOf<R>(value[signal], nullptr, m);
            R mean[kTile], variance[kTile];
#pragma GCC unroll 8  // kTile
            for (int k = 0; k < kTile; k++) mean[k] = m[k].mean, variance[k] = m[k].variance;
            storeTransposed(mean, out.of[signal][0] + (kMargin + x) * kTile);
            storeTransposed(variance, out.of[signal][1] + (kMargin + x) * kTile);
        }
    }
    const auto repeat = [&](int from, int x) __attribute__((always_inline)) {
        for (auto& signal : out.of)
            for (auto& p : signal)
                for (int k = 0; k < kTile; k++) p[(kMargin + x) * kTile + k] = p[(kMargin + from) * kTile + k];
    };
    for (int x = -kReach; x < 0 && x0 == 0; x++) repeat(0, x);
    for (int x = inside; x < kStrip + kMargin; x++) repeat(inside - 1, x);
}
// What the strip after it begins with.
template <class T>
AA_INLINE void keepLast(ColumnMoments<T>& m) {
    for (auto& signal : m.of)
        for (auto& p : signal) std::memcpy(p, p + kStrip * kTile, 2 * kMargin * kTile * sizeof(T));
}
// Columns x .. x + kTile - 1 of the strip; lanes are rows, from `row` on.
template <class R>
AA_INLINE void momentsAlongX(const ColumnMoments<Elem<R>>& columns, int signal, int x, int row,
                             Moments<R> (&out)[kTile]) {
    R value[kWindow], within[kWindow];
#pragma GCC unroll 18  // kWindow
    for (int j = 0; j < kWindow; j++) {
        const int at = (kMargin + x - kReach + j) * kTile + row;
        value[j] = loadOwn<R>(columns.of[signal][0] + at), within[j] = loadOwn<R>(columns.of[signal][1] + at);
    }
    momentsOf<R>(value, within, out);
}
template <class R>
AA_INLINE R ssimOf(Moments<R> s, Moments<R> d) {
    using T = Elem<R>;
    const R c1(T(2 * kC1)), c2(T(2 * kC2));  // both sides of the fraction times 4
    const R s2 = s.mean * s.mean, d2 = d.mean * d.mean;
    return ((s2 - d2 + c1) * (s.variance - d.variance + c2)) / ((s2 + d2 + c1) * (s.variance + d.variance + c2));
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
// SSIM of a tile's column from the moments of each channel.
template <class R, int Signals>
AA_INLINE R ssimOf(const Moments<R> (&m)[Signals][2][kTile], int column) {
    if constexpr (Signals == 1) return ssimOf(m[0][0][column], m[0][1][column]);
    R sum(Elem<R>(0));
    for (int channel = 0; channel < Signals; channel++) {
        Moments<R> pair[2];
        for (int signal = 0; signal < 2; signal++) {
            Moments<R> of[Signals];
            for (int k = 0; k < Signals; k++) of[k] = m[k][signal][column];
            pair[signal] = momentsAcrossChannels(of, channel);
        }
        sum = sum + ssimOf(pair[0], pair[1]);
    }
    return sum / R(Elem<R>(3));
}
// Rows y .. y + N<R> - 1 of a strip; of these, rows [y0, y1) count. `row`: of y in the tile.
template <class R, int Signals>
AA_INLINE void ssimLanes(const SsimArgs& a, const ColumnMoments<Elem<R>> (&moments)[Signals], int x0, int columns,
                         int y, int row, int y0, int y1) {
    RowSums<R> sums;
    for (int x = 0; x < columns; x += kTile) {
        Moments<R> m[Signals][2][kTile];
        for (int k = 0; k < Signals; k++)
            for (int signal = 0; signal < 2; signal++) momentsAlongX<R>(moments[k], signal, x, row, m[k][signal]);
        for (int k = 0; k < kTile && x + k < columns; k++) {
            const R value = ssimOf<R, Signals>(m, k);
            sums.add(value);
            if (!a.map) continue;
            alignas(32) Elem<R> of[N<R>];
            store(value, of);
            for (int i = 0; i < N<R>; i++)
                if (y + i >= y0 && y + i < y1) a.map[long(y + i) * a.mapStride + x0 + x + k] = float(of[i]);
        }
    }
    for (int i = 0; i < N<R>; i++)
        if (y + i >= y0 && y + i < y1) a.rows[y + i] += sums.of(i);
}
template <class R, int Signals>
AA_INLINE void ssimTiles(const SsimArgs& a, int y, int y0, int y1) {
    ColumnMoments<Elem<R>> moments[Signals];
    for (int x0 = 0; x0 < a.width; x0 += kStrip) {
        const int columns = a.width - x0 < kStrip ? a.width - x0 : kStrip;
        for (int k = 0; k < Signals; k++)
            momentsAlongY<R>(a, Signals == 1 ? int(a.signal) : k, x0, y, columns, moments[k]);
        for (int row = 0; row < kTile; row += N<R>)
            ssimLanes<R, Signals>(a, moments, x0, columns, y + row, row, y0, y1);
        for (auto& m : moments) keepLast(m);
    }
}
template <class R>
__attribute__((flatten)) void ssimRows(const SsimArgs& a, int y0, int y1) {
    for (int y = y0 / kTile * kTile; y < y1; y += kTile) {
        if (a.signal == SsimSignal::volume)
            ssimTiles<R, 3>(a, y, y0, y1);
        else
            ssimTiles<R, 1>(a, y, y0, y1);
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

AA_DEFINE_TABLE(aa::MetricsKernels, metricsKernels) = {AA_ROWS(pictureLumaRows), AA_ROWS(squaredErrorRows),
                                                       AA_ROWS(squaresRows),     AA_ROWS(relativeErrorRows),
                                                       AA_ROWS(ssimRows),        AA_ROWS(ditherRows)};
