#include "kernels/lanes.h"
#include "methods/ssaa_kernels.h"

namespace AA_ARCH {
using namespace aa;

// Finite means x - x == 0: Inf - Inf and NaN - NaN are NaN.
template <class R>
AA_INLINE Mask<R> finite(vec3<R> c) {
    const R zero(Elem<R>(0));
    return both(both(c.x - c.x == zero, c.y - c.y == zero), c.z - c.z == zero);
}

template <class R>
__attribute__((flatten)) void ssaaRows(const SsaaArgs& a, int y0, int y1) {
    const R zero(Elem<R>(0)), one(Elem<R>(1));
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            vec3<R> sum(zero);
            R count = zero;
            for (int k = 0; k < a.count; k++) {
                const RgbIn& s = a.samples[k];
                const vec3<R> c{load<R>(s.c[0] + o), load<R>(s.c[1] + o), load<R>(s.c[2] + o)};
                const auto counts = finite(c);
                sum = sum + select(counts, c, vec3<R>(zero));
                count = count + select(counts, one, zero);
            }
            const R divisor = max(one, count);
            store(sum.x / divisor, a.out.c[0] + o);
            store(sum.y / divisor, a.out.c[1] + o);
            store(sum.z / divisor, a.out.c[2] + o);
        }
}
}  // namespace AA_ARCH

namespace AA_ARCH {
using SumLanes = Lanes<double, AA_LANES / 2>;  // sums are double in every precision: half as many lanes, twice as wide
}
AA_DEFINE_TABLE(aa::SsaaKernels, ssaaKernels) = {
    .mean = {AA_ARCH::ssaaRows<AA_ARCH::SumLanes>, AA_ARCH::ssaaRows<double>, AA_ARCH::ssaaRows<double>}};
