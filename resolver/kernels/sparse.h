// Sparse work: a dense test in lanes marks pixels, the marked ones go on a list, scalar code runs on the list only.
// Included by *.kernel.cpp files after kernels/lanes.h.
#pragma once
#include "kernels/lanes.h"

namespace AA_ARCH {

inline constexpr int kSparseChunk = 512;  // pixels per list: a list on the stack that stays in the first-level cache

// Appends x + i for every set bit i of a lane mask; lanes at or past `width` are row padding and never appended.
// The list needs room for N<R> entries past its logical end.
AA_INLINE int appendMarked(unsigned bits, int x, int width, int* list, int count) {
    if (width - x < 32) bits &= (1u << (width - x)) - 1u;
    while (bits) {
        list[count++] = x + __builtin_ctz(bits);
        bits &= bits - 1u;
    }
    return count;
}

// Calls visit(i) for every non-zero byte i of eight.
template <class Visit>
AA_INLINE void forEachByte(uint64_t bytes, const Visit& visit) {
    while (bytes) {
        const int i = __builtin_ctzll(bytes) >> 3;
        visit(i);
        bytes &= ~(uint64_t(0xff) << (8 * i));
    }
}
AA_INLINE uint64_t loadBytes(const uint8_t* p) {
    uint64_t v;
    __builtin_memcpy(&v, p, 8);
    return v;
}
// Lane mask pair -> one byte per pixel: bit 0 from a, bit 1 from b.
template <class R>
AA_INLINE void storeMaskBytes(Mask<R> a, Mask<R> b, uint8_t* p) {
    if constexpr (N<R> == 1)
        *p = uint8_t((a ? 1 : 0) | (b ? 2 : 0));
    else {
        typedef uint8_t Bytes __attribute__((vector_size(N<R>)));
        const Bytes bytes = __builtin_convertvector((a & 1) | (b & 2), Bytes);
        __builtin_memcpy(p, &bytes, N<R>);
    }
}

}  // namespace AA_ARCH
