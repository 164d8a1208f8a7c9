#include "methods/temporal/accum_reject.h"

#include "methods/temporal/rejection.kernel.h"

namespace AA_ARCH {

// mean + residual, updated by (c - mean) / n without loss: Knuth's two-sum keeps what the float mean cannot hold.
template <class R>
AA_INLINE void compensatedStep(R c, R n, R& mean, R& residual) {
    const R step = residual + (c - mean - residual) / n;
    const R sum = mean + step, taken = sum - mean;
    residual = (mean - (sum - taken)) + (step - taken);
    mean = sum;
}

template <class R>
AA_INLINE void accumRejectPixel(const AccumRejectArgs& a, int x, int y) {
    using T = Elem<R>;
    const TemporalIn& in = a.in;
    const R zero(T(0)), one(T(1));
    const long o = long(y) * in.stride + x;
    const vec3<R> current = load3<R>(in.color.c, o);
    const R depth = load<R>(in.depthView + o);

    // reproject
    const Motion<R> motion = dilatedMotion<R>(in, o);
    const Reprojection<R> q = reproject(in, motion, x, y);
    const Offsets<R> nearest = nearestOffsets(q, in.stride);
    const vec3<R> history = fetchHistory(in, x, y, q);
    vec3<R> residual = fetchBilinear<R>(a.residual + 4 * o, in.stride, q).rgb;

    // validate
    const R expected = expectedPreviousDepth(a.expected, depth, x, y);
    R reason = select(q.inside, zero, one);
    const auto reject = [&](Mask<R> when, Rejection why) __attribute__((always_inline)) {
        reason = select(both(reason == zero, when), R(T(int(why))), reason);
    };
    const auto still = both(motion.x == zero, motion.y == zero);
    if (a.depthTest != DepthTest::off) {
        const float tolerance = a.rejection.depthTolerance;
        auto hidden =
            disoccluded(expected, fetchDepth(in.history + 4 * o, in.stride, q), tolerance, a.rejection.bothSides);
        // At rest the jitter alone moves a silhouette: no sample is lost to it. Behind a moving one the window would
        // pass what it uncovers.
        if (a.depthTest == DepthTest::window)
            hidden = both(hidden,
                          either(negate(still),
                                 disoccluded(expected, gather<R>(a.previousFarthest + o, nearest), tolerance, false)));
        reject(hidden, Rejection::disoccluded);
    }
    if (a.rejection.magnification > 0) {
        const Footprint<R> covered = footprint(motionSlope<R>(in, x, y), one);
        reject(magnified(q, covered, a.rejection.magnification), Rejection::magnified);
    }
    if (a.objectId) reject(idLost<R>(a.objectId + o, a.previousId + o, in.stride, nearest), Rejection::otherObject);
    const auto valid = reason == zero;

    // accumulate
    const R nMax = select(still, R(T(a.nMaxStatic)), R(T(a.nMaxMoving)));
    R count = fetchRgba<R>(a.residual + 4 * o, nearest).a;
    count = select(valid, min(count + one, nMax), one);
    vec3<R> mean = history;
    compensatedStep(current.x, count, mean.x, residual.x);
    compensatedStep(current.y, count, mean.y, residual.y);
    compensatedStep(current.z, count, mean.z, residual.z);
    const auto ok = both(valid, both(finite(mean), finite(residual)));
    mean = sanitised(select(valid, mean, current), current, history);
    storeBlend(in, x, y, mean, depth);
    storeRgba(select(ok, residual, vec3<R>(zero)), count, a.nextResidual + 4 * o);

    if (!in.debug.rejection) return;
    storeDebug(in.debug, o, motion, valid, Box<R>{history, history}, vec3<R>(zero), one - one / count);
    store(reason, in.debug.rejection + o);
    if (a.debugCount) store(count, a.debugCount + o);
}
template <class R>
__attribute__((flatten)) void accumRejectRows(const AccumRejectArgs& a, int y0, int y1) {
    using T = Elem<R>;
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.in.width; x += N<R>) {
            if (a.in.history) {
                accumRejectPixel<R>(a, x, y);
                continue;
            }
            const long o = long(y) * a.in.stride + x;
            storeFirst<R>(a.in, x, y, load3<R>(a.in.color.c, o), load<R>(a.in.depthView + o));
            storeRgba(vec3<R>(R(T(0))), R(T(1)), a.nextResidual + 4 * o);
            if (a.debugCount) store(R(T(1)), a.debugCount + o);
        }
}
template <class R>
__attribute__((flatten)) void dilateMaxRows(const DilateMaxArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {
            const float* p = a.in + long(y) * a.stride + x;
            const auto row = [&](const float* r) __attribute__((always_inline)) {
                return max(max(load<R>(r), load<R>(r - 1)), load<R>(r + 1));
            };
            store(max(max(row(p), row(p - a.stride)), row(p + a.stride)), a.out + long(y) * a.stride + x);
        }
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::AccumRejectKernels, accumRejectKernels) = {AA_WIDE_ROWS(accumRejectRows),
                                                               AA_WIDE_ROWS(dilateMaxRows)};
