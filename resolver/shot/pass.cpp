#include "shot/pass.h"

namespace aa {

const std::vector<PassInfo>& allPasses() {
    static const std::vector<PassInfo> table = {
        {Pass::color, "color", "color", "linear scene-referred colour, point-sampled at centre + jitter"},
        {Pass::albedo, "albedo", "albedo", "unlit scene colour, linear"},
        {Pass::depth, "depth", "depth", "planar view-space z > 0; background 1e10"},
        {Pass::normal, "normal", "normal", "world-space unit normal; 0 on background"},
        {Pass::object, "object", "object", "id per object and per instance; 0 = background"},
        {Pass::motion, "motion", "motion", "current - previous position, px, y down, un-jittered"},
        {Pass::subsamples, "subsamples", "subsamples", "geometry at each sub-sample and the similarity mask"},
        {Pass::subsampleColor, "subsampleColor", "subsamples", "shaded colour at each sub-sample, linear"},
        {Pass::edges, "edges", "edges", "signed axis distances to the visible triangle's nearest edge, px"},
        {Pass::segments, "segments", "segments",
         "list of the geometry's projected edges: ends in px of the un-jittered picture, and their depth"},
    };
    return table;
}

std::string_view name(Pass pass) {
    for (const auto& p : allPasses())
        if (p.pass == pass) return p.name;
    return "?";
}

std::vector<std::string_view> names(PassSet set) {
    std::vector<std::string_view> r;
    for (const auto& p : allPasses())
        if (set.has(p.pass)) r.push_back(p.name);
    return r;
}

std::optional<Pass> passByName(std::string_view name) {
    for (const auto& p : allPasses())
        if (p.name == name) return p.pass;
    return std::nullopt;
}

std::string subSampleChannel(size_t k, std::string_view quantity) {
    return (k < 10 ? "s0" : "s") + std::to_string(k) + "." + std::string(quantity);
}

}  // namespace aa
