// White noise by place and time, the same on every machine. Include from *.kernel.cpp only.
#pragma once
#include "kernels/lanes.h"

namespace AA_ARCH {

// A bijection of 32-bit words whose output bits each depend on every input bit ([Wellons 2018], lowbias32).
template <class U>
AA_INLINE U mixedBits(U h) {
    h ^= h >> 16;
    h *= 0x7feb352du;
    h ^= h >> 15;
    h *= 0x846ca68bu;
    return h ^ (h >> 16);
}
// Drawn independently: a seed holds 2 frame + stream, so that those above 1 meet others in no frame before 2^30.
enum class NoiseStream : uint32_t { historyDither, motionBlur, outputDither = 0x80000000u };
AA_INLINE uint32_t noiseSeed(NoiseStream stream, uint32_t frame, uint32_t row) {
    return mixedBits(mixedBits(frame * 2u + uint32_t(stream)) + row);
}
// In [0, 1), multiples of 2^-24, for counters first, first + 1, ... in the lanes.
template <class R>
AA_INLINE R noise(uint32_t seed, uint32_t first) {
    using T = Elem<R>;
    if constexpr (N<R> == 1)
        return R(T(mixedBits(seed + first) >> 8) * T(0x1p-24));
    else {
        typename WordsOf<N<R>>::type counter;
        for (int i = 0; i < N<R>; i++) counter[i] = first + uint32_t(i);
        const auto h = mixedBits(counter + seed) >> 8;
        return R(__builtin_convertvector(typename IntsOf<N<R>>::type(h), typename R::V)) * R(T(0x1p-24));
    }
}

}  // namespace AA_ARCH
