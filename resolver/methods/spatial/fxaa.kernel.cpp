#include "kernels/texels.h"
#include "methods/spatial/fxaa_common.kernel.h"

namespace AA_ARCH {

AA_INLINE void fxaa311Pixel(const FxaaArgs& a, int x, int y, int i, const Classes& classes) {
    const bool horizontal = classes.horizontal >> i & 1;
    const double negativeStep = classes.negativeStep[i], positiveStep = classes.positiveStep[i];
    const bool positiveSide = !(negativeStep >= positiveStep);
    const EdgeLine line = lineBeside(a, x, y, horizontal, positiveSide, positiveSide ? positiveStep : negativeStep);
    const LineEnds ends = findEnds(a, line);
    const double subShift = smooth(classes.contrast[i]);
    const double shiftPx = max(edgeShift(ends, double(*line.own) - line.middle < 0), subShift * subShift * a.subpix);
    const long o = long(y) * a.stride + x, across = horizontal ? a.stride : 1;
    writeShifted(a, o, positiveSide ? across : -across, shiftPx);
    writeDebug(a, o, horizontal, ends, shiftPx);
}

template <class R>
__attribute__((flatten)) void fxaa311Rows(const FxaaArgs& a, int y0, int y1) {
    forClassifiedPixels<R>(
        a, y0, y1, [&](int x, int y, int i, const Classes& classes) __attribute__((always_inline)) {
            fxaa311Pixel(a, x, y, i, classes);
        });
}

// Writes rows 16 b to 16 b + 15 of the transposed plane, so that whole cache lines of the source are read.
template <class R>
void fxaaTransposeBlocks(const FxaaTransposeArgs& a, int b0, int b1) {
    for (int x0 = 16 * b0; x0 < 16 * b1; x0 += 16)
        for (int y = 0; y < a.height; y += 4)
            for (int x = x0; x < x0 + 16; x += 4) {
                const float* const p = a.from + long(y) * a.fromStride + x;
                Four r0 = loadFour(p), r1 = loadFour(p + a.fromStride), r2 = loadFour(p + 2l * a.fromStride),
                     r3 = loadFour(p + 3l * a.fromStride);
                transpose(r0, r1, r2, r3);
                float* const q = a.to + long(x) * a.toStride + y;
                storeFour(r0, q), storeFour(r1, q + a.toStride);
                storeFour(r2, q + 2l * a.toStride), storeFour(r3, q + 3l * a.toStride);
            }
}
}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::FxaaKernels, fxaaKernels) = {AA_ROWS(fxaa311Rows), AA_ROWS(fxaaTransposeBlocks)};
