// Sparse work: a dense test in lanes marks pixels, the marked ones go on a list, scalar code runs on the list only.
// Included by *.kernel.cpp files after kernels/lanes.h.
#pragma once
#include "kernels/lanes.h"

namespace AA_ARCH {

inline constexpr int kSparseChunk = 512;  // pixels per list: a list on the stack that stays in the first-level cache

// Appends x + i for every set bit i of a lane mask; lanes at or past `width` are row padding and never appended.
// The list needs room for N<R> entries past its logical end.
AA_INLINE int append_marked(unsigned bits, int x, int width, int* list, int count) {
    if (width - x < 32) bits &= (1u << (width - x)) - 1u;
    while (bits) {
        list[count++] = x + __builtin_ctz(bits);
        bits &= bits - 1u;
    }
    return count;
}

}  // namespace AA_ARCH
