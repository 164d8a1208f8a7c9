#include "shot/writer.h"

#include "image/exr.h"
#include "shot/segments.h"

namespace aa {
namespace {
PartSource rgbPart(const char* name, const Rgb& c, const std::string& r, const std::string& g, const std::string& b) {
    return {name, {{r, &c.c[0]}, {g, &c.c[1]}, {b, &c.c[2]}}};
}
PartSource subSamplePart(const Frame& frame) {
    PartSource part{"subsamples", {}};
    if (frame.passes.has(Pass::subsamples)) part.channels.push_back({"mask", &frame.subSampleMask});
    for (size_t k = 0; k < frame.subSamples.size(); k++) {
        const SubSample& s = frame.subSamples[k];
        if (frame.passes.has(Pass::subsamples)) {
            part.channels.push_back({subSampleChannel(k, "Z"), &s.depthView});
            for (size_t c = 0; c < 3; c++)
                part.channels.push_back({subSampleChannel(k, std::string("N.") + "XYZ"[c]), &s.normalWorld.c[c]});
            part.channels.push_back({subSampleChannel(k, "id"), &s.objectId});
        }
        if (frame.passes.has(Pass::subsampleColor))
            for (size_t c = 0; c < 3; c++)
                part.channels.push_back({subSampleChannel(k, std::string(1, "RGB"[c])), &s.colorLinear.c[c]});
    }
    return part;
}
}  // namespace

void writeFrame(const std::filesystem::path& file, const Frame& frame, bool motionPart) {
    std::vector<PartSource> parts;
    const auto has = [&](Pass p) { return frame.passes.has(p); };
    if (has(Pass::color)) parts.push_back(rgbPart("color", frame.colorLinear, "R", "G", "B"));
    if (has(Pass::albedo)) parts.push_back(rgbPart("albedo", frame.albedoLinear, "albedo.R", "albedo.G", "albedo.B"));
    if (has(Pass::depth)) parts.push_back({"depth", {{"Z", &frame.depthView}}});
    if (has(Pass::normal)) parts.push_back(rgbPart("normal", frame.normalWorld, "N.X", "N.Y", "N.Z"));
    if (has(Pass::object)) parts.push_back({"object", {{"id", &frame.objectId}}});
    if (has(Pass::motion) && motionPart)
        parts.push_back({"motion", {{"motion.X", &frame.motionXPx}, {"motion.Y", &frame.motionYPx}}});
    if (has(Pass::subsamples) || has(Pass::subsampleColor)) parts.push_back(subSamplePart(frame));
    const SegmentPlanes segments = has(Pass::segments) ? packSegments(frame.segments) : SegmentPlanes{};
    if (has(Pass::edges)) parts.push_back({"edges", {{"edge.X", &frame.edgeXPx}, {"edge.Y", &frame.edgeYPx}}});
    if (has(Pass::segments)) {
        PartSource part{"segments", {}};
        for (size_t c = 0; c < segments.size(); c++)
            part.channels.push_back({std::string(kSegmentChannels[c]), &segments[c]});
        parts.push_back(std::move(part));
    }
    writeParts(file, parts);
}

void writeTruth(const std::filesystem::path& file, const Truth& truth) {
    writeParts(file, {rgbPart("a", truth.a, "R", "G", "B"), rgbPart("b", truth.b, "R", "G", "B")});
}

}  // namespace aa
