// The files of a rendered sequence, by frame number.
#pragma once
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace aa {

// EXR files directly in `folder`: the last number of each name is the frame; a name without one takes the file's own
// Frame attribute. Throws InputError: no folder, no EXR (PNGs are named for what they lack), two files of one frame.
std::map<int, std::filesystem::path> renderedFrames(const std::filesystem::path& folder);
// The last number of a name: "shot_v2_0013.exr" -> 13, "-00005.exr" -> -5; "shot-0004.exr" -> 4, whose minus parts it
// from a word. Nothing: it has none.
std::optional<int> frameNumberOf(const std::string& fileName);
// Of pictures that each lie there as EXR and as PNG under one name, as `run --write exr,png` leaves them, those of one
// kind; others all stay.
enum class PictureKind { exr, png };
std::vector<std::filesystem::path> ofOneKind(std::vector<std::filesystem::path> files, PictureKind kept);

}  // namespace aa
