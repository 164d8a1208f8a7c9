#include "image/exr_layers.h"

#include <algorithm>
#include <map>

#include "image/error.h"
#include "image/lower_case.h"

namespace aa {
namespace {
// Views and passes may stand behind other dots: only the last parts the component from its layer.
std::string prefixOf(const std::string& channel) {
    const size_t dot = channel.rfind('.');
    return dot == std::string::npos ? "" : channel.substr(0, dot);
}
std::string letterOf(const std::string& channel) { return lowerCase(channel.substr(channel.rfind('.') + 1)); }
std::string lastWord(const std::string& name) { return name.substr(name.rfind('.') + 1); }

const std::string* withLetter(const ExrLayer& layer, std::initializer_list<const char*> letters) {
    for (const auto& c : layer.channels)
        for (const char* letter : letters)
            if (letterOf(c) == letter) return &c;
    return nullptr;
}
void findColour(ExrLayer& layer) {
    const std::string *r = withLetter(layer, {"r", "red"}), *g = withLetter(layer, {"g", "green"}),
                      *b = withLetter(layer, {"b", "blue"}), *a = withLetter(layer, {"a", "alpha"});
    if (r && g && b) layer.rgb = {*r, *g, *b};
    if (a) layer.alpha = *a;
}

std::string listed(const std::vector<ExrLayer>& layers) {
    constexpr size_t kMost = 12;
    std::string all;
    for (size_t i = 0; i < layers.size() && i < kMost; i++)
        all += (all.empty() ? "" : ", ") + std::string("'") + layers[i].name + "'";
    return all + (layers.size() > kMost ? " and " + std::to_string(layers.size() - kMost) + " more" : "");
}
// The only one for which `is` holds.
template <class Is>
const ExrLayer* only(const std::vector<ExrLayer>& layers, const Is& is) {
    const ExrLayer* found = nullptr;
    for (const auto& layer : layers)
        if (is(layer)) {
            if (found) return nullptr;
            found = &layer;
        }
    return found;
}
const ExrLayer* named(const std::vector<ExrLayer>& layers, const ExrFile& file, const std::string& asked) {
    if (const auto* l = only(layers, [&](const auto& x) { return x.name == asked; })) return l;
    if (const auto* l = only(layers, [&](const auto& x) { return lastWord(x.name) == asked; })) return l;
    if (const auto* l = only(layers, [&](const auto& x) { return file.parts()[x.part].name == asked; })) return l;
    return only(layers, [&](const auto& x) { return lowerCase(x.name) == lowerCase(asked); });
}
}  // namespace

std::vector<ExrLayer> layersOf(const ExrFile& file) {
    std::vector<ExrLayer> layers;
    for (size_t p = 0; p < file.parts().size(); p++) {
        const ExrPart& part = file.parts()[p];
        const size_t first = layers.size();
        for (const auto& c : part.channels) {
            const std::string prefix = prefixOf(c.name);
            const std::string name = !prefix.empty() ? prefix : !part.name.empty() ? part.name : "RGB";
            const auto same = std::find_if(layers.begin() + ptrdiff_t(first), layers.end(), [&](const auto& l) {
                return l.name == name && l.isPlain == prefix.empty();
            });
            if (same != layers.end())
                same->channels.push_back(c.name);
            else
                layers.push_back({name, p, prefix.empty(), {c.name}, {}, {}});
        }
    }
    std::map<std::string, int> count;
    for (const auto& l : layers) count[l.name]++;
    for (auto& l : layers) {
        findColour(l);
        const std::string& part = file.parts()[l.part].name;
        if (count[l.name] > 1) l.name = (part.empty() ? "part " + std::to_string(l.part) : part) + "/" + l.name;
    }
    return layers;
}

ExrLayer chooseLayer(const ExrFile& file, const std::string& asked) {
    const std::vector<ExrLayer> layers = layersOf(file);
    if (layers.empty()) throw InputError(file.path().string() + ": has no pixels");
    if (!asked.empty()) {
        if (const ExrLayer* l = named(layers, file, asked)) return *l;
        throw InputError(file.path().string() + ": has no layer '" + asked + "', or more than one that is called so; " +
                         "choose one of " + listed(layers) + " with --layer");
    }
    if (layers.size() == 1) return layers[0];
    const auto isColour = [](const ExrLayer& l) { return !l.rgb.empty(); };
    if (const auto* l = only(layers, [&](const auto& x) { return isColour(x) && x.isPlain; })) return *l;
    if (const auto* l = only(layers, [&](const auto& x) { return isColour(x) && lastWord(x.name) == "Combined"; }))
        return *l;
    if (const auto* l = only(layers, isColour)) return *l;
    throw InputError(file.path().string() + ": holds several layers and none that is clearly the picture; choose one " +
                     "with --layer: " + listed(layers));
}

}  // namespace aa
