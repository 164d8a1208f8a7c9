// The order of an EXR's channels. The file lists them by name, B before G before R; here they come as OpenImageIO and
// the programs built on it show them: layer by layer, in each the usual letters first, then by name.
#pragma once
#include "image/exr.h"

namespace aa {

void orderChannels(std::vector<ExrChannel>& channels);

}  // namespace aa
