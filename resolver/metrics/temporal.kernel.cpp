#include "kernels/texels.h"
#include "metrics/strip.h"
#include "metrics/temporal_kernels.h"

namespace AA_ARCH {
using namespace aa;

// Position (x, y) in px inside [0, W] x [0, H]; the border is filled, so the taps need no clamp. A tap of weight 0 is
// not read into the result: it may be NaN.
template <class R>
AA_INLINE R bilinear(const float* p, int stride, R x, R y) {
    const R half(Elem<R>(0.5)), zero(Elem<R>(0));
    const R u = x - half, v = y - half, fu = floor(u), fv = floor(v), s = u - fu, t = v - fv;
    Offsets<R> at;
    if constexpr (N<R> == 1) {
        at.k[0] = int(fv) * stride + int(fu), at.together = true;
    } else {
        using I = typename IntsOf<N<R>>::type;
        at.set(__builtin_convertvector(fv.v, I) * stride + __builtin_convertvector(fu.v, I));
    }
    const auto row = [&](const float* q) __attribute__((always_inline)) {
        const R a = gather<R>(q, at), b = gather<R>(q + 1, at);
        return select(s == zero, a, a + (b - a) * s);
    };
    const R top = row(p), bottom = row(p + stride);
    return select(t == zero, top, top + (bottom - top) * t);
}
// Lanes of a row that are still to come.
template <class R>
AA_INLINE Mask<R> first(int count) {
    return iota<R>() < R(Elem<R>(count));
}
template <class R>
__attribute__((flatten)) void stepRows(const StepArgs& a, int y0, int y1) {
    const R zero(Elem<R>(0)), anywhere(Elem<R>(0.5));
    for (int y = y0; y < y1; y++) {
        Strands<R> squares;
        int known = 0;
        for (int x = a.first; x < a.end; x += N<R>) {
            const long o = long(y) * a.stride + x;
            const R qx = load<R>(a.qx + o), qy = load<R>(a.qy + o);
            const auto isKnown = both(qx == qx, first<R>(a.end - x));
            const R before =
                bilinear(a.previous, a.stride, select(isKnown, qx, anywhere), select(isKnown, qy, anywhere));
            const R step = select(isKnown, load<R>(a.luma + o) - before, zero);
            if (a.step) store(step, a.step + o);
            if (!a.truthStep) continue;
            known += __builtin_popcount(maskBits<R>(isKnown));
            const Doubles<R> d = Doubles<R>(step) - Doubles<R>(select(isKnown, load<R>(a.truthStep + o), zero));
            squares.add(d * d, x - a.first);
        }
        if (a.truthStep) a.rows[2 * y] = squares.total(), a.rows[2 * y + 1] = known;
    }
}
template <class R>
__attribute__((flatten)) void spreadRows(const SpreadArgs& a, int y0, int y1) {
    const R n(Elem<R>(a.count)), zero(Elem<R>(0));
    for (int y = y0; y < y1; y++) {
        Strands<R> sizes, squares;
        for (int x = a.first; x < a.end; x += N<R>) {  // Welford
            const long o = long(y) * a.stride + x;
            const R v = load<R>(a.luma + o), before = load<R>(a.mean + o), d = v - before, mean = before + d / n;
            store(mean, a.mean + o);
            store(load<R>(a.spread + o) + d * (v - mean), a.spread + o);
            if (!a.previous) continue;
            const auto counts = first<R>(a.end - x);
            const Doubles<R> step =
                Doubles<R>(select(counts, v, zero)) - Doubles<R>(select(counts, load<R>(a.previous + o), zero));
            sizes.add(abs(step), x - a.first), squares.add(step * step, x - a.first);
        }
        a.rows[2 * y] = sizes.total(), a.rows[2 * y + 1] = squares.total();
    }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::TemporalMetricKernels, temporalMetricKernels) = {AA_ROWS(stepRows), AA_ROWS(spreadRows)};
