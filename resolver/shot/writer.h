// Writes frames and truths in the shot format: multi-part EXR, one part per pass group, temporary name then rename.
#pragma once
#include "shot/frame.h"

namespace aa {

// Writes the passes present in `frame` to folder/file. Throws InputError when it cannot (disk full, permissions).
void writeFrame(const std::filesystem::path& file, const Frame& frame, bool motionPart);
void writeTruth(const std::filesystem::path& file, const Truth& truth);

}  // namespace aa
