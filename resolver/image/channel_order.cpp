#include "image/channel_order.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>
#include <tuple>

#include "image/lower_case.h"

namespace aa {
namespace {
std::string_view layerOf(std::string_view channel) { return channel.substr(0, channel.rfind('.') + 1); }
std::string_view letterOf(std::string_view channel) { return channel.substr(channel.rfind('.') + 1); }
// Y and Z are luminance and depth among colours, coordinates beside an X.
size_t rankOf(std::string_view letter, bool vector) {
    static constexpr std::array<std::string_view, 20> colour = {"r",    "red",  "g",  "green", "b",     "blue", "y",
                                                                "real", "imag", "a",  "alpha", "ar",    "ra",   "ag",
                                                                "ga",   "ab",   "ba", "z",     "depth", "zback"};
    static constexpr std::array<std::string_view, 21> position = {"r",  "red", "g",    "green", "b",  "blue",  "x",
                                                                  "y",  "z",   "real", "imag",  "a",  "alpha", "ar",
                                                                  "ra", "ag",  "ga",   "ab",    "ba", "depth", "zback"};
    const std::string word = lowerCase(letter);
    return vector ? size_t(std::find(position.begin(), position.end(), word) - position.begin())
                  : size_t(std::find(colour.begin(), colour.end(), word) - colour.begin());
}
}  // namespace

void orderChannels(std::vector<ExrChannel>& channels) {
    std::map<std::string, std::set<std::string>, std::less<>> letters;  // by layer
    for (const auto& c : channels) letters[std::string(layerOf(c.name))].insert(lowerCase(letterOf(c.name)));
    const auto key = [&](const ExrChannel& c) {
        const auto layer = layerOf(c.name), letter = letterOf(c.name);
        const auto& beside = letters.find(layer)->second;
        const bool vector = beside.contains("x") && (beside.contains("y") || beside.contains("z"));
        return std::tuple(layer, rankOf(letter, vector), letter);
    };
    std::sort(channels.begin(), channels.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
}

}  // namespace aa
