#include "methods/spatial/cmaa2.h"

#include "kernels/sparse.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
AA_INLINE R rightStep(const float* l) {
    return abs(load<R>(l) - load<R>(l + 1));
}
template <class R>
AA_INLINE R bottomStep(const float* l, long s) {
    return abs(load<R>(l) - load<R>(l + s));
}
template <class R>
__attribute__((flatten)) void cmaa2EdgeRows(const Cmaa2EdgeArgs& a, int y0, int y1) {
    const R threshold(Elem<R>(a.threshold)), contrast(Elem<R>(a.localContrast));
    const long s = a.stride;
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const float* const l = a.luma + long(y) * s + x;
            uint8_t* const edges = a.edges + long(y) * a.edgeStride + x;
            const R right = rightStep<R>(l), bottom = bottomStep<R>(l, s);
            if (!maskBits<R>(either(right > threshold, bottom > threshold))) {
                __builtin_memset(edges, 0, N<R>);
                continue;
            }
            // The four edges that meet it at its ends.
            const R besideRight =
                max(max(bottomStep<R>(l - s, s), bottom), max(bottomStep<R>(l + 1 - s, s), bottomStep<R>(l + 1, s)));
            const R besideBottom =
                max(max(rightStep<R>(l - 1), right), max(rightStep<R>(l + s - 1), rightStep<R>(l + s)));
            storeMaskBytes<R>(right - contrast * besideRight > threshold, bottom - contrast * besideBottom > threshold,
                              edges);
        }
}
template <class R>
void cmaa2JoinRows(const Cmaa2JoinArgs& a, int y0, int y1) {
    constexpr uint64_t every = 0x0101010101010101ull;
    for (int y = y0; y < y1; y++) {
        const uint8_t* const row = a.edges + long(y) * a.edgeStride;
        uint8_t* const all = a.all + long(y) * a.edgeStride;
        for (int x = 0; x < a.width; x += 8) {
            uint64_t bits = loadBytes(row + x) | (loadBytes(row + x - 1) & every * kCmaaRight) << 2 |
                            (loadBytes(row + x - a.edgeStride) & every * kCmaaBottom) << 2;
            if (a.width - x < 8) bits &= (uint64_t(1) << 8 * (a.width - x)) - 1;
            __builtin_memcpy(all + x, &bits, 8);
        }
    }
}

// The edges of a pixel as numbers.
template <class T>
struct EdgesOf {
    T right, bottom, left, top;
};
template <class T>
AA_INLINE EdgesOf<T> edgesOf(uint8_t e) {
    return {T(e & 1), T(e >> 1 & 1), T(e >> 2 & 1), T(e >> 3 & 1)};
}
// Turned by 90 degrees so that what pointed up points right: a vertical line becomes a horizontal one.
template <class T>
AA_INLINE EdgesOf<T> turned(EdgesOf<T> e) {
    return {e.top, e.right, e.bottom, e.left};
}
AA_INLINE bool hasCorner(uint8_t e) {
    const unsigned next = (unsigned(e) << 1 | unsigned(e) >> 3) & 15u;
    return (e & next) != 0;
}

// ---- the blur of every candidate

template <class T>
AA_INLINE void addResult(const Cmaa2BlendArgs& a, long o, uint16_t* stored, const T c[3], T weight, uint16_t code) {
    const bool first = *stored == 0;
    for (int k = 0; k < 3; k++) {
        float* const p = a.out.c[k] + o;
        *p = float(first ? weight * c[k] : T(*p) + weight * c[k]);
    }
    *stored = uint16_t(*stored + code);
}
template <class T>
AA_INLINE void blurCandidate(const Cmaa2BlendArgs& a, const uint8_t* e, long o, uint16_t* stored) {
    const long s = a.edgeStride;
    const EdgesOf<T> own = edgesOf<T>(e[0]), l = edgesOf<T>(e[-1]), r = edgesOf<T>(e[1]), t = edgesOf<T>(e[-s]),
                     b = edgesOf<T>(e[s]);
    T right = own.right, below = own.bottom, left = own.left, above = own.top, strength = T(a.simpleBlur);
    const T one(1), k(0.9);                                     // CMAA2 v2.3
    if (own.right + own.bottom + own.left + own.top == T(2)) {  // an L: its arms pull
        strength = strength * T(0.75);
        right = right + k * (own.bottom * t.right * (one - l.bottom) + own.top * b.right * (one - l.top));
        below = below + k * (own.left * r.bottom * (one - t.left) + own.right * l.bottom * (one - t.right));
        left = left + k * (own.top * b.left * (one - r.top) + own.bottom * t.left * (one - r.bottom));
        above = above + k * (own.right * l.top * (one - b.right) + own.left * r.top * (one - b.left));
    }
    // Where edges crowd there is text or texture to be kept.
    const T around = (l.bottom + l.left + l.top) + (r.right + r.bottom + r.top) + (t.top + t.right + t.left) +
                     (b.right + b.bottom + b.left);
    strength = strength * saturate(T(a.fadeFrom) - around * T(a.fadePerEdge));
    const T wr = right * strength, wb = below * strength, wl = left * strength, wt = above * strength;
    T c[3];
    for (int i = 0; i < 3; i++) {
        const float* const p = a.in.c[i] + o;
        const T centre = p[0];
        c[i] = centre + (wr * (T(p[1]) - centre) + wl * (T(p[-1]) - centre)) +
               (wb * (T(p[a.stride]) - centre) + wt * (T(p[-a.stride]) - centre));
    }
    addResult(a, o, stored, c, T(0.8), kCmaaBlurred);  // CMAA2 v2.3: 0.8 for a blur, 1.8 for a line
    if (a.blur) a.blur[o] = float(wr + wb + wl + wt);
}

