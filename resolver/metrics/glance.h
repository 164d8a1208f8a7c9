// What one pass over a picture tells: whether it holds numbers alone, its luma and its squared errors. A few rows at a
// time, so that the second to read them finds them in the cache: of a picture of 1920 x 1080, memory is most of what
// each of these costs.
#pragma once
#include <optional>

#include "metrics/measure.h"

namespace aa {

struct Glance {
    bool isFinite = true;              // `resolved` holds numbers alone
    PlaneF luma;                       // pictureLuma(shown), where it was asked for
    std::optional<TileErrors> errors;  // tileErrors(shown, *reference), where there is one
};
// `resolved`: as the method gave it; `shown`: after the display chain, the same picture or another.
Glance glance(const Rgb& resolved, const Rgb& shown, const Reference* reference, bool withLuma, const Exec& exec);

}  // namespace aa
