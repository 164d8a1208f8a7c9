// FLIP's symmetric and antisymmetric filters over two or four places side by side, which share most of what they read.
// Included by *.kernel.cpp files.
#pragma once
#include "metrics/strip.h"

namespace AA_ARCH {

template <class R>
AA_INLINE R constant(double v) {
    return R(Elem<R>(v));
}
// From two places outward, of which the first is at(0): the values i places before them and i behind.
template <class R, class At>
struct Outward {
    At at;
    R before, behind;
    Two<R> left, right;
    AA_INLINE explicit Outward(const At& values) : at(values), before(at(0)), behind(at(1)) {}
    AA_INLINE Two<R> centre() const { return {at(0), at(1)}; }
    AA_INLINE void step(int i) {
        const R farBefore = at(-i), farBehind = at(i + 1);
        left = {farBefore, before}, right = {behind, farBehind};
        before = farBefore, behind = farBehind;
    }
    AA_INLINE Two<R> sum() const { return left + right; }
};
// Sums grow side by side, as they stand: GCC would compute one to its end before it begins the next, though each
// addition waits for the one before.
template <class R>
AA_INLINE void inTurn(R& a, R& b) {
    if constexpr (N < R >> 1) {
#if defined(__x86_64__)
        __asm__("" : "+v"(a.v), "+v"(b.v));
#elif defined(__aarch64__)
        __asm__("" : "+w"(a.v), "+w"(b.v));
#endif
    }
}
template <class R>
AA_INLINE void inTurn(Two<R>& sum) {
    inTurn(sum.first, sum.second);
}
// A symmetric filter of four places side by side, of which the first is at(0): as many as have their windows' ends,
// which move outward, and their sums in registers.
template <class R>
struct Quad {
    R of[4];
    friend AA_INLINE Quad operator+(const Quad& a, const Quad& b) {
        return {{a.of[0] + b.of[0], a.of[1] + b.of[1], a.of[2] + b.of[2], a.of[3] + b.of[3]}};
    }
};
template <class R, class At>
AA_INLINE Quad<R> even(const At& at, const double* taps, int reach) {
    R left[4], right[4];
    Quad<R> sum;
    for (int k = 0; k < 4; k++) left[k] = right[k] = at(k), sum.of[k] = at(k) * constant<R>(taps[0]);
#pragma GCC unroll 10
    for (int i = 1; i <= reach; i++) {
        for (int k = 3; k > 0; k--) left[k] = left[k - 1], right[3 - k] = right[4 - k];
        left[0] = at(-i), right[3] = at(3 + i);
        for (int k = 0; k < 4; k++) sum.of[k] = sum.of[k] + (left[k] + right[k]) * constant<R>(taps[i]);
        inTurn(sum.of[0], sum.of[1]), inTurn(sum.of[2], sum.of[3]);
    }
    return sum;
}
// The edge filter, which is antisymmetric, and the point filter. The latter's taps sum to 0, and of flat ground it must
// be exactly 0: the root that follows would turn a rounding error of 1e-8 into 1e-4. So both are taken of differences
// from a place that all of a tile's windows hold, which are then 0, too.
template <class R>
struct Features {
    Two<R> edge{}, point;
    template <class F>
    AA_INLINE Features(const F& f, Two<R> centre) : point(centre * f.point[0]) {}
    template <class F, class At>
    AA_INLINE void add(const F& f, const Outward<R, At>& at, int i) {
        const Two<R> e = (at.left - at.right) * f.edge[i];
        edge = i == 1 ? e : edge + e, point = point + at.sum() * f.point[i];
        inTurn(edge), inTurn(point);
    }
};

}  // namespace AA_ARCH