// ---- Z shapes: the line steps from one side of a pixel to the other

struct ZShape {
    bool found, horizontal, inverted;
    int quality;      // 0 best to 3
    int left, right;  // lengths of the arms, px
};
struct ZScore {
    double inverted, normal;
};
// `own` is the pixel left of the step; m1, p1 and p2 lie -1, +1 and +2 px along the line.
AA_INLINE ZScore zScore(EdgesOf<double> own, EdgesOf<double> m1, EdgesOf<double> p1, EdgesOf<double> p2) {
    return {own.right * own.bottom * p1.top *
                (2 + (m1.bottom + p2.top) - (own.top + p1.bottom) - 0.7 * (p2.bottom + m1.top + own.left + p1.right)),
            own.right * own.top * p1.bottom *
                (2 + (m1.top + p2.bottom) - (own.bottom + p1.top) - 0.7 * (p2.top + m1.bottom + own.left + p1.right))};
}
AA_INLINE ZShape zShape(const Cmaa2BlendArgs& a, const uint8_t* e) {
    const long s = a.edgeStride;
    ZShape z{false, true, false, 0, 1, 1};
    double best = 0;
    if (e[0] & kCmaaRight) {
        const ZScore score =
            zScore(edgesOf<double>(e[0]), edgesOf<double>(e[-1]), edgesOf<double>(e[1]), edgesOf<double>(e[2]));
        best = max(score.inverted, score.normal);
        z.inverted = score.inverted > score.normal;
    }
    if (e[0] & kCmaaTop) {
        const ZScore score = zScore(turned(edgesOf<double>(e[0])), turned(edgesOf<double>(e[s])),
                                    turned(edgesOf<double>(e[-s])), turned(edgesOf<double>(e[-2 * s])));
        const double vertical = max(score.inverted, score.normal);
        if (vertical > best) {
            best = vertical;
            z.horizontal = false;
            z.inverted = score.inverted > score.normal;
        }
    }
    if (!(best > 0)) return z;
    z.quality = int(clamp(4 - best, 0.0, 3.0));
    const long step = z.horizontal ? 1 : -s;
    uint8_t traceLeft = z.horizontal ? kCmaaTop : kCmaaLeft, traceRight = z.horizontal ? kCmaaBottom : kCmaaRight;
    if (z.inverted) {
        const uint8_t swapped = traceLeft;
        traceLeft = traceRight;
        traceRight = swapped;
    }
    bool goLeft = true, goRight = true;
    while (goLeft || goRight) {
        goLeft = goLeft && (e[-step * z.left] & traceLeft);
        goRight = goRight && (e[step * (z.right + 1)] & traceRight);
        z.left += goLeft;
        z.right += goRight;
        const int longer = z.left > z.right ? z.left : z.right, shorter = z.left < z.right ? z.left : z.right;
        // The arms must be about equally long: the search ends at 1.25 * shorter - 0.25.
        if (longer >= a.longestPx || 4 * longer >= 5 * shorter - 1) break;
    }
    z.left -= z.quality;
    z.right -= z.quality;
    z.found = z.left + z.right >= 5;
    return z;
}
template <class T>
AA_INLINE void blendLine(const Cmaa2BlendArgs& a, const ZShape& z, long o, uint16_t* stored) {
    const long along = z.horizontal ? 1 : -long(a.stride), storedAlong = z.horizontal ? 1 : -long(a.width);
    const long toward = (z.horizontal ? -long(a.stride) : -1) * (z.inverted ? -1 : 1);
    const int from = 1 - (z.left + 1) / 2, to = (z.right + 1) / 2;
    const T leftOdd = T(a.symmetryCorrection) * T(z.left & 1), rightOdd = T(a.symmetryCorrection) * T(z.right & 1);
    const T step = T(1) / (T(to - from + 1) - leftOdd - rightOdd), start = (T(0.5) - leftOdd - T(from)) * step;
    const T damping = saturate(T(z.left + z.right - z.quality) * T(a.dampening));
    for (int i = from; i <= to; i++) {
        const T ramp = step * T(i) + start, share = (i > 0 ? T(1) - ramp : ramp) * damping;
        const long p = o + along * i, q = p + (i > 0 ? -toward : toward);
        T c[3];
        for (int k = 0; k < 3; k++) c[k] = mix(T(a.in.c[k][p]), T(a.in.c[k][q]), share);
        addResult(a, p, stored + storedAlong * i, c, T(1.8), 1);
    }
}

