// Reads a shot selectively: only the parts of the EXR that the asked passes need are decoded.
#pragma once
#include "image/input_policy.h"
#include "shot/frame.h"
#include "shot/manifest.h"

namespace aa {

// Counts of what the input sanitiser replaced (conventions 8), or under raw would have.
struct SanitiseCounts {
    uint64_t colourNan = 0, colourInf = 0, colourNegative = 0, colourLarge = 0, depth = 0, normal = 0, motion = 0,
             edges = 0, segments = 0, truthNan = 0, truthInf = 0, truthNegative = 0;
    uint64_t total() const;
    SanitiseCounts& operator+=(const SanitiseCounts& o);
};
// By name, as results hold them; empty when nothing was replaced.
std::map<std::string, uint64_t> counted(const SanitiseCounts& counts);

class ShotReader {
  public:
    explicit ShotReader(const std::filesystem::path& shot, InputPolicy policy = InputPolicy::sanitise);
    const Manifest& manifest() const { return manifest_; }

    InputPolicy policy() const { return policy_; }

    // Passes that the shot offers, found in the header of the first file. A static shot offers `motion` without storing
    // it (zeros). Opens that file at every call.
    PassSet offered(Sampling sampling = Sampling::jittered) const;
    // Those of one frame's file.
    PassSet offeredBy(size_t index, Sampling sampling = Sampling::jittered) const;
    // Whether the shot holds frames sampled at the pixel centres beside jittered ones. One frame that lacks them is an
    // error when it is read: methods would be judged on other samples there.
    bool hasCentreFrames() const { return firstWithCentre() < manifest_.frames.size(); }
    // Decodes the wanted passes of manifest().frames[index]. Thread-safe. Throws InputError: file missing, truncated,
    // wrong resolution, missing part or channel (named), wrong type, NaN under InputPolicy::strict.
    Frame read(size_t index, PassSet wanted, SanitiseCounts* counts = nullptr) const;
    // The same instant sampled at the pixel centres, from FrameEntry::centre: jitter 0. Asking it of a shot without
    // centre frames is a programming error.
    Frame readCentre(size_t index, PassSet wanted, SanitiseCounts* counts = nullptr) const;
    // Ground truth of a frame; nullopt when the frame has none. Thread-safe. It is never repaired, since every figure
    // rests on it: NaN and Inf throw unless the policy is raw, negative radiance becomes 0 and is counted.
    std::optional<Truth> readTruth(size_t index, SanitiseCounts* counts = nullptr) const;

  private:
    size_t firstWithCentre() const;
    // Of the frame's picture, relative to the shot. Throws InputError: none at the pixel centres.
    const std::string& fileOf(size_t index, Sampling sampling) const;
    Frame decode(size_t index, PassSet wanted, Sampling sampling, SanitiseCounts* counts) const;
    Manifest manifest_;
    InputPolicy policy_;
};

}  // namespace aa
