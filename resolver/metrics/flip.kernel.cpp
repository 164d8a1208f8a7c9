// What limits it on AVX2: instructions, about 2100 for 8 pixels of a pair, of which 60 % are arithmetic and a third the
// filters' sums (19 taps of seven kinds, along either axis, in both images). So nothing waits for memory: light becomes
// opponent colour once, rows are asked for long before they are read, the rows under a window stay in the second cache
// and what is filtered along x in the first, and both passes read whole registers: lanes are columns along y, and rows
// along x, to which tiles of 8 x 8 px are transposed. Two or four places are filtered together, for they share most of
// what they read, and side by side, for each sum waits for itself.
#include "kernels/math.h"
#include "kernels/srgb.h"
#include "kernels/transpose.h"
#include "metrics/flip_constants.h"
#include "metrics/flip_filters.kernel.h"
#include "metrics/flip_kernels.h"
#include "metrics/strip.h"

namespace AA_ARCH {
using namespace aa;
using namespace aa::flip_constants;

constexpr int kTile = kTileRows;
constexpr int kChunk = kFlipColumns, kStrip = 2 * kChunk;  // columns
constexpr int kAtOnce = 64 * kTile;                        // places that are seen and judged while in the first cache
static_assert(kTile == kFlipTileRows);

// The filters at the usual distance are constants, so that their loops unroll: a third faster. kSharing: as many places
// side by side have one in all their windows.
struct UsualFilters {
    static constexpr int kMostReach = kCsfReach;
    static constexpr int kSharing = kTile;
    static constexpr int csfReach = kCsfReach, narrowReach = kNarrowReach, featureReach = kFeatureReach;
    static constexpr const double *csfY = kCsfY, *csfCx = kCsfCx, *csfCzWide = kCsfCzWide, *csfCzNarrow = kCsfCzNarrow;
    static constexpr const double *gauss = kGauss, *edge = kEdge, *point = kPoint;
    static constexpr const double *czWideAlongX = kCzWideAlongX.of, *czNarrowAlongX = kCzNarrowAlongX.of;
};
// And at any other they are given.
struct GivenFilters : FlipFilters {
    static constexpr int kMostReach = FlipFilters::kMostReach;
    static constexpr int kSharing = 2;
};
static_assert(UsualFilters::featureReach >= UsualFilters::kSharing - 1);
template <class F>
constexpr int kMargin = (F::kMostReach + 7) / 8 * 8;  // loaded beside a strip: whole lanes
template <class F>
constexpr int kLoaded = kStrip + 2 * kMargin<F>;
template <class F>
constexpr int kWindow = kTile + 2 * F::kMostReach;  // rows under the windows of a tile
template <class F>
constexpr int kKept = kWindow<F> <= 32 ? 32 : 64;  // rows that are kept, a power of two

template <class R>
AA_INLINE vec3<R> transform(const double (&m)[3][3], vec3<R> c) {
    const auto row = [&](int i) __attribute__((always_inline)) {
        return c.x * constant<R>(m[i][0]) + c.y * constant<R>(m[i][1]) + c.z * constant<R>(m[i][2]);
    };
    return {row(0), row(1), row(2)};
}
// Light of an sRGB code in [0, 1]. Above its line ((c + 0.055) / 1.055)^2.4 is s P(sqrt(s)), s = c + 0.055, a fit to
// 9e-8 of itself: half of the operations of srgbDecode(), as near to the truth in float. Beyond float that one stands.
template <class R>
AA_INLINE R light(R code) {
    if constexpr (std::is_same_v<Elem<R>, double>)
        return srgbDecode(code);
    else {
        const R fit[] = {constant<R>(0.0003214066456), constant<R>(-0.00660336051), constant<R>(0.08199107071),
                         constant<R>(0.9798209055),    constant<R>(-0.2852234303),  constant<R>(0.1588897004),
                         constant<R>(-0.0604352109),   constant<R>(0.01065431638)};
        const R s = code + constant<R>(0.055), sum = polynomial(sqrt(s), fit);
        return select(code <= constant<R>(0.04045), code * constant<R>(1 / 12.92), sum * s);
    }
}
// t^(1/3) for t in [0.008, 1], to 2e-8 before rounding: cbrtPositive() with one step of third order for two of second,
// 10 % to 5e-5 by a fit of h^(-1/3). Some finite number for smaller t.
template <class R>
AA_INLINE R rootOfLight(R t) {
    if constexpr (std::is_same_v<Elem<R>, double>)
        return cbrtPositive(max(t, constant<R>(1e-6)));
    else {
        R r = bitsScaled(t, -1.0f / 3.0f, 1419897600.0f);
        const R h = t * (r * r) * r;
        r = r * ((h * constant<R>(0.22413055) - constant<R>(0.78295019)) * h + constant<R>(1.55881644));
        const R root = t * (r * r);
        return root - (root * root * root - t) * (r * r) * constant<R>(1.0 / 3);
    }
}
template <class R>
AA_INLINE R labCurve(R t) {
    return select(t > constant<R>(216.0 / 24389), rootOfLight(t), t * constant<R>(841.0 / 108) + constant<R>(4.0 / 29));
}
// Filtered opponent colour -> XYZ over the white point of what a display can show.
template <class R>
AA_INLINE vec3<R> shown(vec3<R> o) {
    const auto channel = [&](int i) __attribute__((always_inline)) {
        const double(&m)[3] = kOpponentToRgb.m[i];  // m[0] is 1
        return o.x + o.y * constant<R>(m[1]) + o.z * constant<R>(m[2]);
    };
    return transform(kToXyz, saturate(vec3<R>(channel(0), channel(1), channel(2))));
}
// Its labCurve() -> CIELab with Hunt's adjustment: chroma fades with lightness.
template <class R>
AA_INLINE vec3<R> huntLab(vec3<R> f) {
    const R lightness = f.y * constant<R>(116) - constant<R>(16), hunt = lightness * constant<R>(0.01);
    return {lightness, hunt * (f.x - f.y) * constant<R>(500), hunt * (f.y - f.z) * constant<R>(200)};
}

template <class T, class F>
struct alignas(64) OpponentRow {
    T c[3][kLoaded<F>];
};
// What the pass along y leaves of kTile rows of a chunk, and of its margins: one column after the other.
enum Filtered { csfY, csfCx, csfCzWide, csfCzNarrow, gaussOfY, edgeOfY, pointOfY, kFiltered };
template <class T, class F>
struct alignas(64) FilteredColumns {
    T of[kFiltered][(kChunk + 2 * kMargin<F>)*kTile];
    // The last columns become the first: the margins of the next chunk's begin.
    AA_INLINE void goOn() {
        constexpr int kept = 2 * kMargin<F> * kTile;
        for (auto& kind : of)
            for (int i = 0; i < kept; i++) kind[i] = kind[kChunk * kTile + i];
    }
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
              begin = x0 ? -margin : 0, readTo = (end + N<R> - 1) / N<R> * N<R> + margin;
    // The last lanes may lie beyond the image, in its padding. A loop for each channel: see seeColours().
    for (int c = 0; c < 3; c++) {
        const float* const in = image.c[c] + row;
        for (int x = begin; x < end; x += N<R>) {
            const R v = max(constant<R>(0), load<R>(in + x));  // NaN becomes 0
            store(a.encoded ? light(min(v, constant<R>(1))) : v, out.c[c] + margin + x);
        }
    }
    for (int x = margin + begin; x < margin + end; x += N<R>) {
        const vec3<R> c = transform(
            kToOpponent.m, vec3<R>(loadOwn<R>(out.c[0] + x), loadOwn<R>(out.c[1] + x), loadOwn<R>(out.c[2] + x)));
        store(c.x, out.c[0] + x), store(c.y, out.c[1] + x), store(c.z, out.c[2] + x);
    }
    for (auto& c : out.c) {
        for (int x = -margin; x < 0 && x0 == 0; x++) c[margin + x] = c[margin];
        for (int x = end; x < readTo && x < kStrip + margin; x++) c[margin + x] = c[margin + end - 1];
    }
}
// Columns x .. x + N<R> - 1 of the strip, kTile rows, to `place` of `out`; `rows`: those under the windows.
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
    const auto keep = [&](Filtered kind, int k, Two<R> two) __attribute__((always_inline)) {
        found[kind][k] = two.first, found[kind][k + 1] = two.second;
    };
    using Along = Outward<R, decltype(around(0))>;
    Two<R> base;
    for (int k = 0; k < kTile; k += 2) {
        if (k % F::kSharing == 0) {  // see Features
            load(0);
            base.first = base.second = in[f.csfReach + k];
            for (int j = 0; j < window; j++) in[j] = in[j] - base.first;
        }
        Along y(around(k));
        const Two<R> centre = y.centre();
        Two<R> csf = centre * f.csfY[0] + base, gauss = centre * f.gauss[0] + base;
        Features<R> features(f, centre);
        const int reach = f.narrowReach < f.featureReach ? f.featureReach : f.narrowReach;
#pragma GCC unroll 10
        for (int i = 1; i <= reach; i++) {
            y.step(i);
            if (i <= f.narrowReach) csf = csf + y.sum() * f.csfY[i];
            if (i <= f.featureReach) gauss = gauss + y.sum() * f.gauss[i], features.add(f, y, i);
            inTurn(csf), inTurn(gauss);
        }
        keep(csfY, k, csf), keep(gaussOfY, k, gauss), keep(edgeOfY, k, features.edge);
        keep(pointOfY, k, features.point);
    }
    load(1);
    for (int k = 0; k < kTile; k += 4) {
        const Quad<R> csf = even<R>(around(k), f.csfCx, f.narrowReach);
        for (int i = 0; i < 4; i++) found[csfCx][k + i] = csf.of[i];
    }
    load(2);
    for (int k = 0; k < kTile; k += 2) {
        Along cz(around(k));
        Two<R> wide = cz.centre() * f.csfCzWide[0], narrow = cz.centre() * f.csfCzNarrow[0];
#pragma GCC unroll 10
        for (int i = 1; i <= f.csfReach; i++) {
            cz.step(i);
            wide = wide + cz.sum() * f.csfCzWide[i], narrow = narrow + cz.sum() * f.csfCzNarrow[i];
            inTurn(wide), inTurn(narrow);
        }
        keep(csfCzWide, k, wide), keep(csfCzNarrow, k, narrow);
    }
    for (int i = 0; i < kFiltered; i++) storeTransposed(found[i], out.of[i] + place * kTile);
}
template <class R>
AA_INLINE Quad<R> lengths(const R* x, const Quad<R>& y) {
    Quad<R> r;
    for (int i = 0; i < 4; i++) r.of[i] = sqrt(x[i] * x[i] + y.of[i] * y.of[i]);
    return r;
}
// kTile columns; `place`: of the first, and the row, in `out`. Colour stays opponent colour.
template <class R, class F>
AA_INLINE void filterAlongX(const F& f, const FilteredColumns<Elem<R>, F>& in, int place, SeenColumns<Elem<R>>& out) {
    const auto of = [&](Filtered kind, int k) __attribute__((always_inline)) {
        return [p = in.of[kind] + (kMargin<F> + k) * kTile + place](int i) __attribute__((always_inline)) {
            return loadOwn<R>(p + i * kTile);
        };
    };
    const auto put = [&](Seen kind, int k, const Quad<R>& value) __attribute__((always_inline)) {
        for (int i = 0; i < 4; i++) store(value.of[i], out.of[kind] + place + (k + i) * kTile);
    };
    R gauss[kWindow<F>], edge[kTile], point[kTile];
    for (int k = 0; k < kTile; k += 2) {
        if (k % F::kSharing == 0) {  // see Features
            const auto gaussOf = of(gaussOfY, 0);
            const R base = gaussOf(k);
            for (int i = 0; i < kTile + 2 * f.featureReach; i++) gauss[i] = gaussOf(i - f.featureReach) - base;
        }
        const auto at = [p = gauss + f.featureReach + k](int i) __attribute__((always_inline)) { return p[i]; };
        Outward<R, decltype(at)> outward(at);
        Features<R> x(f, outward.centre());
#pragma GCC unroll 10
        for (int i = 1; i <= f.featureReach; i++) outward.step(i), x.add(f, outward, i);
        edge[k] = x.edge.first, edge[k + 1] = x.edge.second;
        point[k] = x.point.first, point[k + 1] = x.point.second;
    }
    for (int k = 0; k < kTile; k += 4) {
        const auto along = [&](Filtered kind, const double* taps, int reach) __attribute__((always_inline)) {
            return even<R>(of(kind, k), taps, reach);
        };
        put(hueB, k, along(csfCzWide, f.czWideAlongX, f.csfReach) + along(csfCzNarrow, f.czNarrowAlongX, f.csfReach));
        put(lightness, k, along(csfY, f.csfY, f.narrowReach));
        put(hueA, k, along(csfCx, f.csfCx, f.narrowReach));
        put(edgeStrength, k, lengths(edge + k, along(edgeOfY, f.gauss, f.featureReach)));
        put(pointStrength, k, lengths(point + k, along(pointOfY, f.gauss, f.featureReach)));
    }
}
// Opponent colour -> CIELab. Roots and powers are long chains, of which a processor must have many pixels' in sight to
// be busy, so they have loops of their own here and in judge().
template <class R>
AA_INLINE void seeColours(SeenColumns<Elem<R>>& seen, int begin, int end) {
    Elem<R>*const x = seen.of[lightness], *const y = seen.of[hueA], *const z = seen.of[hueB];
    const auto each = [&](const auto& change) __attribute__((always_inline)) {
        for (int i = begin; i < end; i += N<R>) {
            const vec3<R> c = change(vec3<R>(loadOwn<R>(x + i), loadOwn<R>(y + i), loadOwn<R>(z + i)));
            store(c.x, x + i), store(c.y, y + i), store(c.z, z + i);
        }
    };
    each([](vec3<R> c) __attribute__((always_inline)) { return shown(c); });
    for (int k = 0; k < 3; k++)
        for (int i = begin; i < end; i += N<R>) store(labCurve(loadOwn<R>(seen.of[k] + i)), seen.of[k] + i);
    each([](vec3<R> c) __attribute__((always_inline)) { return huntLab(c); });
}
// HyAB distance to the power 0.7, mapped so that 0.4 of the largest becomes 0.95; and all of it to `power`. Below that
// knee the map is a product, so that one logarithm and one exponential serve both powers.
template <class R>
AA_INLINE R poweredDifference(R hyab, R power) {
    constexpr double knee = 0.4 * kMaxColour;
    const R log = constant<R>(0.7) * log2Positive(max(hyab, constant<R>(1e-30)));
    R logOfMapped = log + constant<R>(-4.119307189222026);
    const auto above = log > constant<R>(4.045306607778249);
    if (maskBits<R>(above)) {
        const R mapped =
            constant<R>(0.95) + (exp2Clamped(log) - constant<R>(knee)) * constant<R>(0.05 / (kMaxColour - knee));
        logOfMapped = select(above, log2Positive(mapped), logOfMapped);
    }
    return select(hyab < constant<R>(1e-30), constant<R>(0), exp2Clamped(power * logOfMapped));
}
// FLIP of places [begin, end), over the test's lightness.
template <class R>
AA_INLINE void judge(SeenColumns<Elem<R>>& test, const SeenColumns<Elem<R>>& reference, int begin, int end) {
    Elem<R>* const out = test.of[lightness];
    const auto difference = [&](Seen kind, int i) __attribute__((always_inline)) {
        return loadOwn<R>(test.of[kind] + i) - loadOwn<R>(reference.of[kind] + i);
    };
    for (int i = begin; i < end; i += N<R>) {
        const R a = difference(hueA, i), b = difference(hueB, i);
        const R hyab = abs(difference(lightness, i)) + sqrt(a * a + b * b);
        const R strongest = max(abs(difference(edgeStrength, i)), abs(difference(pointStrength, i)));
        const R feature = sqrt(strongest * constant<R>(0.70710678118654752));  // 1 / sqrt(2)
        store(min(poweredDifference(hyab, constant<R>(1) - feature), constant<R>(1)), out + i);
    }
}
// The next tile's rows at column x, while there is much to compute: no processor foresees jumps from row to row.
AA_INLINE void askForRows(const FlipArgs& a, int x, int y) {
    for (int c = 0; c < 3; c++)
        for (int row = y < 0 ? 0 : y; row < y + kTile && row < a.height; row++)
            __builtin_prefetch(a.image.c[c] + row * long(a.stride) + x);
}
// Sums, and the map, of rows y .. y + N<R> - 1 of a strip at column x0, of which rows [y0, y1) count.
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
    const int columns = a.width - x0 < kStrip ? a.width - x0 : kStrip, chunks = (a.width + kChunk - 1) / kChunk;
    int loaded = y0 - f.csfReach;
    for (int y = y0; y < y1; y += kTile) {
        for (; loaded < y + kTile + f.csfReach; loaded++)
            loadOpponent<R, F>(a.image, a, x0, loaded, kept[unsigned(loaded) % kKept<F>]);
        for (int j = 0; j < kTile + 2 * f.csfReach; j++) rows[j] = &kept[unsigned(y - f.csfReach + j) % kKept<F>];
        for (int from = 0, x = -kMargin<F>; from < columns; from += kChunk) {
            const int here = columns - from < kChunk ? columns - from : kChunk;
            const int places = (here + kTile - 1) / kTile * kTile * kTile;
            if (from > 0) filtered.goOn();
            const long block = long(y / kTile) * chunks + (x0 + from) / kChunk;
            for (; x < from + here + kMargin<F>; x += N<R>) {
                if (x % 16 == 0) askForRows(a, x0 + x, loaded);
                filterAlongY<R, F>(f, rows, x, x - from + kMargin<F>, filtered);
            }
            Block& seen = kJudges ? ofTest : static_cast<Block*>(a.seen)[block];
            const Block* const truth = kJudges ? static_cast<const Block*>(a.reference) + block : nullptr;
            for (int begin = 0; begin < places; begin += kAtOnce) {
                const int end = begin + kAtOnce < places ? begin + kAtOnce : places;
                if constexpr (kJudges)
                    for (const auto& kind : truth->of)
                        for (int i = begin; i < end; i += 16) __builtin_prefetch(kind + i);
                for (int i = begin; i < end; i += kTile * kTile)
                    for (int row = 0; row < kTile; row += N<R>) filterAlongX<R, F>(f, filtered, i + row, seen);
                seeColours<R>(seen, begin, end);
                if constexpr (kJudges) judge<R>(seen, *truth, begin, end);
            }
            if constexpr (kJudges)
                for (int row = 0; row < kTile; row += N<R>)
                    sum<R>(a, seen.of[lightness] + row, x0 + from, here, y + row, y0, y1);
        }
    }
}
template <class R, bool kJudges, class F>
AA_INLINE void flipStrips(const F& f, const FlipArgs& a, int block0, int block1) {
    const int y0 = block0 * kTile, y1 = block1 * kTile < a.height ? block1 * kTile : a.height;
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
