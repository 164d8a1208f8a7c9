#include "kernels/texels.h"
#include "metrics/strip.h"
#include "metrics/temporal_kernels.h"

namespace AA_ARCH {
using namespace aa;

template <class R>
AA_INLINE Offsets<R> offsets(R x, R y, int stride) {
    Offsets<R> at;
    if constexpr (N<R> == 1) {
        at.k[0] = int(y) * stride + int(x), at.together = true;
    } else {
        using I = typename IntsOf<N<R>>::type;
        at.set(__builtin_convertvector(y.v, I) * stride + __builtin_convertvector(x.v, I));
    }
    return at;
}
// Position (x, y) in px inside [0, W] x [0, H]; the border is filled, so the taps need no clamp. A tap of weight 0 is
// not read into the result: it may be NaN.
template <class R>
AA_INLINE R bilinear(const float* p, int stride, R x, R y) {
    const R half(Elem<R>(0.5)), zero(Elem<R>(0));
    const R u = x - half, v = y - half, fu = floor(u), fv = floor(v), s = u - fu, t = v - fv;
    const Offsets<R> at = offsets(fu, fv, stride);
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
constexpr float kSameDepth = 0.02f;  // conventions 13.5

// Lane mask of what differs from ids[o], `found` being where each pixel was.
template <class R>
AA_INLINE Mask<R> idsDiffer(const uint32_t* ids, const uint32_t* previous, const Offsets<R>& found) {
    if (found.together) return idsDiffer<R>(ids, previous + found.k[0]);
    uint32_t of[N<R>];
    for (int i = 0; i < N<R>; i++) of[i] = previous[found.k[i]];
    return idsDiffer<R>(ids, of);
}
// A pixel whose surface was not seen where it comes from, or comes with an age: few.
template <class T>
AA_INLINE void followOne(const FollowArgs& a, long o, int x, int y) {
    const T px = T(x) + T(0.5) - T(a.motionXPx[o]), py = T(y) + T(0.5) - T(a.motionYPx[o]);
    if (!(px >= 0 && px <= T(a.width) && py >= 0 && py <= T(a.height))) return;
    const int nx = int(px) < a.width ? int(px) : a.width - 1, ny = int(py) < a.height ? int(py) : a.height - 1;
    const T z(a.depth[o]);
    const auto isSame = [&](int i, int j) __attribute__((always_inline)) {
        const long n = long(ny + j) * a.stride + nx + i;
        return a.previousId[n] == a.id[o] && abs(T(a.previousDepth[n]) - z) <= T(kSameDepth) * z;
    };
    if (isSame(0, 0)) {
        // Only from its own surface: seen beside q alone, it takes no age from what covered it.
        const uint32_t before = a.previousAge[long(ny) * a.stride + nx];
        a.age[o] = before > 0 && before < a.oldest ? before + 1 : 0;
        return;
    }
    bool isSeen = false;
    for (int n = 0; !isSeen && n < 9; n++) isSeen = isSame(n % 3 - 1, n / 3 - 1);
    if (isSeen)
        a.qx[o] = float(px);
    else
        a.age[o] = 1;
}
template <class R>
__attribute__((flatten)) void followRows(const FollowArgs& a, int y0, int y1) {
    using T = Elem<R>;
    const R half(T(0.5)), zero(T(0)), w{T(a.width)}, h{T(a.height)}, one(T(1)), nan(T(__builtin_nanf("")));
    const uint32_t none[N<R>] = {};
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const long o = long(y) * a.stride + x;
            const R px = R(T(x)) + iota<R>() + half - load<R>(a.motionXPx + o),
                    py = R(T(y)) + half - load<R>(a.motionYPx + o), z = load<R>(a.depth + o);
            const auto inside = both(both(px >= zero, px <= w), both(py >= zero, py <= h));
            const Offsets<R> at = offsets(min(floor(select(inside, px, zero)), w - one),
                                          min(floor(select(inside, py, zero)), h - one), a.stride);
            const auto isSeen = both(both(inside, negate(idsDiffer<R>(a.id + o, a.previousId, at))),
                                     abs(gather<R>(a.previousDepth, at) - z) <= R(T(kSameDepth)) * z);
            const auto isOld = idsDiffer<R>(none, a.previousAge, at);
            store(select(isSeen, px, nan), a.qx + o);
            store(py, a.qy + o);
            for (int i = 0; i < N<R>; i++) a.age[o + i] = 0;
            const unsigned rest = maskBits<R>(both(inside, either(negate(isSeen), isOld)));
            for (int i = 0; rest >> i && i < N<R> && x + i < a.width; i++)
                if (rest >> i & 1) followOne<T>(a, o + i, x + i, y);
        }
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

AA_DEFINE_TABLE(aa::TemporalMetricKernels, temporalMetricKernels) = {AA_ROWS(followRows), AA_ROWS(stepRows),
                                                                     AA_ROWS(spreadRows)};
