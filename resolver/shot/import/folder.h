// The files of a rendered sequence, by frame number.
#pragma once
#include <filesystem>
#include <map>

namespace aa {

// EXR files directly in `folder`: the last number of each name is the frame; a name without one takes the file's own
// Frame attribute. Throws InputError: no folder, no EXR (PNGs are named for what they lack), two files of one frame.
std::map<int, std::filesystem::path> renderedFrames(const std::filesystem::path& folder);
// The last number of a name: "shot_v2_0013.exr" -> 13; -1: none.
int frameNumberOf(const std::string& fileName);

}  // namespace aa
