// PCG32, [O'Neill 2014], for resampling: std distributions differ between libraries, and the same input must give the
// same bits.
#pragma once
#include <cstddef>
#include <cstdint>

namespace aa {

class Pcg32 {
  public:
    // Uniform in [0, bound): the high bits of a 32 x 32 product; its bias of bound / 2^32 is below a millionth for the
    // thousands of tiles or participants that are drawn from.
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

}  // namespace aa
