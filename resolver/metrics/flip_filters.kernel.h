// FLIP's symmetric and antisymmetric filters over two places side by side, which share most of what they read. Included
// by *.kernel.cpp files.
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
AA_INLINE void inTurn(Two<R>& sum) {
    if constexpr (N < R >> 1) {
#if defined(__x86_64__)
        __asm__("" : "+v"(sum.first.v), "+v"(sum.second.v));
#elif defined(__aarch64__)
        __asm__("" : "+w"(sum.first.v), "+w"(sum.second.v));
#endif
    }
}
// Symmetric filters of u and v.
template <class R>
struct Both {
    Two<R> u, v;
};
template <class R, class At>
AA_INLINE Both<R> even(const At& u, const double* tapsOfU, const At& v, const double* tapsOfV, int reach) {
    Outward<R, At> ofU(u), ofV(v);
    Both<R> sum{ofU.centre() * tapsOfU[0], ofV.centre() * tapsOfV[0]};
#pragma GCC unroll 10
    for (int i = 1; i <= reach; i++) {
        ofU.step(i), ofV.step(i);
        sum.u = sum.u + ofU.sum() * tapsOfU[i], sum.v = sum.v + ofV.sum() * tapsOfV[i];
        inTurn(sum.u), inTurn(sum.v);
    }
    return sum;
}
// The edge filter, which is antisymmetric, and the point filter. The latter's taps sum to 0: as differences from the
// centre it is exactly 0 on flat ground, where the root that follows would turn a rounding error of 1e-8 into 1e-4.
template <class R>
struct Features {
    Two<R> edge{}, point{};
    template <class F, class At>
    AA_INLINE void add(const F& f, const Outward<R, At>& at, Two<R> twice, int i) {
        const Two<R> e = (at.left - at.right) * f.edge[i], p = (at.sum() - twice) * f.point[i];
        edge = i == 1 ? e : edge + e, point = i == 1 ? p : point + p;
        inTurn(edge), inTurn(point);
    }
};

}  // namespace AA_ARCH
