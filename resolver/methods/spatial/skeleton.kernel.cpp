// Kernel text, compiled once per instruction set. R is Lanes<float, W> (the product), float (the portable form) or
// double (the oracle of the tests); all three must give the same picture, so everything is written over R. Same input,
// same bits: only + - * / sqrt floor and comparisons, and a fixed order of sums (kernels/lanes.h).
#include "methods/spatial/skeleton.h"

#include "kernels/lanes.h"

namespace AA_ARCH {
using namespace aa;

// A plane's border is filled: neighbours beyond the picture are its edge, without a test.
template <class R>
AA_INLINE R contrast(const float* luma, long stride) {
    const R c = load<R>(luma), w = load<R>(luma - 1), e = load<R>(luma + 1), n = load<R>(luma - stride),
            s = load<R>(luma + stride);
    return max(max(max(w, e), max(n, s)), c) - min(min(min(w, e), min(n, s)), c);
}
// The mean of five as difference from the centre: exactly 0 on flat ground. Opposite taps are paired, so that a
// mirrored or turned picture gives the mirrored or turned result to the last bit (tests/property/symmetry_test.cpp).
template <class R>
AA_INLINE R towardMean(const float* p, long stride) {
    const R c = load<R>(p);
    const R across = (load<R>(p - 1) - c) + (load<R>(p + 1) - c),
            down = (load<R>(p - stride) - c) + (load<R>(p + stride) - c);
    return (across + down) * R(Elem<R>(0.2));
}
// Rows [y0, y1): the host runs blocks of rows on several threads, so a kernel writes nothing outside of its rows.
template <class R>
__attribute__((flatten)) void spatialSkeletonRows(const SpatialSkeletonArgs& a, int y0, int y1) {
    const R threshold(Elem<R>(a.threshold)), strength(Elem<R>(a.strength));
    for (int y = y0; y < y1; y++)
        for (int x = 0; x < a.width; x += N<R>) {  // past the width lies padding: no masked tail
            const long o = long(y) * a.stride + x;
            const R range = contrast<R>(a.luma + o, a.stride);
            const Mask<R> edge = range >= threshold;  // false for NaN: the pixel stays as it is
            for (int c = 0; c < 3; c++) {
                const R own = load<R>(a.in.c[c] + o);
                const R filtered = own + strength * towardMean<R>(a.in.c[c] + o, a.stride);
                store(select(edge, filtered, own), a.out.c[c] + o);
            }
            if (a.contrast) store(range, a.contrast + o);
        }
}

}  // namespace AA_ARCH

// AA_ROWS: 4 or 8 pixels at a time; AA_WIDE_ROWS: up to 16, for kernels that compute much per pixel.
AA_DEFINE_TABLE(aa::SpatialSkeletonKernels, spatialSkeletonKernels) = {AA_WIDE_ROWS(spatialSkeletonRows)};
