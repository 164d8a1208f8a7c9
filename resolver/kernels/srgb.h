// The sRGB transfer functions in lanes, by Newton's roots instead of libm's pow (same bits everywhere). Error <= 3e-7
// in float. Include from *.kernel.cpp only.
#pragma once
#include "kernels/lanes.h"

namespace AA_ARCH {

// IEC 61966-2-1. c^(1/2.4) = c^(5/12) = sqrt(sqrt(c)) * cbrt(sqrt(c)).
template <class R>
AA_INLINE R srgbEncode(R c) {
    using T = Elem<R>;
    const R s = sqrt(max(c, R(T(1e-12))));
    const R curved = R(T(1.055)) * (sqrt(s) * cbrtPositive(s)) - R(T(0.055));
    return min(select(c <= R(T(0.0031308)), c * R(T(12.92)), curved), R(T(1)));
}
// c^2.4 = c^2 * (c^(1/5))^2.
template <class R>
AA_INLINE R srgbDecode(R e) {
    using T = Elem<R>;
    const R b = max((e + R(T(0.055))) / R(T(1.055)), R(T(1e-12))), f = fifthRootPositive(b);
    return select(e <= R(T(0.04045)), e / R(T(12.92)), b * b * (f * f));
}

}  // namespace AA_ARCH
