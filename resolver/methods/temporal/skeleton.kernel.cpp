// Kernel text, compiled once per instruction set. R is Lanes<float, W>, float or double; see
// spatial/skeleton.kernel.cpp for what that asks of the text. The steps that temporal methods share lie in
// temporal_blocks.kernel.h.
#include "methods/temporal/skeleton.h"

#include "methods/temporal/temporal_blocks.kernel.h"

namespace AA_ARCH {

template <class R>
AA_INLINE void temporalSkeletonPixel(const TemporalSkeletonArgs& a, int x, int y) {
    using T = Elem<R>;
    const TemporalIn& in = a.in;
    const R zero(T(0)), one(T(1));
    const long o = long(y) * in.stride + x;
    const vec3<R> current = load3<R>(in.color.c, o);

    // reproject. Outside the image the displacement is 0, so fetching is allowed everywhere and selected afterwards.
    const Motion<R> motion = loadMotion<R>(in, o);
    const Reprojection<R> q = reproject(in, motion, x, y);
    const vec3<R> history = fetchHistory(in, x, y, q);
    // A count is no colour: between one pixel that was just uncovered and one that was not lies no meaningful mean.
    const R samples = gather<R>(a.count + o, nearestOffsets(q, in.stride));

    // rectify
    const auto at = [&](int i, int j) __attribute__((always_inline)) {
        return load3<R>(in.color.c, o + long(j) * in.stride + i);
    };
    const Box<R> box = neighbourBox<R>(at, Neighbourhood::box3x3);
    const vec3<R> clamped = clamp3(history, box.lo, box.hi);

    // blend
    const R n = select(q.inside, min(samples + one, R(T(a.mostSamples))), one);
    const R k = one - one / n;
    const vec3<R> mixed = select(q.inside, blend(current, clamped, k), current);

    // sanitised(): one broken pixel must not live in the history for ever (conventions 11).
    storeBlend(in, x, y, sanitised(mixed, current, history), one);
    store(n, a.nextCount + o);
    storeDebug(in.debug, o, motion, q.inside, box, clamped - history, select(q.inside, k, zero));
}
template <class R>
__attribute__((flatten)) void temporalSkeletonRows(const TemporalSkeletonArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.in.width; x += N<R>) {
            if (a.in.history) {
                temporalSkeletonPixel<R>(a, x, y);
                continue;
            }
            storeFirst<R>(a.in, x, y);  // the first frame after a reset is shown as it is
            store(R(Elem<R>(1)), a.nextCount + long(y) * a.in.stride + x);
        }
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::TemporalSkeletonKernels, temporalSkeletonKernels) = {AA_WIDE_ROWS(temporalSkeletonRows)};
