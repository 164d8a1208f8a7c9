// The contact sheet: one PNG with a row per method (ground truth first, then from best to worst PSNR, noaa last) and
// the columns full frame, magnified details where the methods differ most, and the error map on one fixed scale.
#pragma once
#include "report/gallery.h"

namespace aa {

// Methods as indices in the order of every table and sheet: best to worst pooled PSNR, noaa last; methods without
// figures keep their order before it.
std::vector<size_t> presentationOrder(const RunResults& run);

// Throws InputError: cannot be written, no font.
void writeSheet(const RunResults& run, const Pictures& pictures, const std::filesystem::path& file, const Exec& exec);

}  // namespace aa
