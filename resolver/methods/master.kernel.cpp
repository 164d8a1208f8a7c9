#include "methods/master_kernels.h"
#include "methods/master_terms.kernel.h"

// All steps on one tile after the other, so that what lies between them stays in the second-level cache. Every step
// needs a margin of the one before: three pixels of luminance for two of Sobel for one of its past.
namespace AA_ARCH {

template <class T>
struct MasterTile {
    static constexpr int kWidth = 256, kHeight = kMasterBlockRows, kMarginX = 16, kMarginY = 3,
                         kStride = kWidth + 2 * kMarginX, kSize = (kHeight + 2 * kMarginY) * kStride;
    alignas(64) T luminanceAlbedo[kSize], luminanceLit[kSize], sobel[kSize], filtered[kSize];
    alignas(64) T past[3][kSize], pastDepth[kSize];  // colour, and depth: NaN where history is outside
    int x0, x1, y0, y1, width, height;

    AA_INLINE int offset(int x, int y) const { return (y - y0 + kMarginY) * kStride + x - x0 + kMarginX; }
    template <class R>
    static AA_INLINE R get(const T* p) {
        if constexpr (N<R> == 1)
            return *p;
        else
            return load<R>(p);
    }
    // Calls pixels(x, y) for the tile and `margin` pixels around it, as far as they lie in the picture.
    template <class R, class Pixels>
    AA_INLINE void cover(int margin, const Pixels& pixels) {
        const int columns = (margin + N<R> - 1) / N<R> * N<R>;  // whole lanes
        const int left = x0 - columns > 0 ? x0 - columns : 0, right = x1 + margin < width ? x1 + margin : width;
        const int top = y0 - margin > 0 ? y0 - margin : 0, bottom = y1 + margin < height ? y1 + margin : height;
        for (int y = top; y < bottom; y++)
            for (int x = left; x < right; x += N<R>) pixels(x, y);
    }
    // Continues a plane `margin` pixels beyond the picture with its last value.
    AA_INLINE void continueBeyond(T* plane, int margin) {
        const int top = y0 - margin > 0 ? y0 - margin : 0, bottom = y1 + margin < height ? y1 + margin : height;
        for (int y = top; y < bottom; y++) {
            T* const row = plane + offset(0, y);
            for (int x = x0 - margin; x < 0; x++) row[x] = row[0];
            for (int x = width; x < x1 + margin; x++) row[x] = row[width - 1];
        }
        const auto copyRow = [&](int from, int to) __attribute__((always_inline)) {
            __builtin_memcpy(plane + offset(x0 - margin, to), plane + offset(x0 - margin, from),
                             size_t(x1 - x0 + 2 * margin) * sizeof(T));
        };
        for (int y = y0 - margin; y < 0; y++) copyRow(0, y);
        for (int y = height; y < y1 + margin; y++) copyRow(height - 1, y);
    }
};

// S: one Sobel value per pixel.
template <class R>
AA_INLINE void fill_luminance(const MasterArgs& a, MasterTile<Elem<R>>& tile, int x, int y) {
    const long o = long(y) * a.in.stride + x;
    const int t = tile.offset(x, y);
    store(luminance(load3<R>(a.albedoEncoded.c, o), a.bt601), tile.luminanceAlbedo + t);
    store(luminance(load3<R>(a.in.color.c, o), a.bt601), tile.luminanceLit + t);
}
template <class R>
AA_INLINE void fill_sobel(const MasterArgs& a, MasterTile<Elem<R>>& tile, int x, int y) {
    using T = Elem<R>;
    using Tile = MasterTile<T>;
    const R farDepth = R(T(a.farDepth));
    const long o = long(y) * a.in.stride + x;
    const int t = tile.offset(x, y);
    const auto window = [&](const T* plane) __attribute__((always_inline)) {
        return sobel_magnitude<R>([&](int i, int j) __attribute__((always_inline)) {
            return Tile::template get<R>(plane + t + j * Tile::kStride + i);
        });
    };
    const R depth = sobel_magnitude<R>([&](int i, int j) __attribute__((always_inline)) {
        return min(farDepth, load<R>(a.in.depthView + o + long(j) * a.in.stride + i));
    });
    const R sum = window(tile.luminanceAlbedo) * R(T(a.weightAlbedo)) + window(tile.luminanceLit) * R(T(a.weightLit)) +
                  depth * R(T(a.depthScale));
    store(sobel_curve(sum), tile.sobel + t);
}

// T: the Sobel value over time, and the past of colour and depth.
template <class R>
AA_INLINE void fill_past(const MasterArgs& a, MasterTile<Elem<R>>& tile, int x, int y) {
    using T = Elem<R>;
    using Tile = MasterTile<T>;
    const TemporalIn& in = a.in;
    const long o = long(y) * in.stride + x;
    const int t = tile.offset(x, y);
    const Motion<R> motion = dilated_motion<R>(in, o);
    const Reprojection<R> q = reproject(in, motion, x, y);
    const Texel<R> past = fetch_bilinear<R>(in.history + 4 * o, in.stride, q);

    const auto sobelAt = [&](int i, int j) __attribute__((always_inline)) {
        return Tile::template get<R>(tile.sobel + t + j * Tile::kStride + i);
    };
    const R now = sobelAt(0, 0);
    R filtered = now;
    if (a.temporalSobel) {
        const R plusLow = min(min(min(now, sobelAt(-1, 0)), min(sobelAt(1, 0), sobelAt(0, -1))), sobelAt(0, 1));
        const R plusHigh = max(max(max(now, sobelAt(-1, 0)), max(sobelAt(1, 0), sobelAt(0, -1))), sobelAt(0, 1));
        const R low = min(plusLow, min(min(sobelAt(-1, -1), sobelAt(1, -1)), min(sobelAt(-1, 1), sobelAt(1, 1))));
        const R high = max(plusHigh, max(max(sobelAt(-1, -1), sobelAt(1, -1)), max(sobelAt(-1, 1), sobelAt(1, 1))));
        const R half(T(0.5)), held = clamp(past.a, (low + plusLow) * half, (high + plusHigh) * half);
        const R k = min(luminance_feedback(now, held, a.kMin, a.kMax), R(T(in.feedbackCeiling)));
        filtered = select(q.inside, held + (now - held) * (R(T(1)) - k), now);
    }
    store(filtered, tile.filtered + t);

    alignas(64) int k[N<R>];
    nearest_offsets(q, in.stride, k);
    const R depth = a.samePixelDepth ? load<R>(a.previousDepth + o) : gather<R>(a.previousDepth + o, k);
    store(select(q.inside, depth, R(T(__builtin_nanf("")))), tile.pastDepth + t);
    const vec3<R> color = in.filter == HistoryFilter::bilinear ? past.rgb : fetch_history(in, x, y, q);
    store(color.x, tile.past[0] + t);
    store(color.y, tile.past[1] + t);
    store(color.z, tile.past[2] + t);
}

template <class R>
AA_INLINE void masterPixel(const MasterArgs& a, const MasterTile<Elem<R>>& tile, int x, int y) {
    using T = Elem<R>;
    using Tile = MasterTile<T>;
    const TemporalIn& in = a.in;
    const R zero(T(0)), one(T(1)), farDepth = R(T(a.farDepth));
    const long o = long(y) * in.stride + x;
    const int t = tile.offset(x, y);
    const auto at = [&](int i, int j) __attribute__((always_inline)) { return o + long(j) * in.stride + i; };
    const vec3<R> current = load3<R>(in.color.c, o);
    const vec3<R> history{Tile::template get<R>(tile.past[0] + t), Tile::template get<R>(tile.past[1] + t),
                          Tile::template get<R>(tile.past[2] + t)};
    const R pastDepth = Tile::template get<R>(tile.pastDepth + t);
    const auto inside = pastDepth == pastDepth;

    // How aliased is this pixel?
    R model(zero), sobel(zero);
    PseudoVariances<R> variance{zero, zero};
    if (a.useModel)
        model = model_average<R>([&](int i, int j) __attribute__((always_inline)) {
            return ids_differ<R>(a.objectId + at(i, j), a.objectId + o);
        });
    if (a.useDepth || a.useDepthTemporal) {
        const R depth = min(farDepth, load<R>(in.depthView + o));
        const DepthWindow<R> window = depth_window<R>([&](int i, int j) __attribute__((always_inline)) {
            return min(farDepth, load<R>(in.depthView + at(i, j)));
        });
        R past = min(farDepth, pastDepth) - depth;
        if (a.compensate) {
            const R expected = min(farDepth, expected_previous_depth(a.expected, load<R>(in.depthView + o), x, y));
            past = min(farDepth, pastDepth) - expected;
        }
        R threshold(T(a.depthThreshold));
        if (a.relativeThreshold) threshold = threshold * max(depth + window.mean, one);
        variance = pseudo_variances(window, past, threshold);
        if (!a.useDepth) variance.depth = zero;
        variance.depthTemporal = a.useDepthTemporal ? select(inside, variance.depthTemporal, one) : zero;
    }
    if (a.useSobel) {
        const auto s = [&](int i, int j) __attribute__((always_inline)) {
            return Tile::template get<R>(tile.filtered + t + j * Tile::kStride + i);
        };
        const R plus = s(0, 0) + ((s(-1, 0) + s(1, 0)) + (s(0, -1) + s(0, 1)));
        const R square = plus + ((s(-1, -1) + s(1, -1)) + (s(-1, 1) + s(1, 1)));
        sobel = mix(plus * R(T(1) / T(5)), square * R(T(1) / T(9)), saturate(model + s(0, 0)));  // eqs 4.12, 4.13
    }
    const R aliased = max(saturate(sobel + variance.depth + variance.depthTemporal + model), R(T(a.minAlias)));

    // The box: loose where aliased, the current colour alone where not (eqs 4.15, 4.16).
    const Neighbours<R> window =
        neighbours<R>([&](int i, int j) __attribute__((always_inline)) { return load3<R>(in.color.c, at(i, j)); });
    const vec3<R> low = mix(window.plus.lo, window.square.lo, aliased),
                  high = mix(window.plus.hi, window.square.hi, aliased),
                  mean = mix(window.meanPlus, window.meanSquare, aliased);
    const Box<R> box{mix(current, low, aliased), mix(current, high, aliased)};
    const vec3<R> clipped = constrain(box, a.clipTarget, mean, current, history);

    const R k = min(luminance_feedback(luma709(current), luma709(clipped), a.kMin, a.kMax), R(T(in.feedbackCeiling)));
    const vec3<R> mixed = select(inside, blend(current, clipped, k), current);

    store_blend(in, x, y, sanitised(mixed, current, history), Tile::template get<R>(tile.filtered + t));
    if (!in.debug.feedback) {
        store_debug(in.debug, o, Motion<R>{k, k}, inside, box, history, k);
    } else {
        store_debug(in.debug, o, dilated_motion<R>(in, o), inside, box, clipped - history, k);
        store(aliased, a.debugAliased + o), store(sobel, a.debugSobel + o), store(model, a.debugModel + o);
        store(variance.depth, a.debugDepth + o), store(variance.depthTemporal, a.debugDepthTemporal + o);
    }
}
template <class R>
AA_INLINE void masterTile(const MasterArgs& a, MasterTile<Elem<R>>& tile) {
    using T = Elem<R>;
    const int margin = a.in.history ? 2 : 0;
    if (a.useSobel) {
        tile.template cover<R>(
            margin + 1, [&](int x, int y) __attribute__((always_inline)) { fill_luminance<R>(a, tile, x, y); });
        tile.continueBeyond(tile.luminanceAlbedo, margin + 1);
        tile.continueBeyond(tile.luminanceLit, margin + 1);
        tile.template cover<R>(
            margin, [&](int x, int y) __attribute__((always_inline)) { fill_sobel<R>(a, tile, x, y); });
        tile.continueBeyond(tile.sobel, margin);
    } else {
        tile.template cover<R>(
            margin, [&](int x, int y)
                        __attribute__((always_inline)) { store(R(T(0)), tile.sobel + tile.offset(x, y)); });
        tile.continueBeyond(tile.sobel, margin);
    }
    if (a.in.history) {
        tile.template cover<R>(
            1, [&](int x, int y) __attribute__((always_inline)) { fill_past<R>(a, tile, x, y); });
        tile.continueBeyond(tile.filtered, 1);
    }
    tile.template cover<R>(
        0, [&](int x, int y) __attribute__((always_inline)) {
            if (a.in.history)
                masterPixel<R>(a, tile, x, y);
            else
                store_first<R>(a.in, x, y, MasterTile<T>::template get<R>(tile.sobel + tile.offset(x, y)));
            const long o = long(y) * a.in.stride + x;
            store(load<R>(a.in.depthView + o), a.keptDepth + o);
        });
}
template <class R>
__attribute__((flatten)) void masterBlocks(const MasterArgs& a, int b0, int b1) {
    using Tile = MasterTile<Elem<R>>;
    Tile tile;
    tile.width = a.in.width, tile.height = a.in.height;
    for (int b = b0; b < b1; b++) {
        tile.y0 = b * Tile::kHeight;
        tile.y1 = tile.y0 + Tile::kHeight < tile.height ? tile.y0 + Tile::kHeight : tile.height;
        for (tile.x0 = 0; tile.x0 < tile.width; tile.x0 += Tile::kWidth) {
            tile.x1 = tile.x0 + Tile::kWidth < tile.width ? tile.x0 + Tile::kWidth : tile.width;
            masterTile<R>(a, tile);
        }
    }
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::MasterKernels, masterKernels) = {AA_WIDE_ROWS(masterBlocks)};
