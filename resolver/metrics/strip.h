// What the windowed metric kernels share. They work in strips of columns, so that the rows under the window stay in the
// first two caches, and keep intermediate rows in the arithmetic's own precision.
#pragma once
#include "kernels/lanes.h"
#include "metrics/metrics_kernels.h"

namespace AA_ARCH {
using aa::kSumStrands;

template <class R>
AA_INLINE R loadOwn(const Elem<R>* p) {  // storage in the arithmetic's own precision
    if constexpr (N<R> == 1)
        return *p;
    else
        return typename R::V(*(const typename R::Vu*)p);
}
// A value for each of two places side by side: their windows share most of what they read.
template <class R>
struct Two {
    R first, second;
    friend AA_INLINE Two operator+(Two a, Two b) { return {a.first + b.first, a.second + b.second}; }
    friend AA_INLINE Two operator-(Two a, Two b) { return {a.first - b.first, a.second - b.second}; }
    friend AA_INLINE Two operator*(Two a, double b) { return {a.first * R(Elem<R>(b)), a.second * R(Elem<R>(b))}; }
};
// A value's lanes as doubles, in halves: GCC 12 moves vectors of doubles that are wider than a register through memory,
// piece by piece.
template <class R>
struct Doubles {
    static constexpr int kHalf = N<R> == 1 ? 1 : N<R> / 2;
    using Half = typename VecOf<double, kHalf>::type;
    Half low, high;
    AA_INLINE Doubles(R r) {
        if constexpr (N<R> == 1) low = high = Half{} + double(r);
#ifdef __AVX2__
        else if constexpr (std::is_same_v<R, Lanes<float, 8>>)
            low = (Half)_mm256_cvtps_pd(_mm256_castps256_ps128((__m256)r.v)),
            high = (Half)_mm256_cvtps_pd(_mm256_extractf128_ps((__m256)r.v, 1));
#endif
        else
            for (int i = 0; i < kHalf; i++) low[i] = double(r.v[i]), high[i] = double(r.v[i + kHalf]);
    }
    AA_INLINE Doubles(Half l, Half h) : low(l), high(h) {}
    friend AA_INLINE Doubles operator-(Doubles a, Doubles b) { return {a.low - b.low, a.high - b.high}; }
    friend AA_INLINE Doubles operator*(Doubles a, Doubles b) { return {a.low * b.low, a.high * b.high}; }
    friend AA_INLINE Doubles abs(Doubles a) {
        return {a.low < Half{} ? -a.low : a.low, a.high < Half{} ? -a.high : a.high};
    }
};
// A sum in double for each lane.
template <class R>
struct RowSums {
    using Half = typename Doubles<R>::Half;
    Half low{}, high{};
    AA_INLINE void add(R value) {
        const Doubles<R> d(value);
        low += d.low, high += d.high;
    }
    AA_INLINE double of(int lane) const {
        constexpr int half = Doubles<R>::kHalf;
        return lane < half ? low[lane % half] : high[lane % half];
    }
};
// Eight partial sums by x mod 8 in double: the same additions in the same order for 1, 4 and 8 lanes.
template <class R>
struct Strands {
    static constexpr int kHalf = Doubles<R>::kHalf, kHalves = kSumStrands / kHalf;
    typename Doubles<R>::Half sum[kHalves];
    Strands() {
        for (auto& h : sum) h = typename Doubles<R>::Half{};
    }
    // x is a multiple of N<R>.
    AA_INLINE void add(Doubles<R> value, int x) {
        auto* const s = sum + x / kHalf % kHalves;
        s[0] += value.low;
        if constexpr (N < R >> 1) s[1] += value.high;
    }
    // Adds the first `count` lanes.
    AA_INLINE void add(R value, int x, int count) {
        if constexpr (N < R >> 1)
            if (count < N<R>) value = select(iota<R>() < R(Elem<R>(count)), value, R(Elem<R>(0)));
        add(Doubles<R>(value), x);
    }
    AA_INLINE void addTo(double* s) const {
        for (int i = 0; i < kSumStrands; i++) s[i] += sum[i / kHalf][i % kHalf];
    }
    AA_INLINE double total() const {
        const auto s = [&](int i) __attribute__((always_inline)) { return sum[i / kHalf][i % kHalf]; };
        return ((s(0) + s(1)) + (s(2) + s(3))) + ((s(4) + s(5)) + (s(6) + s(7)));
    }
};

}  // namespace AA_ARCH
