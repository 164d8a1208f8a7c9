#include "methods/temporal/taa_simplest.h"

#include "methods/temporal/temporal_blocks.kernel.h"

namespace AA_ARCH {

template <class R>
AA_INLINE void taaSimplestPixel(const TaaSimplestArgs& a, int x, int y) {
    const TemporalIn& in = a.in;
    const long o = long(y) * in.stride + x;
    const vec3<R> current = load3<R>(in.color.c, o);
    const R k(Elem<R>(min(a.feedback, in.feedbackCeiling)));

    const Motion<R> motion = loadMotion<R>(in, o);
    const Reprojection<R> q = reproject(in, motion, x, y);
    const vec3<R> history = fetchHistory(in, x, y, q);
    const vec3<R> mixed = select(q.inside, blend(current, history, k), current);

    storeBlend(in, x, y, sanitised(mixed, current, history), R(Elem<R>(1)));
    storeDebug(in.debug, o, motion, q.inside, Box<R>{history, history}, vec3<R>(R(Elem<R>(0))), k);
}
template <class R>
__attribute__((flatten)) void taaSimplestRows(const TaaSimplestArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.in.width; x += N<R>)
            if (a.in.history)
                taaSimplestPixel<R>(a, x, y);
            else
                storeFirst<R>(a.in, x, y);
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::TaaSimplestKernels, taaSimplestKernels) = {AA_WIDE_ROWS(taaSimplestRows)};
