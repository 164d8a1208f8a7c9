#include "methods/fxaa_common.kernel.h"

namespace AA_ARCH {

AA_INLINE void fxaa311_pixel(const FxaaArgs& a, int x, int y) {
    const long o = long(y) * a.stride + x;
    const Neighbourhood l = neighbourhood(a.luma, o, a.stride);
    const bool horizontal = horizontal_edge(l);
    const double subShift = smooth(sub_pixel_contrast(l, range_of(l)));
    const double negativeStep = abs((horizontal ? l.n : l.w) - l.m), positiveStep = abs((horizontal ? l.s : l.e) - l.m);
    const EdgeLine line = edge_line(a, x, y, horizontal, !(negativeStep >= positiveStep), l);
    const LineEnds ends = find_ends(a, line);
    const double shiftPx = max(edge_shift(ends, l.m - line.middle < 0), subShift * subShift * a.subpix);
    write_shifted(a, o, line.across, shiftPx);
    write_debug(a, o, horizontal, ends, shiftPx);
}

template <class R>
__attribute__((flatten)) void fxaa311Rows(const FxaaArgs& a, int y0, int y1) {
    for_edge_pixels<R>(
        a, y0, y1, [&](int x, int y) __attribute__((always_inline)) { fxaa311_pixel(a, x, y); });
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::FxaaKernels, fxaaKernels) = {AA_ROWS(fxaa311Rows)};
