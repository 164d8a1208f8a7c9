// The 256 colours of a GIF.
#pragma once
#include <array>
#include <span>
#include <vector>

namespace aa {

struct Paletted {
    std::vector<unsigned char> palette;              // R G B of each colour, at most 256
    std::vector<std::vector<unsigned char>> frames;  // indices
};
// One palette for all pictures, so that what stays the same does not change its colour: exact where they have no more
// than 256 colours together, else by median cut [Heckbert 1982]: the box with the greatest sum of squared distances
// from its mean is split at that mean, along its most spread channel, until there are 256. Codes R G B R G B ...
Paletted paletted(std::span<const std::vector<unsigned char>> pictures);

}  // namespace aa
