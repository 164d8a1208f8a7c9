// Is a shot what its manifest claims? Every later figure rests on jitter, motion, depth and ids being right, and a
// wrong sign or unit looks like a weak method. So each claim is tested against the pixels:
//   files and numbers  every file is there and whole, frame numbers without gaps, NaN and Inf counted per channel
//   jitter             edges of the point-sampled colour are registered against the truth (check_jitter.h)
//   motion             p - motion must land on the same object; the 8 sign and axis variants compete (check_motion.h)
//   depth, normals     planar and consistent with the normals, within near..far, scale (check_depth.h)
//   ids                named in the manifest; 0 exactly where the depth is background
// A labelled variant (premultiplied jitter) is named, with what was found of it, instead of being a finding.
// What cannot be tested with the passes at hand is listed as such.
#pragma once
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "shot/frame.h"

namespace aa {

struct Finding {
    std::string check;         // "files", "numbers", "jitter", "motion", "depth", "normal", "object", "subsamples"
    std::optional<int> frame;  // none: the whole shot
    std::string channel;       // as in the file; empty when none in particular
    std::optional<glm::ivec2> pixel;
    std::string expected, found, advice;
    uint64_t count = 0;  // pixels concerned; 0 when it does not apply
    std::string line() const;
};
// A figure that a check measured, found or not: "jitter.meanErrorPx".
struct Measured {
    std::string name;
    double value = 0;
};
struct CheckReport {
    std::string name;  // of the shot
    size_t frames = 0;
    PassSet passes, centrePasses;  // of the jittered frames, of those at the pixel centres
    std::vector<Finding> findings;
    std::vector<Measured> measured;
    std::vector<std::string> notChecked;  // what, and why
    std::vector<std::string> variants;    // what the manifest says to be wrong on purpose: labelled, so no finding
    bool clean() const { return findings.empty(); }
};
nlohmann::ordered_json toJson(const CheckReport& report);

// Throws InputError only when the manifest itself cannot be read; a damaged frame is a finding. goOn(frame) is called
// after each frame; false ends the check early.
CheckReport checkShot(const std::filesystem::path& shot, const std::function<bool(int)>& goOn = {});

}  // namespace aa
