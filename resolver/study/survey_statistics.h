// The statistics behind a survey's scores: shares with intervals, scores from pairs, rank correlation.
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

namespace aa {

// Below, even votes that all agree do not reach 5 % in a two-sided sign test: 2 / 2^5, but 2 / 2^6.
inline constexpr size_t kFewestForIntervals = 6;

struct Estimate {
    double value = 0;
    std::optional<double> low, high;  // 95 %
};
// The interval of [Wilson 1927] of a share of `of`; absent below kFewestForIntervals.
Estimate wilsonShare(double wins, size_t of);

// Scores of the model of [Bradley 1952] from wins[a][b], how often a beat b: P(a beats b) = 1 / (1 + exp(s_b - s_a)),
// sum 0, fitted as in [Hunter 2004] with half a win added on either side of every pair that was asked.
std::vector<double> bradleyTerry(const std::vector<std::vector<double>>& wins);

// Kendall's tau b and Spearman's rho as sums, which add up over sets: tau then counts pairs within sets, rho correlates
// ranks within sets.
struct RankSums {
    double concordant = 0, xPairs = 0, yPairs = 0;  // less the discordant; pairs that differ in x, in y
    double xy = 0, xx = 0, yy = 0;                  // of ranks about their mean
    size_t pairs = 0;
    void add(const std::vector<double>& x, const std::vector<double>& y);
    // Absent where x or y is the same everywhere.
    std::optional<double> kendall() const;
    std::optional<double> spearman() const;
};

}  // namespace aa
