#include "study/protocol.h"

#include <array>
#include <cstdio>
#include <stdexcept>

namespace aa {
namespace {
constexpr std::array kToneMaps = {"none", "reinhard", "aces"};  // in the order of ToneMap
constexpr std::array kTransfers = {"srgb", "identity"};         // of Transfer
constexpr std::array kHistories = {"first", "ramp", "full"};    // of History

template <class Enum, size_t n>
Enum byName(const std::array<const char*, n>& names, const std::string& name, const char* what) {
    for (size_t i = 0; i < n; i++)
        if (name == names[i]) return Enum(i);
    throw std::runtime_error("unknown " + std::string(what) + " '" + name + "'");
}
std::string number(float v) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", double(v));
    return text;
}
}  // namespace

const char* name(ToneMap map) { return kToneMaps[size_t(map)]; }
const char* name(Transfer transfer) { return kTransfers[size_t(transfer)]; }
const char* name(History history) { return kHistories[size_t(history)]; }
ToneMap toneMapByName(const std::string& name) { return byName<ToneMap>(kToneMaps, name, "tone map"); }
Transfer transferByName(const std::string& name) { return byName<Transfer>(kTransfers, name, "display transfer"); }
History historyByName(const std::string& name) { return byName<History>(kHistories, name, "history"); }

std::string spaceInWords(const Protocol& p) {
    return p.display.transfer == Transfer::identity ? "displayed values" : "sRGB-encoded values";
}
std::string inWords(const Protocol& p) {
    std::string s = spaceInWords(p);
    if (p.display.exposure != 0) s += (p.display.exposure > 0 ? " at +" : " at ") + number(p.display.exposure) + " EV";
    if (p.display.toneMap != ToneMap::none) s += std::string(", tone map ") + name(p.display.toneMap);
    s += p.history == History::full   ? ", full history"
         : p.history == History::ramp ? ", history ramped up from the first frame"
                                      : ", history from the first frame";
    if (p.eightBit) s += ", 8-bit";
    if (p.region) s += ", region of " + inWords(*p.region);
    if (!p.reference.empty()) s += ", against " + referenceInWords(p);
    return s;
}
std::string inOneField(const Protocol& p) {
    std::string region;
    if (const auto& r = p.region)
        for (const int v : {r->x, r->y, r->width, r->height})
            region += (region.empty() ? " region=" : ",") + std::to_string(v);
    return std::string("display=") + name(p.display.transfer) + " exposure=" + number(p.display.exposure) +
           " toneMap=" + name(p.display.toneMap) + " history=" + name(p.history) +
           " quantise=" + (p.eightBit ? "8" : "off") + region +
           (p.reference.empty() ? "" : " reference=" + p.reference);
}
std::string referenceInWords(const Protocol& p) {
    return p.reference.empty() ? "the ground truth" : p.reference + " (not the truth)";
}

}  // namespace aa
