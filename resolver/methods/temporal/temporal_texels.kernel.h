// Small helpers of the temporal kernels: planes in and out of lanes, ranges, colour axes. Include from *.kernel.cpp
// only.
#pragma once
#include "kernels/texels.h"
#include "methods/temporal/temporal_kernels.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
AA_INLINE vec3<R> load3(const float* const (&c)[3], long offset) {
    return {load<R>(c[0] + offset), load<R>(c[1] + offset), load<R>(c[2] + offset)};
}
template <class R>
AA_INLINE void store3(vec3<R> v, float* const (&c)[3], long offset) {
    store(v.x, c[0] + offset), store(v.y, c[1] + offset), store(v.z, c[2] + offset);
}
// A window's channels are computed one after the other: sums and bounds of three at once do not fit into sixteen
// registers, and one that lies in memory costs three times the latency of each addition. at(i, j) may give all three;
// what is not used of it is not computed.
template <int c>
struct Channel {
    AA_INLINE constexpr operator int() const { return c; }
};
template <class R, int c>
AA_INLINE R& part(vec3<R>& v, Channel<c>) {
    return c == 0 ? v.x : c == 1 ? v.y : v.z;
}
template <class R, int c>
AA_INLINE R part(const vec3<R>& v, Channel<c>) {
    return c == 0 ? v.x : c == 1 ? v.y : v.z;
}
template <class Run>
AA_INLINE void eachChannel(const Run& run) {
    run(Channel<0>{}), run(Channel<1>{}), run(Channel<2>{});
}
template <class R>
AA_INLINE Mask<R> all(bool value) {
    return value ? R(Elem<R>(0)) == R(Elem<R>(0)) : R(Elem<R>(0)) != R(Elem<R>(0));
}
// x - x is NaN for NaN and for both infinities.
template <class R>
AA_INLINE Mask<R> finite(R x) {
    return x - x == R(Elem<R>(0));
}
template <class R>
AA_INLINE Mask<R> finite(vec3<R> c) {
    return finite(c.x - c.x + (c.y - c.y) + (c.z - c.z));
}
template <class R>
AA_INLINE vec3<R> clamp3(vec3<R> c, vec3<R> lo, vec3<R> hi) {
    return min(max(c, lo), hi);
}

// Y, Co, Cg (conventions 4). The inverse does not clamp.
template <class R>
AA_INLINE vec3<R> toYcocg(vec3<R> c) {
    using T = Elem<R>;
    const R half(T(0.5)), quarter(T(0.25)), rb = (c.x + c.z) * quarter;
    return {rb + c.y * half, (c.x - c.z) * half, c.y * half - rb};
}
template <class R>
AA_INLINE vec3<R> fromYcocg(vec3<R> c) {
    const R t = c.x - c.z;
    return {t + c.y, c.x + c.z, t - c.y};
}
template <class R>
AA_INLINE R luminance(vec3<R> c, Luminance kind) {
    using T = Elem<R>;
    if (kind == Luminance::quarter) return c.x * R(T(0.25)) + c.y * R(T(0.5)) + c.z * R(T(0.25));
    if (kind == Luminance::inside) return c.x * R(T(0.22)) + c.y * R(T(0.707)) + c.z * R(T(0.071));
    return kind == Luminance::bt601 ? luma601(c) : luma709(c);
}

}  // namespace AA_ARCH
