// The terms of aliasedValue as pure functions [Oliveros 2018, 4.3]; include from *.kernel.cpp only.
#pragma once
#include "methods/temporal/temporal_blocks.kernel.h"

namespace AA_ARCH {

// |G| of a 3x3 window, at(i, j); eqs 3.4-3.6 with factor 1.
template <class R, class At>
AA_INLINE R sobelMagnitude(const At& at) {
    const R a = at(-1, -1), b = at(0, -1), c = at(1, -1), d = at(-1, 0), f = at(1, 0), g = at(-1, 1), h = at(0, 1),
            i = at(1, 1);
    const R ca = c - a, ig = i - g, fd = f - d;
    const R gx = ca + ig + (fd + fd);
    const R ag = a - g, ci = c - i, bh = b - h;
    const R gy = ag + ci + (bh + bh);
    return sqrt(gx * gx + gy * gy);
}
// Eqs 4.9, 4.10; NaN counts as aliased.
template <class R>
AA_INLINE R sobelCurve(R weightedSum) {
    using T = Elem<R>;
    const R one(T(1)), g = saturate(select(weightedSum == weightedSum, weightedSum, one));
    return sqrt(g * g * (R(T(3)) - (g + g)));
}
// Eq 4.1: share of the nine pixels that show another model.
template <class R, class Differs>
AA_INLINE R modelAverage(const Differs& differs) {
    using T = Elem<R>;
    R count;
    if constexpr (N<R> == 1) {
        int others = 0;
        eachNeighbour([&](int i, int j) __attribute__((always_inline)) { others += differs(i, j) ? 1 : 0; });
        count = R(T(others));
    } else {
        Mask<R> others{};  // a lane of a mask is -1
        eachNeighbour([&](int i, int j) __attribute__((always_inline)) { others -= differs(i, j); });
        count = R(__builtin_convertvector(others, typename R::V));
    }
    return count * R(T(1) / T(9));
}
// Eqs 4.4-4.6.
template <class R>
struct PseudoVariances {
    R depth, depthTemporal;
};
template <class R>
struct DepthWindow {  // deviations from the centre's depth
    R mean, lowest, highest;
};
template <class R, class At>
AA_INLINE DepthWindow<R> depthWindow(const At& at) {
    using T = Elem<R>;
    const R centre = at(0, 0), zero(T(0));
    DepthWindow<R> w{zero, zero, zero};
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) {
            if (i == 0 && j == 0) continue;
            const R d = at(i, j) - centre;
            w.mean = w.mean + d, w.lowest = min(w.lowest, d), w.highest = max(w.highest, d);
        }
    w.mean = w.mean * R(T(1) / T(9));
    return w;
}
// `past`: depth of the past minus the centre's depth. `threshold` is the least D that counts as an edge.
template <class R>
AA_INLINE PseudoVariances<R> pseudoVariances(const DepthWindow<R>& w, R past, R threshold) {
    using T = Elem<R>;
    const R zero(T(0)), one(T(1)), cap(T(1e3));
    const R D = min(abs(w.lowest - w.mean), abs(w.highest - w.mean));
    const auto edge = D >= threshold;
    const R inverse = one / select(edge, D, one);
    const R now = min(abs(w.mean) * inverse, cap), before = min(abs(past - w.mean) * inverse, cap);
    const R before2 = before * before;
    return {select(edge, now * now, zero), select(edge, before2 * before2, zero)};
}

}  // namespace AA_ARCH