template <class R>
__attribute__((flatten)) void cmaa2BlendRows(const Cmaa2BlendArgs& a, int y0, int y1) {
    using T = Elem<R>;
    for (int y = y0; y < y1; y++) {
        const long row = long(y) * a.stride;
        for (int c = 0; c < 3; c++)
            for (int x = 0; x < a.width; x += N<R>) store(load<R>(a.in.c[c] + row + x), a.out.c[c] + row + x);
        const uint8_t* const edges = a.edges + long(y) * a.edgeStride;
        uint16_t *const stored = a.stored + long(y) * a.width, *const verticals = a.verticals + long(y) * a.width;
        __builtin_memset(stored, 0, sizeof(uint16_t) * size_t(a.width));
        int vertical = 0;
        const auto candidates = [&](const auto& visit) __attribute__((always_inline)) {
            for (int x0 = 0; x0 < a.width; x0 += 8)
                forEachByte(
                    loadBytes(edges + x0), [&](int i) __attribute__((always_inline)) {
                        const int x = x0 + i;
                        if (x < a.width && hasCorner(edges[x])) visit(x);
                    });
        };
        candidates([&](int x) __attribute__((always_inline)) { blurCandidate<T>(a, edges + x, row + x, stored + x); });
        candidates([&](int x) __attribute__((always_inline)) {
            const ZShape z = zShape(a, edges + x);
            if (!z.found) return;
            if (z.horizontal)
                blendLine<T>(a, z, row + x, stored + x);
            else
                verticals[vertical++] = uint16_t(x);
            if (a.shape) {
                a.shape[row + x] = float((z.horizontal ? 1 : 3) + z.inverted);
                a.lengthLeft[row + x] = float(z.left);
                a.lengthRight[row + x] = float(z.right);
            }
        });
        a.verticalCount[y] = vertical;
    }
}
template <class R>
__attribute__((flatten)) void cmaa2BlendColumns(const Cmaa2BlendArgs& a, int x0, int x1) {
    for (int x = x0; x < x1; x++)
        for (int k = a.columnStart[x]; k < a.columnStart[x + 1]; k++) {
            const int y = a.columnRows[k];
            blendLine<Elem<R>>(a, zShape(a, a.edges + long(y) * a.edgeStride + x), long(y) * a.stride + x,
                               a.stored + long(y) * a.width + x);
        }
}
template <class R>
__attribute__((flatten)) void cmaa2NormaliseRows(const Cmaa2BlendArgs& a, int y0, int y1) {
    using T = Elem<R>;
    for (int y = y0; y < y1; y++) {
        const uint16_t* const stored = a.stored + long(y) * a.width;
        int x = 0;
        for (; x < a.width; x++) {
            uint64_t four = 1;
            if (x + 4 <= a.width) __builtin_memcpy(&four, stored + x, 8);
            if (!four) {
                x += 3;
                continue;
            }
            if (!stored[x]) continue;
            const T weight = (stored[x] & kCmaaBlurred ? T(0.8) : T(0)) + T(1.8) * T(stored[x] & ~kCmaaBlurred);
            for (int c = 0; c < 3; c++) {
                float* const p = a.out.c[c] + long(y) * a.stride + x;
                *p = float(T(*p) / weight);
            }
        }
    }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::Cmaa2Kernels, cmaa2Kernels) = {AA_ROWS(cmaa2EdgeRows), AA_ROWS(cmaa2JoinRows),
                                                   AA_ROWS(cmaa2BlendRows), AA_ROWS(cmaa2BlendColumns),
                                                   AA_ROWS(cmaa2NormaliseRows)};
