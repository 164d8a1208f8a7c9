#include "shot/writer.h"

#include <algorithm>

#include "image/exr.h"
#include "shot/pass_table.h"
#include "shot/segments.h"

namespace aa {
namespace {
void add(PartSource& part, const ChannelGroup& group, const std::vector<PlaneRef>& planes, const std::string& prefix) {
    for (size_t i = 0; i < planes.size(); i++)
        std::visit(
            [&](auto* plane) {
                part.channels.push_back({prefix + std::string(group.channels[i]), plane});
            },
            planes[i]);
}
}  // namespace

void writeFrame(const std::filesystem::path& file, const Frame& written, bool motionPart) {
    Frame& frame = const_cast<Frame&>(written);  // the table's planes are for the reader, too; none is changed here
    const SegmentPlanes segments = frame.passes.has(Pass::segments) ? packSegments(frame.segments) : SegmentPlanes{};
    std::vector<PartSource> parts;
    for (const auto& info : allPasses()) {
        if (!frame.passes.hasAnyOf(info.pass) || (info.zeroWhereStatic && !motionPart)) continue;
        auto part = std::find_if(parts.begin(), parts.end(), [&](const auto& p) { return p.name == info.part; });
        if (part == parts.end()) part = parts.insert(parts.end(), PartSource{std::string(info.part), {}});
        for (const auto& g : info.shared) add(*part, g, g.ofFrame(frame), "");
        for (const auto& g : info.groups) {
            if (info.isList) {
                for (size_t c = 0; c < segments.size(); c++)
                    part->channels.push_back({std::string(g.channels[c]), &segments[c]});
            } else if (info.perSubSample) {
                for (size_t k = 0; k < frame.subSamples.size(); k++)
                    add(*part, g, g.ofSubSample(frame.subSamples[k]), subSampleChannel(k, ""));
            } else {
                add(*part, g, g.ofFrame(frame), "");
            }
        }
    }
    writeParts(file, parts);
}

namespace {
PartSource half(const char* name, const Rgb& c) { return {name, {{"R", &c.c[0]}, {"G", &c.c[1]}, {"B", &c.c[2]}}}; }
}  // namespace

void writeTruth(const std::filesystem::path& file, const Truth& truth) {
    writeParts(file, {half("a", truth.a), half("b", truth.b)});
}

}  // namespace aa
