#include "shot/pass_table.h"

#include "shot/segments.h"

namespace aa {
namespace {
std::vector<PlaneRef> planes(Rgb& c) { return {&c.c[0], &c.c[1], &c.c[2]}; }
}  // namespace

const std::vector<PassInfo>& allPasses() {
    using F = Frame;
    using S = SubSample;
    static const std::vector<PassInfo> table = {
        {Pass::color,
         "color",
         "color",
         "linear scene-referred colour, point-sampled at centre + jitter",
         {{{"R", "G", "B"}, [](F& f) { return planes(f.colorLinear); }, nullptr, sanitiseColourPlanes}}},
        {Pass::albedo,
         "albedo",
         "albedo",
         "unlit scene colour, linear",
         {{{"albedo.R", "albedo.G", "albedo.B"},
           [](F& f) { return planes(f.albedoLinear); },
           nullptr,
           sanitiseColourPlanes}}},
        {Pass::depth,
         "depth",
         "depth",
         "planar view-space z > 0; background 1e10",
         {{{"Z"}, [](F& f) { return std::vector<PlaneRef>{&f.depthView}; }, nullptr, sanitiseDepthPlanes}}},
        {Pass::normal,
         "normal",
         "normal",
         "world-space unit normal; 0 on background",
         {{{"N.X", "N.Y", "N.Z"}, [](F& f) { return planes(f.normalWorld); }, nullptr, sanitiseNormalPlanes}}},
        {Pass::object,
         "object",
         "object",
         "id per object and per instance; 0 = background",
         {{{"id"}, [](F& f) { return std::vector<PlaneRef>{&f.objectId}; }, nullptr, nullptr, true}}},
        {.pass = Pass::motion,
         .name = "motion",
         .part = "motion",
         .meaning = "current - previous position, px, y down, un-jittered",
         .groups = {{{"motion.X", "motion.Y"},
                     [](F& f) {
                         return std::vector<PlaneRef>{&f.motionXPx, &f.motionYPx};
                     },
                     nullptr,
                     sanitiseMotionPlanes}},
         .zeroWhereStatic = true},
        {.pass = Pass::subsamples,
         .name = "subsamples",
         .part = "subsamples",
         .meaning = "geometry at each sub-sample and the similarity mask",
         .groups = {{{"Z"}, nullptr, [](S& s) { return std::vector<PlaneRef>{&s.depthView}; }, sanitiseDepthPlanes},
                    {{"N.X", "N.Y", "N.Z"}, nullptr, [](S& s) { return planes(s.normalWorld); }, sanitiseNormalPlanes},
                    {{"id"}, nullptr, [](S& s) { return std::vector<PlaneRef>{&s.objectId}; }, nullptr, true}},
         .perSubSample = true,
         .shared = {{{"mask"}, [](F& f) { return std::vector<PlaneRef>{&f.subSampleMask}; }, nullptr, nullptr, true}}},
        {.pass = Pass::subsampleColor,
         .name = "subsampleColor",
         .part = "subsamples",
         .meaning = "shaded colour at each sub-sample, linear",
         .groups = {{{"R", "G", "B"}, nullptr, [](S& s) { return planes(s.colorLinear); }, sanitiseColourPlanes}},
         .perSubSample = true},
        {Pass::edges,
         "edges",
         "edges",
         "signed axis distances to the visible triangle's nearest edge, px",
         {{{"edge.X", "edge.Y"},
           [](F& f) {
               return std::vector<PlaneRef>{&f.edgeXPx, &f.edgeYPx};
           },
           nullptr,
           sanitiseEdgesPlanes}}},
        {.pass = Pass::segments,
         .name = "segments",
         .part = "segments",
         .meaning = "list of the geometry's projected edges: ends in px of the un-jittered picture, and their depth",
         .groups = {{{kSegmentChannels.begin(), kSegmentChannels.end()}}},
         .isList = true},
    };
    return table;
}

int PassInfo::bytesPerPixel() const {
    int bytes = 0;
    for (const auto& g : groups) bytes += isList ? 0 : 4 * int(g.channels.size());
    return bytes;
}

size_t bytesOf(PassSet passes, const Frame& frame, size_t subSamples) {
    const double pixels = double(frame.width) * frame.height;
    const size_t segments = passes.has(Pass::segments) ? frame.segments.size() * kSegmentChannels.size() * 4 : 0;
    return size_t(pixels * bytesPerPixel(passes, subSamples)) + segments;
}

double bytesPerPixel(PassSet passes, size_t subSamples) {
    double bytes = 0;
    for (const auto& p : allPasses())
        if (passes.has(p.pass)) {
            bytes += double(p.bytesPerPixel()) * (p.perSubSample ? double(subSamples) : 1.0);
            for (const auto& g : p.shared) bytes += 4 * double(g.channels.size());
        }
    return bytes;
}

}  // namespace aa
