// The learned offsets that ship with the program, made by `aaresolve learn-rsaa -o
// resolver/methods/geometry/rsaa_lut_data.cpp`. rsaa_learn_test learns them again and compares every entry.
#pragma once
#include <span>
#include <string>

#include "methods/geometry/rsaa_learn.h"

namespace aa {
// For the D3D11 patterns of 4, 8 and 16 sub-samples; empty for other sizes.
std::span<const RsaaEntry> shippedRsaaEntries(size_t samples);
// The text of rsaa_lut_data.cpp, learned now.
std::string learnedRsaaSource();
}  // namespace aa
