// How the figures of a run were made, apart from its methods: the space in which images are compared, the history that
// methods had when they were judged, the rounding to 8-bit codes, the part of the picture and what it is held against.
#pragma once
#include <optional>
#include <string>

#include "image/colour.h"
#include "image/window.h"

namespace aa {

// History of the methods that accumulate at the first judged frame.
enum class History {
    first,  // none: the shot starts there
    ramp,   // none, and the first frames are averaged evenly (warmup=ramp) where a method can
    full,   // a static shot's frames ran for 10 periods of the jitter before (decisions 13)
};

struct Protocol {
    DisplayChain display;
    History history = History::first;
    bool eightBit = false;              // images that are compared are rounded to 8-bit codes
    std::optional<Window> region = {};  // figures are of these pixels alone; methods see the whole picture
    std::string reference = {};         // the method that the others are held against; empty: the shot's truth
};

const char* name(ToneMap map);
const char* name(Transfer transfer);
const char* name(History history);
// Throw std::runtime_error on other names.
ToneMap toneMapByName(const std::string& name);
Transfer transferByName(const std::string& name);
History historyByName(const std::string& name);

// "sRGB-encoded values, history from the first frame"; "displayed values, full history, 8-bit".
std::string inWords(const Protocol& protocol);
// Only the space: "sRGB-encoded values", "displayed values".
std::string spaceInWords(const Protocol& protocol);
// One field for tables: "display=identity exposure=0 toneMap=none history=full quantise=8", then "region=X,Y,W,H" and
// "reference=METHOD" where they are not the whole picture and the truth.
std::string inOneField(const Protocol& protocol);
// What figures are held against: "the ground truth", or "msaa (not the truth)".
std::string referenceInWords(const Protocol& protocol);

}  // namespace aa
