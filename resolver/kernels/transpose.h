// Rows into columns: of texels, and of lanes for passes along x, whose neighbours are then whole registers.
// Include from *.kernel.cpp only.
#pragma once
#include "kernels/lanes.h"

namespace AA_ARCH {

// Four pixels' worth of one channel, or one texel.
using Four = VecOf<float, 4>::type;
AA_INLINE Four loadFour(const float* p) { return *(const VecOf<float, 4>::unaligned*)p; }
AA_INLINE void storeFour(Four v, float* p) { *(VecOf<float, 4>::unaligned*)p = v; }
// Rows become columns.
AA_INLINE void transpose(Four& a, Four& b, Four& c, Four& d) {
    const Four ab01 = __builtin_shufflevector(a, b, 0, 4, 1, 5), ab23 = __builtin_shufflevector(a, b, 2, 6, 3, 7);
    const Four cd01 = __builtin_shufflevector(c, d, 0, 4, 1, 5), cd23 = __builtin_shufflevector(c, d, 2, 6, 3, 7);
    a = __builtin_shufflevector(ab01, cd01, 0, 1, 4, 5), b = __builtin_shufflevector(ab01, cd01, 2, 3, 6, 7);
    c = __builtin_shufflevector(ab23, cd23, 0, 1, 4, 5), d = __builtin_shufflevector(ab23, cd23, 2, 3, 6, 7);
}

inline constexpr int kTileRows = 8;

// N<R> columns of kTileRows values each, one after the other, from as many rows of N<R> values.
template <class R>
AA_INLINE void storeTransposed(const R (&row)[kTileRows], Elem<R>* out) {
    if constexpr (N<R> == 1) {
        for (int y = 0; y < kTileRows; y++) out[y] = row[y];
    }
#ifdef __AVX2__
    else if constexpr (std::is_same_v<R, Lanes<float, 8>>) {
        __m256 two[8], four[8];
        for (int y = 0; y < 8; y += 2) {
            two[y] = _mm256_unpacklo_ps((__m256)row[y].v, (__m256)row[y + 1].v);
            two[y + 1] = _mm256_unpackhi_ps((__m256)row[y].v, (__m256)row[y + 1].v);
        }
        for (int y = 0; y < 8; y += 4)  // columns 0 and 4, 1 and 5, 2 and 6, 3 and 7 of four rows
            for (int i = 0; i < 2; i++) {
                four[y + 2 * i] = _mm256_shuffle_ps(two[y + i], two[y + i + 2], 0x44);
                four[y + 2 * i + 1] = _mm256_shuffle_ps(two[y + i], two[y + i + 2], 0xEE);
            }
        for (int x = 0; x < 4; x++) {
            _mm256_storeu_ps(out + 8 * x, _mm256_permute2f128_ps(four[x], four[x + 4], 0x20));
            _mm256_storeu_ps(out + 8 * (x + 4), _mm256_permute2f128_ps(four[x], four[x + 4], 0x31));
        }
    }
#endif
    else if constexpr (std::is_same_v<R, Lanes<float, 4>>) {
        for (int y = 0; y < 8; y += 4) {
            Four a = row[y].v, b = row[y + 1].v, c = row[y + 2].v, d = row[y + 3].v;
            transpose(a, b, c, d);
            storeFour(a, out + y), storeFour(b, out + 8 + y), storeFour(c, out + 16 + y), storeFour(d, out + 24 + y);
        }
    } else {
        for (int y = 0; y < kTileRows; y++)
            for (int x = 0; x < N<R>; x++) out[kTileRows * x + y] = row[y].v[x];
    }
}

// The way back: kTileRows columns of N<R> rows each to rows `from` .. `to` - 1 of a picture, of which `out` is the
// first pixel of row 0; a row's pixels are all written.
template <class R>
AA_INLINE void storeRows(const R (&column)[kTileRows], float* out, long stride, int from, int to) {
    Elem<R> tile[N<R> * kTileRows];
    storeTransposed(column, tile);
    for (int y = from < 0 ? 0 : from; y < N<R> && y < to; y++)
        for (int x = 0; x < kTileRows; x++) out[y * stride + x] = float(tile[y * kTileRows + x]);
}

}  // namespace AA_ARCH
