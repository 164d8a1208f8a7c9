#include "methods/temporal/t2msaa.h"

#include "kernels/display.h"
#include "methods/temporal/rejection.kernel.h"

namespace AA_ARCH {

// v (1 - v) of one component; v > 1 counts as 1 (conventions 11).
template <class R>
AA_INLINE R parabola(R v) {
    const R s = saturate(v);
    return s * (R(Elem<R>(1)) - s);
}
template <class R>
AA_INLINE R fraction(R v) {
    return v - floor(v);
}

template <class R>
AA_INLINE vec3<R> sampleColour(const T2msaaArgs& a, int i, long o) {
    const vec3<R> c = load3<R>(a.sample[i].c, o);
    return a.encoded ? display(a.display, c) : c;
}
template <class R>
AA_INLINE void t2msaaPixel(const T2msaaArgs& a, int x, int y) {
    using T = Elem<R>;
    const TemporalIn& in = a.in;
    const R zero(T(0)), one(T(1)), half(T(0.5));
    const long o = long(y) * in.stride + x;
    const vec3<R> first = sampleColour<R>(a, 0, o), current = first + (sampleColour<R>(a, 1, o) - first) * half;
    const R depth = (load<R>(a.sampleDepth[0] + o) + load<R>(a.sampleDepth[1] + o)) * half;
    if (!in.history) {
        storeBlend(in, x, y, sanitised(current, current, vec3<R>(zero)), depth);
        store(one, a.nextCount + o);
        if (in.debug.rejection) store(R(T(int(Rejection::firstFrame))), in.debug.rejection + o);
        return;
    }

    const Motion<R> motion = loadMotion<R>(in, o);
    const Reprojection<R> q = reproject(in, motion, x, y);
    const vec3<R> history = fetchBilinear<R>(in.history + 4 * o, in.stride, q).rgb;

    const R expected = expectedPreviousDepth(a.expected, depth, x, y);
    R reason = select(q.inside, zero, one);
    const auto reject = [&](Mask<R> when, Rejection why) __attribute__((always_inline)) {
        reason = select(both(reason == zero, when), R(T(int(why))), reason);
    };
    const RejectionTest& test = a.rejection;
    reject(disoccluded(expected, fetchDepth(in.history + 4 * o, in.stride, q), test.depthTolerance, test.bothSides),
           Rejection::disoccluded);
    if (test.magnification > 0)
        reject(magnified(q, footprint(motionSlope<R>(in, x, y), one), test.magnification), Rejection::magnified);
    const auto hit = reason == zero;

    const R count =
        a.countAtPixel ? load<R>(a.previousCount + o) : gather<R>(a.previousCount + o, nearestOffsets(q, in.stride));
    const R mean = one / (count + one);
    // Listing 4.19: velocity in UV; eq 3.31 means the fraction of a pixel.
    const R vx = a.fractionalVelocity ? fraction(abs(motion.x)) : abs(motion.x) * R(T(1) / T(in.width)),
            vy = a.fractionalVelocity ? fraction(abs(motion.y)) : abs(motion.y) * R(T(1) / T(in.height));
    const R blur = R(T(0.25)) + ((one - mean) / mean) * ((parabola(vx) + parabola(vy)) * half);
    const auto still = both(motion.x == zero, motion.y == zero);
    const R least = select(still, zero, saturate(blur));
    const R alpha = max(mean, least);
    const vec3<R> mixed = inverseLuminanceBlend(current, luma601(current), history, luma601(history), one - alpha);

    const R most(T(16777215));  // the last whole step of float
    const R grown = select(alpha > least, min(count + one, most), count);
    storeBlend(in, x, y, sanitised(select(hit, mixed, current), current, history), depth);
    store(select(hit, grown, one), a.nextCount + o);
    storeDebug(in.debug, o, motion, hit, Box<R>{history, history}, vec3<R>(zero), one - alpha);
    if (in.debug.rejection) store(reason, in.debug.rejection + o);
}
template <class R>
__attribute__((flatten)) void t2msaaRows(const T2msaaArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.in.width; x += N<R>) t2msaaPixel<R>(a, x, y);
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::T2msaaKernels, t2msaaKernels) = {AA_WIDE_ROWS(t2msaaRows)};
