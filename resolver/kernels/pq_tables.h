// The perceptual quantiser of kernels/pq.h as cubics over equal parts of every octave of its argument.
#pragma once

namespace aa {

struct PqTables {
    // Linear light from 2^-64 on, below which it counts as black, to the 10000 of ST 2084; encoded values to 1.
    static constexpr int kEncodeFirst = -64, kEncodeOctaves = 78, kEncodeParts = 8;
    static constexpr int kDecodeFirst = -21, kDecodeOctaves = 22, kDecodeParts = 64;
    alignas(64) float encode[kEncodeOctaves * kEncodeParts * 4];
    alignas(64) float decode[kDecodeOctaves * kDecodeParts * 4];
    float black;  // encoded 0
};

}  // namespace aa
