#include "shot/pass.h"

#include "shot/pass_table.h"

namespace aa {

PassSet whole(PassSet set) {
    PassSet all;
    for (const auto& p : allPasses())
        if (set.hasAnyOf(p.pass)) all |= p.pass;
    return all;
}

std::string_view name(Pass pass) {
    for (const auto& p : allPasses())
        if (p.pass == pass) return p.name;
    return "?";
}

std::vector<std::string_view> names(PassSet set) {
    std::vector<std::string_view> r;
    for (const auto& p : allPasses())
        if (set.hasAnyOf(p.pass)) r.push_back(p.name);
    return r;
}
std::string listOf(PassSet set, std::string_view between) {
    std::string all;
    for (const std::string_view n : names(set)) all.append(all.empty() ? "" : between).append(n);
    return all;
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
