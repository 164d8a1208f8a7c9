// Animated PNG: PNG's own chunks and three more [W3C 2025, 11.3.6]. libpng writes each picture; what was
// compressed is put together again, so that a viewer that knows no animation shows the first one.
#pragma once
#include <span>
#include <vector>

namespace aa {

// Pictures of one size, codes R G B R G B ... of 8 bits, each shown for `milliseconds` (1 to 65535), for ever.
std::vector<unsigned char> apngBytes(std::span<const std::vector<unsigned char>> frames, int width, int height,
                                     int milliseconds);

}  // namespace aa
