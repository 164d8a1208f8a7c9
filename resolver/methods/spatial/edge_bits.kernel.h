// Reading edge bits (methods/spatial/edgeBits.h): runs and neighbourhoods without a loop per pixel.
#pragma once
#include "kernels/lanes.h"

namespace AA_ARCH {

inline constexpr int kWindow = 57;  // bits that an unaligned word shifted by up to 7 is sure to hold

// Pixels p, p + 1, ... of a row in the lowest bits; at least kWindow of them.
AA_INLINE uint64_t bitsFrom(const uint8_t* row, int p) {
    uint64_t w;
    __builtin_memcpy(&w, row + (p >> 3), 8);
    return w >> (p & 7);
}
AA_INLINE bool bitAt(const uint8_t* row, int p) { return row[p >> 3] >> (p & 7) & 1; }

// A line follows `along` until `cross0` or `cross1` crosses it. How many more pixels it goes on beyond p, up to `cap`.
AA_INLINE int runUp(const uint8_t* along, const uint8_t* cross0, const uint8_t* cross1, int p, int cap) {
    for (int n = 0;; n += kWindow) {
        const int q = p + 1 + n;
        const uint64_t goesOn = bitsFrom(along, q) & ~(bitsFrom(cross0, q) | bitsFrom(cross1, q));
        const int k = __builtin_ctzll(~goesOn | uint64_t(1) << kWindow);
        if (k < kWindow || n + k >= cap) return n + k < cap ? n + k : cap;
    }
}
// The same toward smaller p. The pixel at which the line is crossed belongs to it, as it lies before the crossing edge.
AA_INLINE int runDown(const uint8_t* along, const uint8_t* cross0, const uint8_t* cross1, int p, int cap) {
    for (int n = 0;; n += kWindow) {
        const int q = p - n - (kWindow - 1);  // the window ends at p - n
        const uint64_t goesOn = bitsFrom(along, q - 1) & ~(bitsFrom(cross0, q) | bitsFrom(cross1, q));
        const int k = __builtin_clzll(~(goesOn << (64 - kWindow)) | uint64_t(1) << (63 - kWindow));
        if (k < kWindow || n + k >= cap) return n + k < cap ? n + k : cap;
    }
}
// Calls visit(x) for every set bit below `width`; `word(x)` gives the 64 bits from x on (kWindow are used).
template <class Word, class Visit>
AA_INLINE void forEachBit(int width, const Word& word, const Visit& visit) {
    for (int x0 = 0; x0 < width; x0 += 56) {
        uint64_t bits = word(x0) & ((uint64_t(1) << 56) - 1);
        if (width - x0 < 56) bits &= (uint64_t(1) << (width - x0)) - 1;
        for (; bits; bits &= bits - 1) visit(x0 + __builtin_ctzll(bits));
    }
}

// Bytes of 8 rows of 8 bits -> 8 columns of 8 bits.
AA_INLINE uint64_t transposed8x8(uint64_t b) {
    uint64_t t = (b ^ b >> 7) & 0x00AA00AA00AA00AAull;
    b ^= t ^ t << 7;
    t = (b ^ b >> 14) & 0x0000CCCC0000CCCCull;
    b ^= t ^ t << 14;
    t = (b ^ b >> 28) & 0x00000000F0F0F0F0ull;
    return b ^ t ^ t << 28;
}

}  // namespace AA_ARCH
