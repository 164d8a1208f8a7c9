#include "kernels/lanes.h"
#include "methods/spatial/luma_kernels.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
AA_INLINE R weighted(vec3<R> c, double r, double g, double b) {
    using T = Elem<R>;
    return c.x * R(T(r)) + c.y * R(T(g)) + c.z * R(T(b));
}
// saturate() that maps NaN to 0.
template <class R>
AA_INLINE vec3<R> displayRange(vec3<R> c) {
    const vec3<R> zero(R(Elem<R>(0))), one(R(Elem<R>(1)));
    return min(one, max(zero, c));
}
// log2(x) for 1 <= x <= 16: the exponent by halving, then log2(m) = 2/ln 2 * atanh((m-1)/(m+1)) on [1/sqrt 2, sqrt 2]:
// |s| <= 0.1716, and the first omitted term s^13/13 is below 1e-11.
template <class R>
AA_INLINE R log2From1To16(R x) {
    using T = Elem<R>;
    const R zero(T(0)), one(T(1));
    R exponent = zero;
    for (int k = 3; k >= 1; k--) {
        const double power = 1 << k;
        const auto above = x >= R(T(power * 0.70710678118654752));
        exponent = select(above, exponent + R(T(k)), exponent);
        x = select(above, x * R(T(1 / power)), x);
    }
    const R s = (x - one) / (x + one), q = s * s;
    R series = R(T(1.0 / 11));
    for (int k = 9; k >= 1; k -= 2) series = series * q + R(T(1.0 / k));
    return exponent + R(T(2.8853900817779268)) * s * series;
}
template <class R>
AA_INLINE R lumaOf(vec3<R> c, LumaKind kind) {
    using T = Elem<R>;
    switch (kind) {
        case LumaKind::rec601:
            return weighted(c, 0.299, 0.587, 0.114);
        case LumaKind::rec709:
            return weighted(c, 0.2126, 0.7152, 0.0722);
        case LumaKind::green:
            return c.y;
        case LumaKind::redGreen:
            return c.y * R(T(0.587 / 0.299)) + c.x;
        case LumaKind::sqrtLinear:
            return sqrt(weighted(displayRange(c), 0.299, 0.587, 0.114));
        case LumaKind::linearOfSqrt:
            return weighted(sqrt(displayRange(c)), 0.299, 0.587, 0.114);
        case LumaKind::log2Linear: {
            const R one(T(1)), y = min(one, weighted(displayRange(c), 0.212671, 0.715160, 0.072169));
            return log2From1To16(one + R(T(15)) * y) * R(T(0.25));
        }
        case LumaKind::nfaa:
            return weighted(c, 0.212, 0.716, 0.072);
    }
    return c.y;
}
template <class R, LumaKind kind>
AA_INLINE void lumaRowsOf(const LumaArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            const vec3<R> c(load<R>(a.in.c[0] + o), load<R>(a.in.c[1] + o), load<R>(a.in.c[2] + o));
            store(lumaOf(c, kind), a.luma + long(y) * a.lumaStride + x);
        }
}
template <class R>
__attribute__((flatten)) void lumaRows(const LumaArgs& a, int y0, int y1) {
    switch (a.kind) {
#define AA_KIND(k)    \
    case LumaKind::k: \
        return lumaRowsOf<R, LumaKind::k>(a, y0, y1);
        AA_KIND(rec601)
        AA_KIND(rec709)
        AA_KIND(green) AA_KIND(redGreen) AA_KIND(sqrtLinear) AA_KIND(linearOfSqrt) AA_KIND(log2Linear) AA_KIND(nfaa)
#undef AA_KIND
    }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::LumaKernels, lumaKernels) = {AA_WIDE_ROWS(lumaRows)};
