// The passes of a shot: what a method may ask for, what the exporter renders and what the reader decodes.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aa {

enum class Pass : uint32_t {
    color = 1,             // R G B, linear scene-referred, sampled at centre + jitter
    albedo = 2,            // unlit colour, linear
    depth = 4,             // planar view-space z > 0, background 1e10
    normal = 8,            // world space, unit, 0 on background
    object = 16,           // unsigned id, 0 = background
    motion = 32,           // current - previous position, px, y down, un-jittered
    subsampleColor = 128,  // shaded colour at each sub-sample
    edges = 256,           // signed axis distances to the visible triangle's nearest edge, px
    segments = 512,        // projected edges of the geometry: a list, not a picture
    // Depth, normal, id at each sub-sample, and the similarity mask: one pass to export and to store. A method names
    // what it reads of it, and no more is kept in memory.
    subsampleDepth = 64,
    subsampleNormal = 1024,
    subsampleObject = 2048,
    subsampleMask = 4096,
    subsamples = subsampleDepth | subsampleNormal | subsampleObject | subsampleMask,
};

// Where in the pixel a frame is sampled. Methods that accumulate frames read jittered ones; all others judge a picture
// that nobody would jitter, so they read the pixel centres (conventions 2).
enum class Sampling { jittered, centre };

// A set of passes.
struct PassSet {
    uint32_t bits = 0;
    PassSet() = default;
    PassSet(Pass p) : bits(uint32_t(p)) {}
    bool has(PassSet all) const { return (bits & all.bits) == all.bits; }
    bool hasAnyOf(PassSet some) const { return bits & some.bits; }
    PassSet& operator|=(PassSet o) {
        bits |= o.bits;
        return *this;
    }
    PassSet without(PassSet o) const {
        PassSet r;
        r.bits = bits & ~o.bits;
        return r;
    }
    bool operator==(const PassSet&) const = default;
    bool empty() const { return bits == 0; }
};
inline PassSet operator|(PassSet a, PassSet b) { return a |= b; }
inline PassSet operator|(Pass a, Pass b) { return PassSet(a) | PassSet(b); }

// The passes of which it holds a share.
PassSet whole(PassSet set);
std::string_view name(Pass pass);
std::vector<std::string_view> names(PassSet set);
std::string listOf(PassSet set, std::string_view between = " ");
std::optional<Pass> passByName(std::string_view name);
// Channel of the subsamples part: "s00.Z", "s00.N.X", "s00.id", "s00.R" ...
std::string subSampleChannel(size_t k, std::string_view quantity);

}  // namespace aa
