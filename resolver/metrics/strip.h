// What the windowed metric kernels share. They work in strips of columns, so that the rows under the window stay in the
// first two caches, and keep intermediate rows in the arithmetic's own precision.
#pragma once
#include "kernels/lanes.h"
#include "metrics/metrics_kernels.h"

namespace AA_ARCH {
using aa::kSumStrands;

// A strip jumps from row to row, which no processor foresees: without this, waiting for memory is half of the time.
constexpr int kRowsAhead = 4;
AA_INLINE void prefetch(const float* from, int count) {
    for (int i = 0; i < count; i += 16) __builtin_prefetch(from + i);  // 16 floats are a cache line
}
template <class R>
AA_INLINE R loadOwn(const Elem<R>* p) {  // storage in the arithmetic's own precision
    if constexpr (N<R> == 1)
        return *p;
    else
        return typename R::V(*(const typename R::Vu*)p);
}
// Eight partial sums by x mod 8 in double: the same additions in the same order for 1, 4 and 8 lanes.
template <class R>
struct Strands {
    static constexpr int kGroups = kSumStrands / N<R>;
    using Group = typename VecOf<double, N<R>>::type;
    Group sum[kGroups];
    Strands() {
        for (Group& g : sum) g = Group{};
    }
    // Adds the first `count` lanes; x is a multiple of N<R>.
    AA_INLINE void add(R value, int x, int count) {
        Group& g = sum[x / N<R> % kGroups];
        if constexpr (N<R> == 1)
            g[0] += double(value);
        else if (count >= N<R>)
            g += __builtin_convertvector(value.v, Group);
        else
            for (int i = 0; i < count; i++) g[i] += double(value.v[i]);
    }
    AA_INLINE void addTo(double* s) const {
        for (int i = 0; i < kSumStrands; i++) s[i] += sum[i / N<R>][i % N<R>];
    }
    AA_INLINE double total() const {
        const auto s = [&](int i) __attribute__((always_inline)) { return sum[i / N<R>][i % N<R>]; };
        return ((s(0) + s(1)) + (s(2) + s(3))) + ((s(4) + s(5)) + (s(6) + s(7)));
    }
};

}  // namespace AA_ARCH
