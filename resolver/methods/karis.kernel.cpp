#include "kernels/pq.h"
#include "methods/karis_kernels.h"
#include "methods/temporal_blocks.kernel.h"

namespace AA_ARCH {

template <class R>
AA_INLINE R toneWeight(R y, bool hdr4) {
    using T = Elem<R>;
    const R zero(T(0)), one(T(1)), four(T(4));
    return hdr4 ? four / (four + max(zero, y)) : one / (one + max(zero, y));
}
// Public UE4: the speed raises the current weight to 0.2; nearly equal luminance takes the current colour.
template <class R>
AA_INLINE R karisWeight(R alpha, Motion<R> motion, R lumaCurrent, R lumaHistory) {
    using T = Elem<R>;
    const R speed = sqrt(motion.x * motion.x + motion.y * motion.y);
    const R moving = mix(alpha, R(T(0.2)), saturate(speed * R(T(1) / T(40))));
    return max(moving, saturate(lumaHistory * R(T(0.01)) / max(abs(lumaCurrent - lumaHistory), R(T(1e-4)))));
}
// Falcor: less of the current colour where history lies near the end of a wide box.
template <class R>
AA_INLINE R falcorWeight(R alpha, R low, R high, R lumaHistory) {
    using T = Elem<R>;
    const R toClamp = min(abs(low - lumaHistory), abs(high - lumaHistory)), sum = toClamp + (high - low);
    const auto flat = sum <= R(T(1e-12));
    return select(flat, alpha, saturate(alpha * toClamp / select(flat, R(T(1)), sum)));
}

// The colours of a block of rows and columns with one pixel around it, in the box's space, and their weights in the
// filter: what all nine neighbours of a pixel would compute again is computed once, into a buffer of the cache's size.
template <class T>
struct KarisTile {
    static constexpr int kWidth = 128, kHeight = 8, kMargin = 16, kStride = kWidth + 2 * kMargin;
    alignas(64) T c[3][(kHeight + 2) * kStride], weight[(kHeight + 2) * kStride];
    int x0, y0;
    AA_INLINE int offset(int x, int y) const { return (y - y0 + 1) * kStride + x - x0 + kMargin; }
};
template <class R>
AA_INLINE void fillTile(const KarisArgs& a, bool ycocg, bool filtered, KarisTile<Elem<R>>& tile, int x0, int x1, int y0,
                        int y1) {
    tile.x0 = x0, tile.y0 = y0;
    for (int y = y0 - 1; y <= y1; y++)
        for (int x = x0 - N<R>; x < x1 + N<R>; x += N<R>) {
            const vec3<R> rgb = load3<R>(a.in.color.c, long(y) * a.in.stride + x), c = ycocg ? to_ycocg(rgb) : rgb;
            const int t = tile.offset(x, y);
            store(c.x, tile.c[0] + t), store(c.y, tile.c[1] + t), store(c.z, tile.c[2] + t);
            const R one(Elem<R>(1));
            if (filtered) store(a.toneWeighted ? toneWeight(ycocg ? c.x : luma709(c), a.hdr4) : one, tile.weight + t);
        }
}
template <class R>
AA_INLINE R load_own(const Elem<R>* p) {  // storage and arithmetic of one type
    if constexpr (N<R> == 1)
        return *p;
    else
        return load<R>(p);
}

template <class R, class YCoCg>
AA_INLINE void karisPixel(const KarisArgs& a, YCoCg ycocg, const KarisTile<Elem<R>>& tile, int x, int y) {
    const bool filtered = a.filtered, spread = a.box != BoxKind::minmax;
    using T = Elem<R>;
    using Tile = KarisTile<T>;
    const TemporalIn& in = a.in;
    const R zero(T(0)), one(T(1));
    const long o = long(y) * in.stride + x;
    const int t0 = tile.offset(x, y);
    const auto at = [&](int i, int j) __attribute__((always_inline)) {
        const int t = t0 + j * Tile::kStride + i;
        return vec3<R>{load_own<R>(tile.c[0] + t), load_own<R>(tile.c[1] + t), load_own<R>(tile.c[2] + t)};
    };
    const auto luma = [&](vec3<R> c) __attribute__((always_inline)) { return ycocg ? c.x : luma709(c); };
    const vec3<R> centre = at(0, 0);

    // 1. filtered current colour and moments, as deviations from the centre: a constant stays exactly itself
    const auto filterWeight = [&](int i, int j) __attribute__((always_inline)) {
        return R(T(a.filter[(j + 1) * 3 + i + 1])) * load_own<R>(tile.weight + t0 + j * Tile::kStride + i);
    };
    vec3<R> sum(zero);
    R weights(zero);
    Moments<R> m{centre, centre};
    const auto filter = [&](int i, int j, vec3<R> d) __attribute__((always_inline)) {
        const R w = filterWeight(i, j);
        sum = sum + d * w, weights = weights + w;
    };
    if (spread && filtered)
        m = moments<R>(at, filter);
    else if (spread)
        m = moments<R>(at);
    else if (filtered)
        for (int j = -1; j <= 1; j++)
            for (int i = -1; i <= 1; i++)
                if (i || j) filter(i, j, at(i, j) - centre);
    const vec3<R> current = filtered ? centre + sum * (one / max(weights + filterWeight(0, 0), R(T(1e-20)))) : centre;

    // 2. box
    Box<R> box;
    if (spread) box = variance_box(m, a.gamma);
    if (!spread || a.box == BoxKind::intersection) {
        const Box<R> bounds = box_of(neighbours<R>(at), a.neighbourhood);
        box = spread ? Box<R>{max(box.lo, bounds.lo), min(box.hi, bounds.hi)} : bounds;
    }
    box.lo = min(box.lo, box.hi);

    // 3. history
    const Motion<R> motion = dilated_motion<R>(in, o);
    const Reprojection<R> q = reproject(in, motion, x, y);
    const vec3<R> past = fetch_history(in, x, y, q);
    const vec3<R> history = ycocg ? to_ycocg(past) : past;
    const vec3<R> held =
        a.constraint == HistoryConstraint::clamp
            ? clamp3(history, box.lo, box.hi)
            : clip_toward(box, a.constraint == HistoryConstraint::clipMean ? m.mean : current, history);

    // 4. weight of the current colour
    R alpha(T(a.alpha));
    if (a.antiFlicker == AntiFlicker::karis) alpha = karisWeight(alpha, motion, luma(current), luma(held));
    if (a.antiFlicker == AntiFlicker::falcor) alpha = falcorWeight(alpha, luma(box.lo), luma(box.hi), luma(history));
    const R k = min(one - alpha, R(T(in.feedbackCeiling)));

    // 5. blend
    const vec3<R> mixed = a.inverseLuminance ? inverse_luminance_blend(current, luma(current), held, luma(held), k)
                                             : blend(current, held, k);
    const auto toRgb = [&](vec3<R> c) __attribute__((always_inline)) {
        return max(ycocg ? from_ycocg(c) : c, vec3<R>(zero));
    };
    const vec3<R> raw = load3<R>(in.color.c, o);
    const vec3<R> result = select(q.inside, toRgb(mixed), filtered ? toRgb(current) : raw);
    store_blend(in, x, y, sanitised(result, raw, past), one);
    store_debug(in.debug, o, motion, q.inside, box, held - history, k);
}
template <class R>
__attribute__((flatten)) void karisRows(const KarisArgs& a, int y0, int y1) {
    if (!a.in.history) {
        for (int y = y0; y < y1; y++)
            for (int x = 0; x < a.in.width; x += N<R>) store_first<R>(a.in, x, y);
        return;
    }
    using Tile = KarisTile<Elem<R>>;
    Tile tile;
    const auto tiles = [&](auto ycocg) __attribute__((always_inline)) {
        for (int top = y0; top < y1; top += Tile::kHeight) {
            const int bottom = top + Tile::kHeight < y1 ? top + Tile::kHeight : y1;
            for (int left = 0; left < a.in.width; left += Tile::kWidth) {
                const int right = left + Tile::kWidth < a.in.width ? left + Tile::kWidth : a.in.width;
                fillTile<R>(a, ycocg, a.filtered, tile, left, right, top, bottom);
                for (int y = top; y < bottom; y++)
                    for (int x = left; x < right; x += N<R>) karisPixel<R>(a, ycocg, tile, x, y);
            }
        }
    };
    with_options<R>(tiles, a.ycocg);
}

template <class R>
__attribute__((flatten)) void pqEncodeRows(const PqArgs& a, int y0, int y1) {
    const PqTables& t = *a.tables;
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            const vec3<R> c = load3<R>(a.in.c, o);
            store3(vec3<R>{pq_encode(t, c.x), pq_encode(t, c.y), pq_encode(t, c.z)}, a.out.c, o);
        }
}
template <class R>
__attribute__((flatten)) void pqDecodeRows(const PqArgs& a, int y0, int y1) {
    const PqTables& t = *a.tables;
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            const vec3<R> c = load3<R>(a.in.c, o);
            store3(vec3<R>{pq_decode(t, c.x), pq_decode(t, c.y), pq_decode(t, c.z)}, a.out.c, o);
        }
}

void fillPqTables(PqTables& t) { fill_tables(t); }

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::KarisKernels, karisKernels) = {AA_WIDE_ROWS(karisRows), AA_WIDE_ROWS(pqEncodeRows),
                                                   AA_WIDE_ROWS(pqDecodeRows), fillPqTables};
