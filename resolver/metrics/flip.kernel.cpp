#include "kernels/math.h"
#include "metrics/flip_constants.h"
#include "metrics/flip_kernels.h"
#include "metrics/strip.h"

namespace AA_ARCH {
using namespace aa;
using namespace aa::flip_constants;

constexpr int kStrip = 128;  // columns; 64 load more margin, 256 leave the cache: both are slower

// The filters at the usual distance are constants, so that their loops unroll: a third faster.
struct UsualFilters {
    static constexpr int kMostReach = kCsfReach;
    static constexpr int csfReach = kCsfReach, narrowReach = kNarrowReach, featureReach = kFeatureReach;
    static constexpr const double *csfY = kCsfY, *csfCx = kCsfCx, *csfCzWide = kCsfCzWide, *csfCzNarrow = kCsfCzNarrow;
    static constexpr const double *gauss = kGauss, *edge = kEdge, *point = kPoint;
    static constexpr double czWideShare = kCzWideShare;
};
// And at any other they are given.
struct GivenFilters : FlipFilters {
    static constexpr int kMostReach = FlipFilters::kMostReach;
};
template <class F>
constexpr int kMargin = (F::kMostReach + 7) / 8 * 8;  // loaded beside a strip: whole lanes
template <class F>
constexpr int kLoaded = kStrip + 2 * kMargin<F>;
template <class F>
constexpr int kWindow = 2 * F::kMostReach + 1;

template <class R>
AA_INLINE R constant(double v) {
    return R(Elem<R>(v));
}
template <class R>
AA_INLINE vec3<R> transform(const double (&m)[3][3], vec3<R> c) {
    const auto row = [&](int i) __attribute__((always_inline)) {
        return c.x * constant<R>(m[i][0]) + c.y * constant<R>(m[i][1]) + c.z * constant<R>(m[i][2]);
    };
    return {row(0), row(1), row(2)};
}
// Luminance, red-green and blue-yellow: XYZ over the white point, then (Y, 500 (X - Y), 200 (Y - Z)). The paper's
// offset and scale of the first, 116 Y - 16, pass through every normalised filter and are left out here.
template <class R>
AA_INLINE vec3<R> opponent(vec3<R> linear) {
    const vec3<R> xyz = transform(kToXyz, linear);
    return {xyz.y, (xyz.x - xyz.y) * constant<R>(500), (xyz.y - xyz.z) * constant<R>(200)};
}
template <class R>
AA_INLINE R labCurve(R t) {
    return select(t > constant<R>(216.0 / 24389), cbrtPositive(max(t, constant<R>(1e-6))),
                  t * constant<R>(841.0 / 108) + constant<R>(4.0 / 29));
}
// Filtered opponent colour -> CIELab with Hunt's adjustment: chroma fades with lightness.
template <class R>
AA_INLINE vec3<R> huntLab(vec3<R> o) {
    const vec3<R> xyz{o.x + o.y * constant<R>(1.0 / 500), o.x, o.x - o.z * constant<R>(1.0 / 200)};
    const vec3<R> seen = transform(kToXyz, saturate(transform(kToRgb, xyz)));
    const R fx = labCurve(seen.x), fy = labCurve(seen.y), fz = labCurve(seen.z);
    const R lightness = fy * constant<R>(116) - constant<R>(16), hunt = lightness * constant<R>(0.01);
    return {lightness, hunt * (fx - fy) * constant<R>(500), hunt * (fy - fz) * constant<R>(200)};
}

// One row of symmetric or antisymmetric taps around p, `step` values apart.
template <class R>
AA_INLINE R even(const Elem<R>* p, long step, const double* taps, int reach) {
    R sum = loadOwn<R>(p) * constant<R>(taps[0]);
    for (int i = 1; i <= reach; i++)
        sum = sum + (loadOwn<R>(p - i * step) + loadOwn<R>(p + i * step)) * constant<R>(taps[i]);
    return sum;
}
template <class R>
AA_INLINE R odd(const Elem<R>* p, long step, const double* taps, int reach) {
    R sum = (loadOwn<R>(p - step) - loadOwn<R>(p + step)) * constant<R>(taps[1]);
    for (int i = 2; i <= reach; i++)
        sum = sum + (loadOwn<R>(p - i * step) - loadOwn<R>(p + i * step)) * constant<R>(taps[i]);
    return sum;
}

// The point filter, whose taps sum to 0, as differences from the centre: exactly 0 on flat ground, where the square
// root that follows would turn a rounding error of 1e-8 into 1e-4.
template <class R>
AA_INLINE R evenOfDifferences(const Elem<R>* p, long step, const double* taps, int reach) {
    const R twice = loadOwn<R>(p) * constant<R>(2);
    R sum = (loadOwn<R>(p - step) + loadOwn<R>(p + step) - twice) * constant<R>(taps[1]);
    for (int i = 2; i <= reach; i++)
        sum = sum + (loadOwn<R>(p - i * step) + loadOwn<R>(p + i * step) - twice) * constant<R>(taps[i]);
    return sum;
}

// What the pass along x leaves of one row of one image.
template <class T>
struct alignas(64) FlipRow {
    T y[kStrip], cx[kStrip], czWide[kStrip], czNarrow[kStrip];  // contrast sensitivity
    T gauss[kStrip], edge[kStrip], point[kStrip];               // features of the luminance
};
// And the pass along y: colour as seen, and the strengths of edge and point.
template <class T>
struct alignas(64) SeenRow {
    T lightness[kStrip], a[kStrip], b[kStrip], edge[kStrip], point[kStrip];
};

// Opponent colour of row y of a strip with its margins, coordinates clamped to the image.
template <class R, class F>
AA_INLINE void loadOpponent(const RgbIn& image, const FlipArgs& a, int x0, int y, Elem<R> (*o)[kLoaded<F>]) {
    const long row = long(y < 0 ? 0 : y >= a.height ? a.height - 1 : y) * a.stride;
    const int first = x0 - kMargin<F>;
    const auto convert = [&]<class Q>(long at, int i, Q) __attribute__((always_inline)) {
        const auto value = [&](int c) __attribute__((always_inline)) {
            return max(Q(Elem<Q>(0)), load<Q>(image.c[c] + at));  // NaN becomes 0
        };
        const vec3<Q> c = opponent(vec3<Q>(value(0), value(1), value(2)));
        store(c.x, o[0] + i), store(c.y, o[1] + i), store(c.z, o[2] + i);
    };
    if (first >= 0 && first + kLoaded<F> <= a.width) {
        if (y + kRowsAhead < a.height)
            for (int c = 0; c < 3; c++) prefetch(image.c[c] + row + long(kRowsAhead) * a.stride + first, kLoaded<F>);
        for (int i = 0; i < kLoaded<F>; i += N<R>) convert(row + first + i, i, R{});
        return;
    }
    for (int i = 0; i < kLoaded<F>; i++) {
        const int x = first + i < 0 ? 0 : first + i >= a.width ? a.width - 1 : first + i;
        convert(row + x, i, Elem<R>{});
    }
}
template <class R, class F>
AA_INLINE void filterAlongX(const F& f, const Elem<R> (*o)[kLoaded<F>], int columns, FlipRow<Elem<R>>& row) {
    const Elem<R>*y = o[0] + kMargin<F>, *cx = o[1] + kMargin<F>, *cz = o[2] + kMargin<F>;
    for (int x = 0; x < columns; x += N<R>) {
        store(even<R>(y + x, 1, f.csfY, f.narrowReach), row.y + x);
        store(even<R>(cx + x, 1, f.csfCx, f.narrowReach), row.cx + x);
        store(even<R>(cz + x, 1, f.csfCzWide, f.csfReach), row.czWide + x);
        store(even<R>(cz + x, 1, f.csfCzNarrow, f.csfReach), row.czNarrow + x);
        store(even<R>(y + x, 1, f.gauss, f.featureReach), row.gauss + x);
        store(odd<R>(y + x, 1, f.edge, f.featureReach), row.edge + x);
        store(evenOfDifferences<R>(y + x, 1, f.point, f.featureReach), row.point + x);
    }
}
// `centre` is the middle one of kWindow successive rows.
template <class R, class F>
AA_INLINE void filterAlongY(const F& f, const FlipRow<Elem<R>>& centre, int columns, SeenRow<Elem<R>>& seen) {
    constexpr long step = sizeof(FlipRow<Elem<R>>) / sizeof(Elem<R>);
    for (int x = 0; x < columns; x += N<R>) {
        const R cz = even<R>(centre.czWide + x, step, f.csfCzWide, f.csfReach) * constant<R>(f.czWideShare) +
                     even<R>(centre.czNarrow + x, step, f.csfCzNarrow, f.csfReach) * constant<R>(1 - f.czWideShare);
        const vec3<R> lab = huntLab(vec3<R>(even<R>(centre.y + x, step, f.csfY, f.narrowReach),
                                            even<R>(centre.cx + x, step, f.csfCx, f.narrowReach), cz));
        store(lab.x, seen.lightness + x), store(lab.y, seen.a + x), store(lab.z, seen.b + x);
    }
    for (int x = 0; x < columns; x += N<R>) {
        const R ex = even<R>(centre.edge + x, step, f.gauss, f.featureReach),
                ey = odd<R>(centre.gauss + x, step, f.edge, f.featureReach);
        const R px = even<R>(centre.point + x, step, f.gauss, f.featureReach),
                py = evenOfDifferences<R>(centre.gauss + x, step, f.point, f.featureReach);
        store(sqrt(ex * ex + ey * ey), seen.edge + x), store(sqrt(px * px + py * py), seen.point + x);
    }
}
// HyAB distance to the power 0.7, mapped so that 0.4 of the largest becomes 0.95.
template <class R>
AA_INLINE R colourDifference(const SeenRow<Elem<R>>& t, const SeenRow<Elem<R>>& r, int x) {
    const R da = loadOwn<R>(t.a + x) - loadOwn<R>(r.a + x), db = loadOwn<R>(t.b + x) - loadOwn<R>(r.b + x);
    const R hyab = abs(loadOwn<R>(t.lightness + x) - loadOwn<R>(r.lightness + x)) + sqrt(da * da + db * db);
    const R d = powPositive(hyab, constant<R>(0.7));
    constexpr double knee = 0.4 * kMaxColour;
    return select(d < constant<R>(knee), d * constant<R>(0.95 / knee),
                  constant<R>(0.95) + (d - constant<R>(knee)) * constant<R>(0.05 / (kMaxColour - knee)));
}
template <class R>
AA_INLINE R featureDifference(const SeenRow<Elem<R>>& t, const SeenRow<Elem<R>>& r, int x) {
    const R edge = abs(loadOwn<R>(t.edge + x) - loadOwn<R>(r.edge + x));
    const R point = abs(loadOwn<R>(t.point + x) - loadOwn<R>(r.point + x));
    return sqrt(max(edge, point) * constant<R>(0.70710678118654752));  // 1 / sqrt(2)
}

template <class R, class F>
AA_INLINE void flipStrip(const F& f, const FlipArgs& a, int x0, int y0, int y1) {
    using T = Elem<R>;
    // Every row is stored twice, a window apart, so that any successive rows of a window lie one after the other.
    FlipRow<T> ring[2][2 * kWindow<F>];
    alignas(64) T o[3][kLoaded<F>];
    SeenRow<T> seen[2];
    const int columns = a.width - x0 < kStrip ? a.width - x0 : kStrip, reach = f.csfReach, window = 2 * reach + 1;
    for (int y = y0 - reach; y < y1 + reach; y++) {
        const int slot = (y - y0 + reach) % window, centre = y - reach;
        for (int image = 0; image < 2; image++) {
            loadOpponent<R, F>(image ? a.reference : a.test, a, x0, y, o);
            filterAlongX<R>(f, o, columns, ring[image][slot]);
            ring[image][slot + window] = ring[image][slot];
            if (centre >= y0) filterAlongY<R>(f, ring[image][slot + 1 + reach], columns, seen[image]);
        }
        if (centre < y0) continue;
        Strands<R> sum;
        for (int x = 0; x < columns; x += N<R>) {
            const R colour = colourDifference<R>(seen[0], seen[1], x),
                    feature = featureDifference<R>(seen[0], seen[1], x);
            const R value = min(powPositive(colour, constant<R>(1) - feature), constant<R>(1));
            sum.add(value, x, columns - x);
            if (a.map) store(value, a.map + long(centre) * a.mapStride + x0 + x);
        }
        sum.addTo(a.rows + long(centre) * kSumStrands);
    }
}
template <class R>
__attribute__((flatten)) void flipRows(const FlipArgs& a, int y0, int y1) {
    for (int x0 = 0; x0 < a.width; x0 += kStrip) flipStrip<R>(UsualFilters{}, a, x0, y0, y1);
}
template <class R>
__attribute__((flatten)) void givenFlipRows(const FlipArgs& a, int y0, int y1) {
    for (int x0 = 0; x0 < a.width; x0 += kStrip) flipStrip<R>(GivenFilters{*a.filters}, a, x0, y0, y1);
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::FlipKernels, flipKernels) = {AA_ROWS(flipRows), AA_ROWS(givenFlipRows)};
