#pragma once

#include <cstdint>

namespace aa {

// SplitMix64 [Steele 2014]: good numbers from any seed at once, where an mt19937 first fills 2.5 KB of state. The same
// everywhere, unlike the distributions of <random>.
class SplitMix64 {
  public:
    explicit SplitMix64(uint64_t seed) : state_(seed) {}
    uint64_t next() {
        uint64_t z = state_ += 0x9E3779B97F4A7C15ull;
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9ull;
        z = (z ^ z >> 27) * 0x94D049BB133111EBull;
        return z ^ z >> 31;
    }
    float uniform() { return float(next() >> 40) * 0x1p-24f; }         // [0, 1)
    double uniformDouble() { return double(next() >> 11) * 0x1p-53; }  // [0, 1)

  private:
    uint64_t state_;
};

}  // namespace aa
