// Pictures of where, or at which frequencies, two images differ. One row per kind: `compare --map-of`, `run --maps`,
// and what is said of its scale. Every scale is fixed, so that maps of different methods, frames and runs can be laid
// side by side.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "image/plane.h"
#include "kernels/dispatch.h"

namespace aa {

struct MapKind {
    std::string_view name;
    std::string_view scale;  // what a pixel shows, and from which value to which
    // Of two encoded images of one size with filled borders; a picture of their size.
    Rgb (*draw)(const Rgb& test, const Rgb& reference, const Exec& exec);
    // Of a metric of a sequence: its first figure, and a picture of what SequenceTest::latestMap gives. There `draw`
    // takes the two images as stills.
    std::string_view sequenceFigure = {};
    Rgb (*drawValues)(const PlaneF& values) = nullptr;
};
const std::vector<MapKind>& mapKinds();
const MapKind& mapKindByName(std::string_view name);  // throws UsageError: unknown, with those that there are
std::string listOfMapKinds();                         // for help: "\n  name  scale"

// Mean over the channels of (T - R)^2 of one pixel.
double squaredDifference(const Rgb& test, const Rgb& reference, int x, int y);
// Root mean square over the channels of (T - R), encoded units.
PlaneF errorMap(const Rgb& test, const Rgb& reference);
// The one scale of every error map: black at 0, lightest at this error or more (0.2 = 51 of 255 codes).
inline constexpr double kErrorScale = 0.2;
// An error map as a picture: errorColour() on that scale.
Rgb colouredError(const PlaneF& error);

}  // namespace aa
