// What limits it on AVX2: arithmetic, about 1300 operations per 8 pixels of a pair, of which 770 are the filters' (19
// taps of seven kinds, along either axis, in both images); 2.2 of them per cycle. So nothing waits for memory: light
// becomes opponent colour once, the rows under a window stay in the second cache, and both passes read whole registers:
// lanes are columns along y, and rows along x, to which tiles of 8 x 8 px are transposed.
#include "kernels/math.h"
#include "kernels/srgb.h"
#include "kernels/transpose.h"
#include "metrics/flip_constants.h"
#include "metrics/flip_kernels.h"
#include "metrics/strip.h"

namespace AA_ARCH {
using namespace aa;
using namespace aa::flip_constants;

constexpr int kTile = kTileRows;
constexpr int kStrip = 256;           // columns that are loaded together
constexpr int kChunk = kFlipColumns;  // of these, what is filtered together: it fills half of the first cache
static_assert(kTile == kFlipTileRows && kStrip % kChunk == 0);

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
constexpr int kWindow = kTile + 2 * F::kMostReach;  // rows under the windows of a tile
template <class F>
constexpr int kKept = kWindow<F> <= 32 ? 32 : 64;  // rows that are kept, a power of two

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
// Filtered opponent colour -> XYZ over the white point of what a display can show.
template <class R>
AA_INLINE vec3<R> shown(vec3<R> o) {
    const vec3<R> xyz{o.x + o.y * constant<R>(1.0 / 500), o.x, o.x - o.z * constant<R>(1.0 / 200)};
    return transform(kToXyz, saturate(transform(kToRgb, xyz)));
}
// Its labCurve() -> CIELab with Hunt's adjustment: chroma fades with lightness.
template <class R>
AA_INLINE vec3<R> huntLab(vec3<R> f) {
    const R lightness = f.y * constant<R>(116) - constant<R>(16), hunt = lightness * constant<R>(0.01);
    return {lightness, hunt * (f.x - f.y) * constant<R>(500), hunt * (f.y - f.z) * constant<R>(200)};
}

// Symmetric or antisymmetric taps; at(i) is the value i places away.
template <class R, class At>
AA_INLINE R even(const At& at, const double* taps, int reach) {
    R sum = at(0) * constant<R>(taps[0]);
    for (int i = 1; i <= reach; i++) sum = sum + (at(-i) + at(i)) * constant<R>(taps[i]);
    return sum;
}
template <class R, class At>
AA_INLINE R odd(const At& at, const double* taps, int reach) {
    R sum = (at(-1) - at(1)) * constant<R>(taps[1]);
    for (int i = 2; i <= reach; i++) sum = sum + (at(-i) - at(i)) * constant<R>(taps[i]);
    return sum;
}
// The point filter, whose taps sum to 0, as differences from the centre: exactly 0 on flat ground, where the square
// root that follows would turn a rounding error of 1e-8 into 1e-4.
template <class R, class At>
AA_INLINE R evenOfDifferences(const At& at, const double* taps, int reach) {
    const R twice = at(0) * constant<R>(2);
    R sum = (at(-1) + at(1) - twice) * constant<R>(taps[1]);
    for (int i = 2; i <= reach; i++) sum = sum + (at(-i) + at(i) - twice) * constant<R>(taps[i]);
    return sum;
}

template <class T, class F>
struct alignas(64) OpponentRow {
    T c[3][kLoaded<F>];
};
// What the pass along y leaves of a chunk of kTile rows, and its margins: one column after the other.
enum Filtered { csfY, csfCx, csfCzWide, csfCzNarrow, gaussOfY, edgeOfY, pointOfY, kFiltered };
template <class T, class F>
struct alignas(64) FilteredColumns {
    T of[kFiltered][(kChunk + 2 * kMargin<F>)*kTile];
};
// And the pass along x: colour as seen, and the strengths of edge and point.
enum Seen { lightness, hueA, hueB, edgeStrength, pointStrength, kSeen };
static_assert(kSeen == kFlipSeen);
template <class T>
struct alignas(64) SeenColumns {
    T of[kSeen][kChunk * kTile];
};

// Opponent colour of row y of a strip with its margins, coordinates clamped to the image.
template <class R, class F>
AA_INLINE void loadOpponent(const RgbIn& image, const FlipArgs& a, int x0, int y, OpponentRow<Elem<R>, F>& out) {
    constexpr int margin = kMargin<F>;
    const long row = long(y < 0 ? 0 : y >= a.height ? a.height - 1 : y) * a.stride + x0;
    const int inside = a.width - x0, end = inside < kStrip + margin ? inside : kStrip + margin,
              begin = x0 ? -margin : 0;
    // The last lanes may lie beyond the image, in its padding. A loop for each channel: see seeColours().
    for (int c = 0; c < 3; c++) {
        const float* const in = image.c[c] + row;
        if (y + kTile < a.height)  // a strip jumps from row to row, which no processor foresees
            prefetch(in + kTile * long(a.stride), end);
        for (int x = begin; x < end; x += N<R>) {
            const R v = load<R>(in + x);
            store(max(constant<R>(0), a.encoded ? srgbDecode(saturate(v)) : v),
                  out.c[c] + margin + x);  // NaN becomes 0
        }
    }
    for (int x = margin + begin; x < margin + end; x += N<R>) {
        const vec3<R> c =
            opponent(vec3<R>(loadOwn<R>(out.c[0] + x), loadOwn<R>(out.c[1] + x), loadOwn<R>(out.c[2] + x)));
        store(c.x, out.c[0] + x), store(c.y, out.c[1] + x), store(c.z, out.c[2] + x);
    }
    for (auto& c : out.c) {
        for (int x = -margin; x < 0 && x0 == 0; x++) c[margin + x] = c[margin];
        for (int x = end; x < kStrip + margin; x++) c[margin + x] = c[margin + end - 1];
    }
}
// Columns x .. x + N<R> - 1 of the strip, kTile rows; `rows`: those under the windows.
template <class R, class F>
AA_INLINE void filterAlongY(const F& f, const OpponentRow<Elem<R>, F>* const* rows, int x, int place,
                            FilteredColumns<Elem<R>, F>& out) {
    const int window = kTile + 2 * f.csfReach;
    R in[kWindow<F>], found[kFiltered][kTile];
    const auto load = [&](int channel) __attribute__((always_inline)) {
        for (int j = 0; j < window; j++) in[j] = loadOwn<R>(rows[j]->c[channel] + kMargin<F> + x);
    };
    const auto around = [&](int k) __attribute__((always_inline)) {
        return [p = in + f.csfReach + k](int i) __attribute__((always_inline)) { return p[i]; };
    };
    load(0);
    for (int k = 0; k < kTile; k++) {
        const auto at = around(k);
        found[csfY][k] = even<R>(at, f.csfY, f.narrowReach);
        found[gaussOfY][k] = even<R>(at, f.gauss, f.featureReach);
        found[edgeOfY][k] = odd<R>(at, f.edge, f.featureReach);
        found[pointOfY][k] = evenOfDifferences<R>(at, f.point, f.featureReach);
    }
    load(1);
    for (int k = 0; k < kTile; k++) found[csfCx][k] = even<R>(around(k), f.csfCx, f.narrowReach);
    load(2);
    for (int k = 0; k < kTile; k++) {
        found[csfCzWide][k] = even<R>(around(k), f.csfCzWide, f.csfReach);
        found[csfCzNarrow][k] = even<R>(around(k), f.csfCzNarrow, f.csfReach);
    }
    for (int i = 0; i < kFiltered; i++) storeTransposed(found[i], out.of[i] + place * kTile);
}
// `place`: of the column and the row in `out`. Colour stays opponent colour.
template <class R, class F>
AA_INLINE void filterAlongX(const F& f, const FilteredColumns<Elem<R>, F>& in, int place, SeenColumns<Elem<R>>& out) {
    const auto of = [&](Filtered kind) __attribute__((always_inline)) {
        return [p = in.of[kind] + kMargin<F> * kTile + place](int i) __attribute__((always_inline)) {
            return loadOwn<R>(p + i * kTile);
        };
    };
    const R cz = even<R>(of(csfCzWide), f.csfCzWide, f.csfReach) * constant<R>(f.czWideShare) +
                 even<R>(of(csfCzNarrow), f.csfCzNarrow, f.csfReach) * constant<R>(1 - f.czWideShare);
    store(even<R>(of(csfY), f.csfY, f.narrowReach), out.of[lightness] + place);
    store(even<R>(of(csfCx), f.csfCx, f.narrowReach), out.of[hueA] + place);
    store(cz, out.of[hueB] + place);
    const R ex = odd<R>(of(gaussOfY), f.edge, f.featureReach), ey = even<R>(of(edgeOfY), f.gauss, f.featureReach);
    const R px = evenOfDifferences<R>(of(gaussOfY), f.point, f.featureReach),
            py = even<R>(of(pointOfY), f.gauss, f.featureReach);
    store(sqrt(ex * ex + ey * ey), out.of[edgeStrength] + place);
    store(sqrt(px * px + py * py), out.of[pointStrength] + place);
}
// Opponent colour -> CIELab. Roots and powers are long chains, of which a processor must have many pixels' in sight to
// be busy, so they have loops of their own here and in judge().
template <class R>
AA_INLINE void seeColours(SeenColumns<Elem<R>>& seen, int places) {
    Elem<R>*const x = seen.of[lightness], *const y = seen.of[hueA], *const z = seen.of[hueB];
    const auto each = [&](const auto& change) __attribute__((always_inline)) {
        for (int i = 0; i < places; i += N<R>) {
            const vec3<R> c = change(vec3<R>(loadOwn<R>(x + i), loadOwn<R>(y + i), loadOwn<R>(z + i)));
            store(c.x, x + i), store(c.y, y + i), store(c.z, z + i);
        }
    };
    each([](vec3<R> c) __attribute__((always_inline)) { return shown(c); });
    for (int k = 0; k < 3; k++)
        for (int i = 0; i < places; i += N<R>) store(labCurve(loadOwn<R>(seen.of[k] + i)), seen.of[k] + i);
    each([](vec3<R> c) __attribute__((always_inline)) { return huntLab(c); });
}
// HyAB distance to the power 0.7, mapped so that 0.4 of the largest becomes 0.95.
template <class R>
AA_INLINE R colourDifference(R lightness, R a, R b) {
    const R hyab = abs(lightness) + sqrt(a * a + b * b);
    const R d = powPositive(hyab, constant<R>(0.7));
    constexpr double knee = 0.4 * kMaxColour;
    return select(d < constant<R>(knee), d * constant<R>(0.95 / knee),
                  constant<R>(0.95) + (d - constant<R>(knee)) * constant<R>(0.05 / (kMaxColour - knee)));
}
// FLIP of `places` pixels, over the test's lightness.
template <class R>
AA_INLINE void judge(SeenColumns<Elem<R>>& test, const SeenColumns<Elem<R>>& reference, int places) {
    Elem<R>* const out = test.of[lightness];
    const auto difference = [&](Seen kind, int i) __attribute__((always_inline)) {
        return loadOwn<R>(test.of[kind] + i) - loadOwn<R>(reference.of[kind] + i);
    };
    for (int i = 0; i < places; i += N<R>)
        store(colourDifference(difference(lightness, i), difference(hueA, i), difference(hueB, i)), out + i);
    for (int i = 0; i < places; i += N<R>) {
        const R strongest = max(abs(difference(edgeStrength, i)), abs(difference(pointStrength, i)));
        const R feature = sqrt(strongest * constant<R>(0.70710678118654752));  // 1 / sqrt(2)
        store(min(powPositive(loadOwn<R>(out + i), constant<R>(1) - feature), constant<R>(1)), out + i);
    }
}
// Sums, and the map, of rows y .. y + N<R> - 1 of a chunk at column x0, of which rows [y0, y1) count.
template <class R>
AA_INLINE void sum(const FlipArgs& a, const Elem<R>* flip, int x0, int columns, int y, int y0, int y1) {
    RowSums<R> sums;
    for (int x = 0; x < columns; x += kTile) {
        R value[kTile];
        for (int k = 0; k < kTile; k++) value[k] = loadOwn<R>(flip + (x + k) * kTile);
        for (int k = 0; k < kTile && x + k < columns; k++) sums.add(value[k]);
        if (a.map) storeRows(value, a.map + long(y) * a.mapStride + x0 + x, a.mapStride, y0 - y, y1 - y);
    }
    for (int i = 0; i < N<R>; i++)
        if (y + i >= y0 && y + i < y1) a.rows[y + i] += sums.of(i);
}
// A strip of rows [y0, y1), of which the first begins a block; the last may end beyond the image.
template <class R, class F, bool kJudges>
AA_INLINE void flipStrip(const F& f, const FlipArgs& a, int x0, int y0, int y1) {
    using T = Elem<R>;
    using Block = SeenColumns<T>;
    OpponentRow<T, F> kept[kKept<F>];
    FilteredColumns<T, F> filtered;
    Block ofTest;
    const OpponentRow<T, F>* rows[kWindow<F>];
    const int columns = a.width - x0 < kStrip ? a.width - x0 : kStrip, blocks = (a.width + kChunk - 1) / kChunk;
    int loaded = y0 - f.csfReach;
    for (int y = y0; y < y1; y += kTile) {
        for (; loaded < y + kTile + f.csfReach; loaded++)
            loadOpponent<R, F>(a.image, a, x0, loaded, kept[unsigned(loaded) % kKept<F>]);
        for (int j = 0; j < kTile + 2 * f.csfReach; j++) rows[j] = &kept[unsigned(y - f.csfReach + j) % kKept<F>];
        for (int x = 0; x < columns; x += kChunk) {
            const int count = columns - x < kChunk ? columns - x : kChunk;
            const int places = (count + kTile - 1) / kTile * kTile * kTile;
            const long block = long(y / kTile) * blocks + (x0 + x) / kChunk;
            if (x)  // its first columns are the last of the chunk before it
                for (auto& filter : filtered.of)
                    std::memcpy(filter, filter + kChunk * kTile, 2 * kMargin<F> * kTile * sizeof(T));
            for (int i = x ? kMargin<F> : -kMargin<F>; i < count + kMargin<F>; i += N<R>)
                filterAlongY<R, F>(f, rows, x + i, kMargin<F> + i, filtered);
            Block& seen = kJudges ? ofTest : static_cast<Block*>(a.seen)[block];
            for (int i = 0; i < places; i += N<R>) filterAlongX<R, F>(f, filtered, i, seen);
            seeColours<R>(seen, places);
            if constexpr (kJudges) {
                judge<R>(seen, static_cast<const Block*>(a.reference)[block], places);
                for (int row = 0; row < kTile; row += N<R>)
                    sum<R>(a, seen.of[lightness] + row, x0 + x, count, y + row, y0, y1);
            }
        }
    }
}
template <class R, bool kJudges, class F>
AA_INLINE void flipStrips(const F& f, const FlipArgs& a, int block0, int block1) {
    const int y0 = block0 * kTile, end = block1 * kTile, y1 = end < a.height ? end : a.height;
    for (int x0 = 0; x0 < a.width; x0 += kStrip) flipStrip<R, F, kJudges>(f, a, x0, y0, y1);
}
template <class R>
__attribute__((flatten)) void seeBlocks(const FlipArgs& a, int block0, int block1) {
    flipStrips<R, false>(UsualFilters{}, a, block0, block1);
}
template <class R>
__attribute__((flatten)) void judgeBlocks(const FlipArgs& a, int block0, int block1) {
    flipStrips<R, true>(UsualFilters{}, a, block0, block1);
}
template <class R>
__attribute__((flatten)) void seeBlocksFrom(const FlipArgs& a, int block0, int block1) {
    flipStrips<R, false>(GivenFilters{*a.filters}, a, block0, block1);
}
template <class R>
__attribute__((flatten)) void judgeBlocksFrom(const FlipArgs& a, int block0, int block1) {
    flipStrips<R, true>(GivenFilters{*a.filters}, a, block0, block1);
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::FlipKernels, flipKernels) = {AA_ROWS(seeBlocks), AA_ROWS(judgeBlocks), AA_ROWS(seeBlocksFrom),
                                                 AA_ROWS(judgeBlocksFrom)};
