// Bilinear fetch at the pixel centre plus an offset of at most one pixel: how RSAA, GBAA, distance-to-edge and deferred
// MSAA blend a pixel with its neighbours. Scalar: they run it on edge pixels only. Included by *.kernel.cpp files.
#pragma once
#include "kernels/lanes.h"
#include "kernels/table.h"

namespace AA_ARCH {

template <class T>
AA_INLINE T lerpSkipping(T a, T b, T t) {
    return t == T(0) ? a : a + (b - a) * t;  // a tap of weight 0 is never read into the result: it may be NaN
}
// T is float or double; |offset| <= 1; the image's border is filled.
template <class T>
AA_INLINE vec3<T> resample(const aa::RgbIn& image, long stride, int x, int y, T offsetXPx, T offsetYPx) {
    const T fx0 = floor(offsetXPx), fy0 = floor(offsetYPx), fx = offsetXPx - fx0, fy = offsetYPx - fy0;
    const long o = long(y + int(fy0)) * stride + x + int(fx0);
    T v[3];
    for (int c = 0; c < 3; c++) {
        const float* p = image.c[c] + o;
        const T top = lerpSkipping(T(p[0]), T(p[1]), fx);
        v[c] = lerpSkipping(top, lerpSkipping(T(p[stride]), T(p[stride + 1]), fx), fy);
    }
    return {v[0], v[1], v[2]};
}

}  // namespace AA_ARCH
