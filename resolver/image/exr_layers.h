// Which channels of an EXR are the picture that is meant: of many layers and parts one, by rules that do not depend on
// their order in the file.
#pragma once
#include <optional>

#include "image/exr.h"

namespace aa {

// The channels of one part whose names differ only behind the last dot.
struct ExrLayer {
    std::string name;     // what stands before that dot, else the part's name, else "RGB"; as --layer takes it
    size_t part = 0;      // of ExrFile::parts()
    bool isPlain = true;  // nothing stands before: R, not Combined.R
    std::vector<std::string> channels;  // in the order of image/channel_order.h
    std::vector<std::string> rgb;       // red, green and blue; empty where the layer is no colour
    std::optional<std::string> alpha;
};
// In the file's order; names that several parts share carry the part's before them: "left/Combined".
std::vector<ExrLayer> layersOf(const ExrFile& file);

// `asked`: a layer's name, its last word (Combined of ViewLayer.Combined) or a part's, where only one has it. Empty:
// the only layer, else the only plain colour, else the only colour called Combined, else the only colour. Throws
// InputError listing the layers: not there, or no rule tells which.
ExrLayer chooseLayer(const ExrFile& file, const std::string& asked);

}  // namespace aa
