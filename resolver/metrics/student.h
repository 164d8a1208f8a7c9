// Student's t distribution, where intervals need it.
#pragma once
#include <cassert>
#include <cstddef>

namespace aa {

// The 97.5 % quantile, which makes two-sided intervals of 95 %.
inline double student975(size_t freedom) {
    constexpr double kTable[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228,
                                 2.201,  2.179, 2.160, 2.145, 2.131, 2.120, 2.110, 2.101, 2.093, 2.086,
                                 2.080,  2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042};
    constexpr size_t kRows = sizeof kTable / sizeof *kTable;
    assert(freedom > 0);
    if (freedom <= kRows) return kTable[freedom - 1];
    // First two terms of its expansion about the normal distribution's [Abramowitz 1964, 26.7.5].
    constexpr double z = 1.959964;
    const double n = double(freedom);
    return z + z * (z * z + 1) / (4 * n) + z * (5 * z * z * z * z + 16 * z * z + 3) / (96 * n * n);
}

}  // namespace aa
