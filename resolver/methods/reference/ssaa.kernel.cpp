#include "methods/reference/ssaa.h"

#include "kernels/display.h"

namespace AA_ARCH {
using namespace aa;

// Finite means x - x == 0: Inf - Inf and NaN - NaN are NaN.
template <class R>
AA_INLINE Mask<R> finite(vec3<R> c) {
    const R zero(Elem<R>(0));
    return both(both(c.x - c.x == zero, c.y - c.y == zero), c.z - c.z == zero);
}

// One sub-sample at a time over a chunk of a row, while the next one's is fetched (see kernels/subsamples.h).
inline constexpr int kSumChunk = 128;  // pixels; the sums stay in the first-level cache
template <class R, bool encoded>
__attribute__((flatten)) void ssaaRowsOf(const SsaaArgs& a, int y0, int y1) {
    const R zero(Elem<R>(0)), one(Elem<R>(1));
    vec3<R> sum[kSumChunk / N<R>];
    R count[kSumChunk / N<R>];
    for (int y = y0; y < y1; y++)
        for (int x0 = 0; x0 < a.width; x0 += kSumChunk) {
            const long o0 = long(y) * a.stride + x0;
            const int left = a.width - x0, groups = ((left < kSumChunk ? left : kSumChunk) + N<R> - 1) / N<R>;
            for (int i = 0; i < groups; i++) sum[i] = vec3<R>(zero), count[i] = zero;
            for (int k = 0; k < a.count; k++) {
                const RgbIn& s = a.samples[k];
                const RgbIn& next = k + 1 < a.count ? a.samples[k + 1] : a.samples[0];
                const long ahead = k + 1 < a.count ? 0 : kSumChunk;
                for (int i = 0; i < groups; i++) {
                    const long o = o0 + i * N<R>;
                    for (int c = 0; c < 3; c++) __builtin_prefetch(next.c[c] + o + ahead);
                    const vec3<R> c{load<R>(s.c[0] + o), load<R>(s.c[1] + o), load<R>(s.c[2] + o)};
                    const auto counts = finite(c);
                    sum[i] = sum[i] + select(counts, encoded ? display(a.display, c) : c, vec3<R>(zero));
                    count[i] = count[i] + select(counts, one, zero);
                }
            }
            for (int i = 0; i < groups; i++) {
                const long o = o0 + i * N<R>;
                const R divisor = max(one, count[i]);
                store(sum[i].x / divisor, a.out.c[0] + o);
                store(sum[i].y / divisor, a.out.c[1] + o);
                store(sum[i].z / divisor, a.out.c[2] + o);
            }
        }
}
template <class R>
void ssaaRows(const SsaaArgs& a, int y0, int y1) {
    a.encoded ? ssaaRowsOf<R, true>(a, y0, y1) : ssaaRowsOf<R, false>(a, y0, y1);
}
using SumLanes = Lanes<double, AA_LANES / 2>;  // sums are double in every precision: half as many lanes, twice as wide
}  // namespace AA_ARCH
AA_DEFINE_TABLE(aa::SsaaKernels, ssaaKernels) = {
    .mean = AA_FORMS(AA_ARCH::ssaaRows<AA_ARCH::SumLanes>, AA_ARCH::ssaaRows<double>, AA_ARCH::ssaaRows<double>)};
