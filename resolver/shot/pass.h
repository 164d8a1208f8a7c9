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
    subsamples = 64,       // depth, normal, id at each sub-sample, and the similarity mask
    subsampleColor = 128,  // shaded colour at each sub-sample
    edges = 256,           // signed axis distances to the visible triangle's nearest edge, px
    segments = 512,        // projected edges of the geometry: a list, not a picture
};

// Where in the pixel a frame is sampled. Methods that accumulate frames read jittered ones; all others judge a picture
// that nobody would jitter, so they read the pixel centres (conventions 2).
enum class Sampling { jittered, centre };

// A set of passes.
struct PassSet {
    uint32_t bits = 0;
    PassSet() = default;
    PassSet(Pass p) : bits(uint32_t(p)) {}
    bool has(Pass p) const { return bits & uint32_t(p); }
    PassSet operator|(PassSet o) const {
        PassSet r;
        r.bits = bits | o.bits;
        return r;
    }
    PassSet& operator|=(PassSet o) { return *this = *this | o; }
    PassSet without(PassSet o) const {
        PassSet r;
        r.bits = bits & ~o.bits;
        return r;
    }
    bool operator==(const PassSet&) const = default;
    bool empty() const { return bits == 0; }
};
inline PassSet operator|(Pass a, Pass b) { return PassSet(a) | PassSet(b); }

std::string_view name(Pass pass);
std::vector<std::string_view> names(PassSet set);
std::string listOf(PassSet set, std::string_view between = " ");
std::optional<Pass> passByName(std::string_view name);
// Channel of the subsamples part: "s00.Z", "s00.N.X", "s00.id", "s00.R" ...
std::string subSampleChannel(size_t k, std::string_view quantity);

}  // namespace aa
