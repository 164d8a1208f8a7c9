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
         .groups = {{{"Z"},
                     nullptr,
                     [](S& s) { return std::vector<PlaneRef>{&s.depthView}; },
                     sanitiseDepthPlanes,
                     false,
                     Pass::subsampleDepth},
                    {{"N.X", "N.Y", "N.Z"},
                     nullptr,
                     [](S& s) { return planes(s.normalWorld); },
                     sanitiseNormalPlanes,
                     false,
                     Pass::subsampleNormal},
                    {{"id"},
                     nullptr,
                     [](S& s) { return std::vector<PlaneRef>{&s.objectId}; },
                     nullptr,
                     true,
                     Pass::subsampleObject}},
         .perSubSample = true,
         .shared = {{{"mask"},
                     [](F& f) { return std::vector<PlaneRef>{&f.subSampleMask}; },
                     nullptr,
                     nullptr,
                     true,
                     Pass::subsampleMask}}},
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
    size_t channels = 0;
    const auto add = [&](const std::vector<ChannelGroup>& groups, size_t times) {
        for (const ChannelGroup& g : groups)
            if (passes.has(g.share)) channels += times * g.channels.size();
    };
    for (const PassInfo& p : allPasses())
        if (passes.hasAnyOf(p.pass) && !p.isList) add(p.groups, p.perSubSample ? subSamples : 1), add(p.shared, 1);
    return 4 * double(channels);
}

}  // namespace aa
