#include "shot/import/pitfalls.h"

#include <algorithm>
#include <cmath>

namespace aa {
namespace {
constexpr float kLeastContrast = 0.1f;  // of an edge, linear
constexpr float kFlat = 0.05f;          // of the contrast: what a side may vary
constexpr float kBetween = 0.15f;       // of the contrast: nearer to a side than this is that side
constexpr float kSameColour = 0.03f;    // absolute and relative: noise and shading

void countRow(const float* p, ptrdiff_t step, int count, EdgeCounts& counts) {
    for (int i = 2; i + 2 < count; i++) {
        const float a = p[(i - 2) * step], low = p[(i - 1) * step], v = p[i * step], high = p[(i + 1) * step],
                    b = p[(i + 2) * step];
        const float contrast = high - low;
        if (!(std::abs(contrast) > kLeastContrast)) continue;
        if (!(std::abs(a - low) < kFlat * std::abs(contrast) && std::abs(b - high) < kFlat * std::abs(contrast)))
            continue;
        const float share = (v - low) / contrast;
        if (share > kBetween && share < 1 - kBetween)
            counts.blended++;
        else if (share > -kBetween && share < 1 + kBetween)
            counts.sharp++;
    }
}
}  // namespace

std::vector<std::string> headerPitfalls(const BlenderExr& file) {
    std::vector<std::string> r;
    const std::string name = file.path().filename().string() + ": ";
    const std::string& codec = file.file().parts()[0].compression;
    if (codec.starts_with("dwa"))
        r.push_back(name +
                    "DWA compression loses digits of every channel called R, G, B or Y, the vertical motion and "
                    "normal among them; render with ZIP");
    else if (codec.starts_with("b44") || codec.starts_with("pxr24"))
        r.push_back(name + codec + " compression loses digits of " +
                    (codec.starts_with("b44") ? "half-float colours" : "depth, motion and ids") + "; render with ZIP");
    for (const auto& [pass, what] : {std::pair{BlenderPass::depth, "depth"}, {BlenderPass::vector, "motion"}})
        if (const ExrChannel* c = file.channelOf(pass, 0); c && c->type == ChannelType::half)
            r.push_back(name + what +
                        " is stored as half float: 11 bits, and nothing beyond 65504; set the output's "
                        "colour depth to Float (Full)");
    const auto samples = file.text("cycles." + file.layer() + ".samples");
    if (samples && *samples != "1")
        r.push_back(
            name + "rendered with " + *samples +
            " samples per pixel through a filter whose width Blender does not record: unless it was 0.01 px, the "
            "picture is anti-aliased already; see 1 sample, or Blackman-Harris of 0.01 px");
    return r;
}

EdgeCounts countEdges(const Rgb& colour) {
    EdgeCounts counts;
    const PlaneF& g = colour.c[1];
    for (int y = 0; y < g.height(); y++) countRow(g.row(y), 1, g.width(), counts);
    for (int x = 0; x < g.width(); x++) countRow(g.row(0) + x, g.stride(), g.height(), counts);
    return counts;
}

double changedShare(const Frame& previous, const Frame& frame) {
    uint64_t changed = 0;
    const bool ids = !frame.objectId.empty() && !previous.objectId.empty();
    for (int y = 0; y < frame.height; y++)
        for (int x = 0; x < frame.width; x++) {
            bool sameId = !ids;
            float lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY};
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, frame.height - 1); j++)
                for (int i = std::max(x - 1, 0); i <= std::min(x + 1, frame.width - 1); i++) {
                    if (ids) sameId = sameId || previous.objectId.at(i, j) == frame.objectId.at(x, y);
                    for (size_t c = 0; c < 3; c++) {
                        const float v = previous.colorLinear.c[c].at(i, j);
                        lo[c] = std::min(lo[c], v), hi[c] = std::max(hi[c], v);
                    }
                }
            bool sameColour = true;
            for (size_t c = 0; c < 3; c++) {
                const float v = frame.colorLinear.c[c].at(x, y), slack = kSameColour * (1 + std::abs(v));
                sameColour = sameColour && v >= lo[c] - slack && v <= hi[c] + slack;
            }
            changed += !(sameId && sameColour);
        }
    return double(changed) / (double(frame.width) * frame.height);
}

}  // namespace aa
