#include "shot/check/ids.h"

#include <cmath>
#include <map>

namespace aa {
using glm::dvec2;

namespace {
constexpr uint64_t kFewestLandings = 30;  // of an object, away from its outline
constexpr double kMostOfThem = 0.8;       // must land on one other id
constexpr double kSameDepth = 0.05;       // relative: what a surface moves along the view axis in a frame
struct Landing {
    std::map<uint32_t, uint64_t> on;  // id in the frame before -> pixels
    uint64_t pixels = 0;
    glm::ivec2 first{0};
};
// Id around position q of the frame before; 0: none, an outline, or another depth.
uint32_t idAround(const Frame& previous, dvec2 q, float z) {
    const dvec2 base = q - previous.jitterPx - 0.5;
    const double bx = std::floor(base.x), by = std::floor(base.y);
    if (!(bx >= 0 && by >= 0 && bx + 1 < previous.width && by + 1 < previous.height)) return 0;
    const uint32_t id = previous.objectId.at(int(bx), int(by));
    for (int j = 0; j <= 1; j++)
        for (int i = 0; i <= 1; i++) {
            const float other = previous.depthView.at(int(bx) + i, int(by) + j);
            if (previous.objectId.at(int(bx) + i, int(by) + j) != id) return 0;
            if (!(std::abs(other - z) <= kSameDepth * double(z))) return 0;
        }
    return id;
}
}  // namespace

bool IdCheck::add(const Frame& previous, const Frame& frame, CheckReport& report) {
    std::map<uint32_t, Landing> landings;
    std::map<uint32_t, bool> inPrevious;
    for (int y = 0; y < frame.height; y++)
        for (int x = 0; x < frame.width; x++) {
            inPrevious[previous.objectId.at(x, y)] = true;
            const uint32_t id = frame.objectId.at(x, y);
            if (id == 0) continue;
            Landing& landing = landings[id];
            const dvec2 q =
                dvec2(x + 0.5, y + 0.5) + frame.jitterPx - dvec2(frame.motionXPx.at(x, y), frame.motionYPx.at(x, y));
            const uint32_t before = idAround(previous, q, frame.depthView.at(x, y));
            if (before == 0) continue;
            if (landing.pixels++ == 0) landing.first = {x, y};
            landing.on[before]++;
        }
    std::map<uint32_t, uint32_t> renamed, renamedTo;  // id now -> id before, and back
    for (const auto& [id, landing] : landings)
        for (const auto& [before, pixels] : landing.on)
            if (before != id && landing.pixels >= kFewestLandings &&
                double(pixels) >= kMostOfThem * double(landing.pixels))
                renamed[id] = before, renamedTo[before] = id;
    std::erase_if(renamed, [&, all = renamed](const auto& pair) {
        const auto& [id, before] = pair;
        const bool isNew = !inPrevious.contains(id) || renamedTo.contains(id);
        const bool hasGone = !landings.contains(before) || all.contains(before);
        return !(isNew && hasGone);
    });
    if (renamed.empty()) return true;
    if (!found_) {
        const auto [id, before] = *renamed.begin();
        report.findings.push_back(
            {"object", frame.number, "id", landings[id].first,
             "ids that stay with their objects: " + std::to_string(before) + " as in frame " +
                 std::to_string(previous.number),
             std::to_string(id) +
                 (renamed.size() > 1 ? " (and " + std::to_string(renamed.size() - 1) + " more objects have another id)"
                                     : ""),
             "number the objects once for the whole shot, not anew in every frame", 0});
        found_ = true;
    }
    return false;
}

}  // namespace aa
