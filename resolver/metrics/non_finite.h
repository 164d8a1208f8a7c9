// Values that are no numbers, where pictures are measured: they are counted, and count as the largest difference that
// the display allows. A display encoding shows NaN as black and Inf as white, so that without this a broken picture
// would be a good one wherever the reference is black or white.
#pragma once
#include "image/plane.h"

namespace aa {

// Where `source`, of which `encoded` is the display encoding, or the reference's holds no number, `encoded` becomes 0
// or 1, whichever lies farther from the reference. Null: that one is known to hold numbers alone.
void putFarthest(const Rgb* source, const Rgb* referenceSource, const Rgb& reference, Rgb& encoded);

}  // namespace aa
