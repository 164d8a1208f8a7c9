// +fill=METHOD: the hybrid that [Stejmar n.d., 6.3.1] proposes.
//
// Where a temporal method did not use its history it shows the bare current sample. This stage replaces exactly those
// pixels by the result of a spatial or geometry-aware method on the same frame; all other pixels keep their bits. The
// history is not touched: the fill is an output stage. The filling method runs only on frames that have such pixels.
// When the two methods work in different spaces the fill is converted by the sRGB curve (no tone map; linear values
// above 1 that were clamped for an encoded method stay clamped).
#pragma once
#include "methods/stage.h"

namespace aa {
StageDescriptor fillStage();
}
