// How a kernel's options become constants of its loop, and its steps loops of their own; include from *.kernel.cpp
// only.
#pragma once
#include "kernels/lanes.h"

namespace AA_ARCH {

// Options that every read of a window depends on. Lanes get one copy of a kernel per combination, so that nothing but
// the chosen one is in its loop; the one-lane forms, which no one waits for, decide at run time. Same text for all:
// withOptions(run, f1, f2, ...) calls run(Fixed<f1>{}, Fixed<f2>{}, ...) or run(f1, f2, ...).
template <bool value>
struct Fixed {
    AA_INLINE constexpr operator bool() const { return value; }
};
template <class Run>
AA_INLINE void withFixed(const Run& run) {
    run();
}
template <class Run, class... Rest>
AA_INLINE void withFixed(const Run& run, bool flag, Rest... rest) {
    const auto bind = [&](auto fixed) __attribute__((always_inline)) {
        withFixed(
            [&](auto... others) __attribute__((always_inline)) { run(fixed, others...); }, rest...);
    };
    flag ? bind(Fixed<true>{}) : bind(Fixed<false>{});
}
template <class R, class Run, class... Flags>
AA_INLINE void withOptions(const Run& run, Flags... flags) {
    if constexpr (N<R> == 1)
        run(flags...);
    else
        withFixed(run, flags...);
}

// One step after the other over some groups of N pixels, instead of all steps of one group: a pixel's steps depend on
// each other, from motion over history and box to the blend, for longer than a processor looks ahead, so that it would
// wait where the next pixels could be computed. step(i, x): group i of those at hand, from column x.
inline constexpr int kStepGroups = 8;
template <class R, class... Steps>
AA_INLINE void inSteps(int width, const Steps&... steps) {
    for (int x0 = 0; x0 < width; x0 += kStepGroups * N<R>) {
        const int left = (width - x0 + N<R> - 1) / N<R>, groups = left < kStepGroups ? left : kStepGroups;
        const auto run = [&](const auto& step) __attribute__((always_inline)) {
#pragma GCC unroll 1
            for (int i = 0; i < groups; i++) step(i, x0 + i * N<R>);
        };
        (run(steps), ...);
    }
}

}  // namespace AA_ARCH
