#include "metrics/error_bar.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace aa {
namespace {
// PCG32, O'Neill 2014; std distributions differ between libraries, and the same input must give the same bits.
class Pcg32 {
  public:
    // Uniform in [0, bound): the high bits of a 32 x 32 product; its bias of bound / 2^32 is below a millionth here.
    size_t below(size_t bound) { return size_t((uint64_t(next()) * uint64_t(bound)) >> 32); }

  private:
    uint32_t next() {
        const uint64_t old = state_;
        state_ = old * 6364136223846793005ull + 1442695040888963407ull;
        const auto shifted = uint32_t(((old >> 18) ^ old) >> 27);
        const auto turn = uint32_t(old >> 59);
        return (shifted >> turn) | (shifted << ((32 - turn) & 31));
    }
    uint64_t state_ = 0x853c49e6748fea9bull;
};
}  // namespace

MseInterval mseInterval(double raw, double noise) { return {std::max(0.0, raw - noise), raw}; }

Comparison compareMethods(const TileErrors& first, const TileErrors& second, double noise) {
    assert(first.sum.size() == second.sum.size() && !first.sum.empty());
    constexpr size_t kResamples = 1000;  // methods/07 s.9
    const size_t tiles = first.sum.size();
    std::vector<double> difference(tiles);
    for (size_t i = 0; i < tiles; i++) difference[i] = first.sum[i] - second.sum[i];

    Comparison c;
    const double mseFirst = first.squaredError().mse, mseSecond = second.squaredError().mse;
    c.mseDifference = mseFirst - mseSecond;
    c.gainDb = mseFirst == mseSecond ? 0 : psnr(mseFirst) - psnr(mseSecond);

    Pcg32 random;
    std::vector<double> resampled(kResamples);
    for (double& mean : resampled) {
        double sum = 0, values = 0;
        for (size_t i = 0; i < tiles; i++) {
            const size_t tile = random.below(tiles);
            sum += difference[tile];
            values += first.values[tile];
        }
        mean = sum / values;
    }
    std::sort(resampled.begin(), resampled.end());
    c.low = resampled[size_t(0.025 * kResamples)];
    c.high = resampled[size_t(0.975 * kResamples) - 1];
    c.resolved = std::abs(c.mseDifference) > noise && (c.low > 0 || c.high < 0);
    return c;
}

}  // namespace aa
