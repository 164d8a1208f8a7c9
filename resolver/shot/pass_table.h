// One row per pass: its part and channels in the file, the planes of a frame that it fills, how it is repaired and what
// it costs. Reader, writer, sanitiser, `list --json` (from which the add-on writes) and reports walk this table; a new
// pass is one row here, its members in shot/frame.h and its bit in shot/pass.h.
#pragma once
#include <string_view>
#include <vector>

#include "shot/frame.h"
#include "shot/sanitise.h"

namespace aa {

// Channels that are repaired together, of one quantity: three of a colour, two of a motion.
struct ChannelGroup {
    std::vector<std::string_view> channels;  // names in the part; of sub-sample k behind "sNN."
    // The planes that they fill, in that order; the one of the two that fits the pass.
    std::vector<PlaneRef> (*ofFrame)(Frame&) = nullptr;
    std::vector<PlaneRef> (*ofSubSample)(SubSample&) = nullptr;
    SanitisePlanes* sanitise = nullptr;  // null: any value is good (ids, masks)
    bool isUint = false;                 // 32-bit unsigned; otherwise float, read from half or float
    PassSet share = {};                  // of the pass, where a method may ask for this group alone
};

struct PassInfo {
    Pass pass;
    std::string_view name;  // on the command line, in JSON and in the add-on
    std::string_view part;  // part of the EXR that holds it
    std::string_view meaning;
    std::vector<ChannelGroup> groups;
    bool perSubSample = false;  // the groups, at each sub-sample; `shared` once
    std::vector<ChannelGroup> shared = {};
    bool zeroWhereStatic = false;  // a static shot offers it without storing it
    bool isList = false;           // no picture: shot/segments.h

    int bytesPerPixel() const;  // in memory; of the groups, so of one sub-sample
};
const std::vector<PassInfo>& allPasses();
// Bytes per pixel in memory of everything that the passes, or shares of them, hold.
double bytesPerPixel(PassSet passes, size_t subSamples);
// Of a frame that holds them: the pixels without borders, lists by their length.
size_t bytesOf(PassSet passes, const Frame& frame, size_t subSamples);
// Of a picture that a method writes.
inline size_t bytesOfTarget(int width, int height) { return size_t(width) * size_t(height) * 3 * sizeof(float); }

}  // namespace aa
