// Pictures that are neither PNG nor EXR (TIFF, JPEG, HDR, DPX, TGA, WebP ...), through the module aaresolve_formats.so.
//
// OpenImageIO, which reads them, brings hundreds of shared libraries; so it is loaded when such a file is named and not
// before. The module is looked for beside the program, in ../lib/aaresolve from there, and at $AARESOLVE_FORMATS.
#pragma once
#include "image/stored_picture.h"

namespace aa {

// Throws InputError: not a picture, truncated, larger than kLargestSide, no module.
StoredPicture readOtherFormat(const std::filesystem::path& file);

}  // namespace aa
