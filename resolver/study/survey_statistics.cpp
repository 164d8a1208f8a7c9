#include "study/survey_statistics.h"

#include <algorithm>
#include <cmath>

namespace aa {
namespace {
// Mid-ranks from the lowest, 1.
std::vector<double> midRanks(const std::vector<double>& v) {
    std::vector<double> ranks;
    for (const double x : v) {
        const auto below = std::count_if(v.begin(), v.end(), [&](double y) { return y < x; });
        const auto equal = std::count(v.begin(), v.end(), x);
        ranks.push_back(double(below) + (double(equal) + 1) / 2);
    }
    return ranks;
}
}  // namespace

Estimate wilsonShare(double wins, size_t of) {
    if (of == 0) return {};
    const double n = double(of), share = wins / n;
    Estimate e{share, {}, {}};
    if (of < kFewestForIntervals) return e;
    constexpr double z = 1.959964;  // 97.5 % of the normal distribution
    const double middle = (share + z * z / (2 * n)) / (1 + z * z / n);
    const double half = z / (1 + z * z / n) * std::sqrt(share * (1 - share) / n + z * z / (4 * n * n));
    e.low = std::max(0.0, middle - half), e.high = std::min(1.0, middle + half);
    return e;
}

std::vector<double> bradleyTerry(const std::vector<std::vector<double>>& wins) {
    constexpr double kPrior = 0.5;
    constexpr int kRounds = 1000;
    constexpr double kStill = 1e-9;
    const size_t n = wins.size();
    const auto asked = [&](size_t a, size_t b) { return a != b && wins[a][b] + wins[b][a] > 0; };
    std::vector<double> strength(n, 1), scores(n, 0);
    for (int round = 0; round < kRounds; round++) {
        double change = 0, mean = 0;
        for (size_t a = 0; a < n; a++) {
            double won = 0, expected = 0;
            for (size_t b = 0; b < n; b++)
                if (asked(a, b)) {
                    won += wins[a][b] + kPrior;
                    expected += (wins[a][b] + wins[b][a] + 2 * kPrior) / (strength[a] + strength[b]);
                }
            if (expected > 0) strength[a] = won / expected;
        }
        for (const double s : strength) mean += std::log(s) / double(n);
        for (size_t a = 0; a < n; a++) {
            strength[a] /= std::exp(mean);
            change = std::max(change, std::abs(std::log(strength[a]) - scores[a]));
            scores[a] = std::log(strength[a]);
        }
        if (change < kStill) break;
    }
    return scores;
}

void RankSums::add(const std::vector<double>& x, const std::vector<double>& y) {
    for (size_t a = 0; a < x.size(); a++)
        for (size_t b = a + 1; b < x.size(); b++) {
            const int dx = (x[a] > x[b]) - (x[a] < x[b]), dy = (y[a] > y[b]) - (y[a] < y[b]);
            concordant += dx * dy, xPairs += dx != 0, yPairs += dy != 0, pairs++;
        }
    const auto rx = midRanks(x), ry = midRanks(y);
    const double mean = (double(x.size()) + 1) / 2;
    for (size_t a = 0; a < x.size(); a++) {
        xy += (rx[a] - mean) * (ry[a] - mean);
        xx += (rx[a] - mean) * (rx[a] - mean);
        yy += (ry[a] - mean) * (ry[a] - mean);
    }
}
std::optional<double> RankSums::kendall() const {
    return xPairs > 0 && yPairs > 0 ? std::optional(concordant / std::sqrt(xPairs * yPairs)) : std::nullopt;
}
std::optional<double> RankSums::spearman() const {
    return xx > 0 && yy > 0 ? std::optional(xy / std::sqrt(xx * yy)) : std::nullopt;
}

}  // namespace aa
