#include "kernels/hash.h"
#include "methods/temporal/temporal_reprojection.kernel.h"
#include "methods/temporal/temporal_sharpen.kernel.h"

namespace AA_ARCH {

template <class R>
__attribute__((flatten)) void sharpenHistoryRows(const SharpenHistoryArgs& a, int y0, int y1) {
    const long rowStep = 4l * a.stride;
    for (int y = y0; y < y1; y++) {
        const float* row = a.rgba + y * rowStep;
        sharpenRow<R>(row - rowStep, row, row + rowStep, a.gain, a.out, long(y) * a.stride, a.width);
    }
}

// binary16 and back: to nearest even, or, with `chance` in [0, 1), up in that share of cases which keeps the mean.
AA_INLINE float asHalf(float x, bool dither, float chance) {
    const float held = min(max(x, -65504.0f), 65504.0f);  // NaN: the history is finite (sanitised())
    if (abs(held) < 0x1p-14f) {                           // subnormal: multiples of 2^-24
        const float units = held * 0x1p24f;
        const float whole = dither ? floor(units + chance) : (units + 0x1.8p23f) - 0x1.8p23f;
        return whole * 0x1p-24f;
    }
    uint32_t bits;
    std::memcpy(&bits, &held, 4);
    bits += dither ? uint32_t(chance * 8192.0f) : 0xfffu + ((bits >> 13) & 1u);
    bits &= ~0x1fffu;
    float half;
    std::memcpy(&half, &bits, 4);
    return min(max(half, -65504.0f), 65504.0f);
}
// Codes of 1/255; the dither is INSIDE's: +- half a code before the store.
AA_INLINE float asByte(float x, bool dither, float chance) {
    return min(floor(saturate(x) * 255.0f + (dither ? chance : 0.5f)), 255.0f) / 255.0f;
}
// An emulation of narrower storage, so float in every precision.
template <class R>
__attribute__((flatten)) void narrowHistoryRows(const NarrowHistoryArgs& a, int y0, int y1) {
    for (int y = y0; y < y1; y++) {
        const uint32_t seed = noiseSeed(NoiseStream::historyDither, a.frame, uint32_t(y));
        float* p = a.rgba + 4l * y * a.stride;
        for (int i = 0; i < 4 * a.width; i++) {
            if (i % 4 == 3) continue;
            const float chance = a.dither ? noise<float>(seed, uint32_t(i)) : 0.0f;
            p[i] = a.format == HistoryFormat::half ? asHalf(p[i], a.dither, chance) : asByte(p[i], a.dither, chance);
        }
    }
}

// Rows are multiples of N long (image/plane.h), so there is no tail.
template <class R>
__attribute__((flatten)) void unjitterRows(const UnjitterArgs& a, int y0, int y1) {
    const UniformFetch<R> fetch(a.xPx, a.yPx);
    for (int y = y0; y < y1; y++) {
        const long from = long(y) * a.stride - a.border, to = long(y - y0) * a.stride;
        for (int c = 0; c < 3; c++)
            for (int x = 0; x < a.stride; x += N<R>) store(fetch(a.in.c[c] + from + x, a.stride), a.out.c[c] + to + x);
    }
}

}  // namespace AA_ARCH

AA_DEFINE_TABLE(aa::TemporalKernels, temporalKernels) = {AA_WIDE_ROWS(sharpenHistoryRows), AA_ROWS(narrowHistoryRows),
                                                         AA_WIDE_ROWS(unjitterRows)};
