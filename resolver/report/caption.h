// What a run found, in plain sentences: which method is best and at what price, what hurts, what sharpening does, and
// what the truth cannot tell apart. Everything is computed from the figures.
#pragma once
#include <string>
#include <vector>

#include "study/results.h"

namespace aa {

std::vector<std::string> captions(const RunResults& run);

}  // namespace aa
