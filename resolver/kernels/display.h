// The display chain D of conventions 4 in lanes: linear * 2^exposure -> tone map -> clamp [0,1] -> transfer. NaN gives
// 0. Include from *.kernel.cpp only.
#pragma once
#include "kernels/display_args.h"
#include "kernels/srgb.h"

namespace AA_ARCH {

template <class R>
AA_INLINE R toneMapped(R x, int kind) {
    using T = Elem<R>;
    const R one(T(1));
    if (kind == 1) return x / (one + x);  // Reinhard
    if (kind == 2)                        // ACES fit, [Narkowicz 2016]
        return (x * (x * R(T(2.51)) + R(T(0.03)))) / (x * (x * R(T(2.43)) + R(T(0.59))) + R(T(0.14)));
    return x;
}
// Before the transfer.
template <class R>
AA_INLINE R shown(const aa::DisplayArgs& d, R c) {
    using T = Elem<R>;
    // max(0, NaN) == 0; the finite ceiling keeps Inf / Inf out of the tone maps (their value is 1 long before it).
    const R x = min(max(R(T(0)), c * R(T(d.scale))), R(T(1e15)));
    return min(max(R(T(0)), toneMapped(x, d.toneMap)), R(T(1)));
}
template <class R>
AA_INLINE R display(const aa::DisplayArgs& d, R c) {
    return d.srgb ? srgbEncode(shown(d, c)) : shown(d, c);
}
template <class R>
AA_INLINE vec3<R> display(const aa::DisplayArgs& d, vec3<R> c) {
    return {display(d, c.x), display(d, c.y), display(d, c.z)};
}

}  // namespace AA_ARCH
