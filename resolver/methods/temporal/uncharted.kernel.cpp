#include "methods/temporal/uncharted.h"

#include "methods/temporal/temporal_blocks.kernel.h"

namespace AA_ARCH {

template <class R>
AA_INLINE void unchartedPixel(const UnchartedArgs& a, int x, int y) {
    const TemporalIn& in = a.in;
    const long o = long(y) * in.stride + x;
    const vec3<R> current = load3<R>(in.color.c, o);

    // 1. reproject
    const Motion<R> motion = dilatedMotion<R>(in, o);
    const Reprojection<R> q = reproject(in, motion, x, y);
    const vec3<R> history = fetchHistory(in, x, y, q);

    // 2. rectify
    const auto at = [&](int i, int j) __attribute__((always_inline)) {
        return load3<R>(in.color.c, o + long(j) * in.stride + i);
    };
    const auto mean = [&]() __attribute__((always_inline)) { return meanOf(neighbourMeans<R>(at), a.neighbourhood); };
    const Box<R> box = neighbourBox<R>(at, a.neighbourhood);
    const vec3<R> clipped = constrain(box, a.clipTarget, mean, current, history);

    // 3. blend
    const R k = min(luminanceFeedback(luminance(current, a.luminance), luminance(clipped, a.luminance), a.kMin, a.kMax),
                    R(Elem<R>(in.feedbackCeiling)));
    const vec3<R> mixed = select(q.inside, blend(current, clipped, k), current);

    storeBlend(in, x, y, sanitised(mixed, current, history), R(Elem<R>(1)));
    storeDebug(in.debug, o, motion, q.inside, box, clipped - history, k);
}
template <class R>
__attribute__((flatten)) void unchartedRows(const UnchartedArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.in.width; x += N<R>)
            if (a.in.history)
                unchartedPixel<R>(a, x, y);
            else
                storeFirst<R>(a.in, x, y);
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::UnchartedKernels, unchartedKernels) = {AA_WIDE_ROWS(unchartedRows)};
