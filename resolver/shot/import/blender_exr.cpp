#include "shot/import/blender_exr.h"

#include <algorithm>
#include <tuple>

#include "image/error.h"

namespace aa {
namespace {
const std::vector<BlenderPassInfo>& table() {
    static const std::vector<BlenderPassInfo> passes = {
        {BlenderPass::combined, {"Combined"}, 3, "Passes > Data > Combined"},
        {BlenderPass::depth, {"Depth"}, 1, "Passes > Data > Z"},
        {BlenderPass::normal, {"Normal"}, 3, "Passes > Data > Normal"},
        {BlenderPass::vector, {"Vector"}, 2, "Passes > Data > Vector, with motion blur off"},
        {BlenderPass::objectIndex, {"IndexOB", "Object Index"}, 1, "Passes > Data > Indexes > Object Index"},
        {BlenderPass::cryptoObject, {"CryptoObject00"}, 1, "Passes > Cryptomatte > Object"},
        {BlenderPass::denoisingAlbedo, {"Denoising Albedo"}, 3, "Passes > Data > Denoising Data"},
        {BlenderPass::diffuseColor, {"DiffCol", "Diffuse Color"}, 3, "Passes > Light > Diffuse > Color"},
        {BlenderPass::glossyColor, {"GlossCol", "Glossy Color"}, 3, "Passes > Light > Glossy > Color"},
        {BlenderPass::transmissionColor,
         {"TransCol", "Transmission Color"},
         3,
         "Passes > Light > Transmission > Color"},
        {BlenderPass::emission, {"Emit", "Emission"}, 3, "Passes > Light > Emission"},
        {BlenderPass::environment, {"Env", "Environment"}, 3, "Passes > Light > Environment"},
    };
    return passes;
}

// Component letters in the order in which planes are given. Depth is Z, an index X, either V in some versions.
std::string_view letters(BlenderPass pass, size_t component) {
    static constexpr std::string_view colours[] = {"R", "G", "B"}, vectors[] = {"X", "Y", "Z"};
    switch (pass) {
        case BlenderPass::depth:
            return "ZVXR";
        case BlenderPass::objectIndex:
            return "XVR";
        case BlenderPass::cryptoObject:
            return "R";
        case BlenderPass::normal:
        case BlenderPass::vector:
            return vectors[component];
        default:
            return colours[component];
    }
}

std::string listed(const std::vector<std::string>& names) {
    std::string s;
    for (const auto& n : names) s += (s.empty() ? "'" : ", '") + n + "'";
    return s;
}

// "LAYER.PASS" or "LAYER.PASS.VIEW" with a known pass; layers may hold dots, and be called like a pass. Hence from the
// right: a pass at the end is meant before one with a view behind it.
std::optional<BlenderChannel> understand(const std::string& stem) {
    std::optional<BlenderChannel> best;
    std::tuple<bool, size_t, size_t> bestRank;  // the pass ends the name; its length; where it begins
    for (const auto& info : table())
        for (const auto passName : info.names) {
            const std::string infix = "." + std::string(passName);
            for (size_t at = stem.find(infix); at != std::string::npos; at = stem.find(infix, at + 1)) {
                const std::string rest = stem.substr(at + infix.size());
                const bool isView = rest.size() > 1 && rest[0] == '.' && rest.find('.', 1) == std::string::npos;
                const std::tuple rank(rest.empty(), infix.size(), at);
                if (at == 0 || !(rest.empty() || isView) || (best && rank < bestRank)) continue;
                bestRank = rank;
                best = BlenderChannel{stem.substr(0, at), isView ? rest.substr(1) : "", info.pass, 'R', 0, ""};
            }
        }
    return best;
}
}  // namespace

const BlenderPassInfo& blenderPass(BlenderPass pass) {
    return *std::find_if(table().begin(), table().end(), [&](const auto& i) { return i.pass == pass; });
}

BlenderExr::BlenderExr(const std::filesystem::path& file) : file_(file) {
    if (file_.parts().empty()) throw InputError(file.string() + ": holds no picture; render the frame again");
    targets_.resize(file_.parts().size());
    for (size_t p = 0; p < file_.parts().size(); p++) {
        const ExrPart& part = file_.parts()[p];
        for (const auto& c : part.channels) {
            const size_t dot = c.name.rfind('.');
            const std::string letter = dot == std::string::npos ? c.name : c.name.substr(dot + 1);
            // A part of its own per pass may carry the name of the pass that its channels then lack.
            std::string stem = dot == std::string::npos ? part.name : c.name.substr(0, dot);
            if (letter.size() != 1) continue;
            auto known = understand(stem);
            if (!known && dot != std::string::npos && !part.name.empty()) known = understand(part.name + "." + stem);
            if (!known) continue;
            known->component = char(std::toupper(static_cast<unsigned char>(letter[0])));
            known->part = p;
            known->channel = c.name;
            channels_.push_back(*known);
        }
    }
}

std::optional<std::string> BlenderExr::text(const std::string& name) const {
    for (const auto& part : file_.parts())
        if (const auto it = part.texts.find(name); it != part.texts.end()) return it->second;
    return std::nullopt;
}

std::vector<std::string> BlenderExr::layers() const {
    std::vector<std::string> r;
    for (const auto& c : channels_)
        if ((c.pass == BlenderPass::combined || c.pass == BlenderPass::depth) &&
            std::find(r.begin(), r.end(), c.layer) == r.end())
            r.push_back(c.layer);
    if (r.size() > 1) std::erase(r, "Composite");  // the compositor's result beside the layers that it was made of
    return r;
}

std::vector<std::string> BlenderExr::views(const std::string& layer) const {
    std::vector<std::string> r;
    for (const auto& c : channels_)
        if (c.layer == layer && std::find(r.begin(), r.end(), c.view) == r.end()) r.push_back(c.view);
    return r;
}

void BlenderExr::choose(const std::string& layer, const std::string& view) {
    const auto pick = [&](const char* option, const char* what, const std::string& asked,
                          const std::vector<std::string>& there) {
        if (asked.empty() && there.size() == 1) return there[0];
        if (!asked.empty() && std::find(there.begin(), there.end(), asked) != there.end()) return asked;
        throw UsageError(path().string() + ": holds the " + what + " " + listed(there) +
                         (asked.empty() ? "" : " but not '" + asked + "'") + "; choose one with " + option);
    };
    const auto all = layers();
    if (all.empty()) {
        std::string found;
        for (const auto& part : file_.parts())
            for (const auto& c : part.channels)
                if (found.size() < 60) found += (found.empty() ? "" : " ") + c.name;
        throw InputError(path().string() +
                         ": expected channels of Blender's OpenEXR MultiLayer (ViewLayer.Combined.R), "
                         "found " +
                         found + "; render with the output format OpenEXR MultiLayer");
    }
    layer_ = pick("--view-layer", "view layers", layer, all);
    view_ = pick("--view", "views", view, views(layer_));
}

const BlenderChannel* BlenderExr::find(BlenderPass pass, size_t component) const {
    for (const char letter : letters(pass, component))
        for (const auto& c : channels_)
            if (c.pass == pass && c.layer == layer_ && c.view == view_ && c.component == letter) return &c;
    return nullptr;
}

bool BlenderExr::has(BlenderPass pass) const {
    for (size_t i = 0; i < blenderPass(pass).components; i++)
        if (!find(pass, i)) return false;
    return true;
}

const ExrChannel* BlenderExr::channelOf(BlenderPass pass, size_t component) const {
    const BlenderChannel* c = find(pass, component);
    return c ? file_.parts()[c->part].find(c->channel) : nullptr;
}

void BlenderExr::want(BlenderPass pass, std::vector<std::variant<PlaneF*, PlaneU*>> planes) {
    for (size_t i = 0; i < planes.size(); i++) {
        const BlenderChannel* c = find(pass, i);
        if (!c)
            throw InputError(path().string() + ": view layer '" + layer_ + "' has no pass '" +
                             std::string(blenderPass(pass).names[0]) +
                             "', which other frames have; render the frame again");
        targets_[c->part].push_back({c->channel, planes[i]});
    }
}

void BlenderExr::wantPlain(Rgb& rgb) {
    for (size_t i = 0; i < 3; i++) targets_[0].push_back({std::string(1, "RGB"[i]), &rgb.c[i]});
}

void BlenderExr::read() {
    for (size_t p = 0; p < targets_.size(); p++) {
        const ExrPart& part = file_.parts()[p];
        if (targets_[p].empty()) continue;
        const Window& shown = part.shown;
        if (part.cropped() && shown.isInside(part.width, part.height))
            throw InputError(path().string() + ": holds more than the picture (overscan, " + inWords(shown) +
                             " of it are shown); render without overscan");
        if (part.cropped())
            throw InputError(
                path().string() +
                ": holds a region of the picture; render whole frames, or switch on Crop to Render Region");
        if (part.width != width() || part.height != height())
            throw InputError(path().string() + ": its parts differ in size; render the frame again");
        file_.read(part, targets_[p]);
        targets_[p].clear();
    }
}

}  // namespace aa
