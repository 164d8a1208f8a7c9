// Still images on disk: EXR (image/exr.h) and PNG (image/png.h) in the program itself, every other kind through a
// module (image/other_formats.h). Files are written under a temporary name and renamed when complete.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "image/plane.h"

namespace aa {

inline constexpr int kLargestSide = 16384;  // px, conventions 10

// How the three channels of a file are to be read.
enum class FileSpace {
    encoded,  // 8/16-bit files: codes / max, sRGB
    linear,   // float or half files: linear light
};
struct LoadedImage {
    Rgb rgb;  // encoded in [0,1] or linear, by `space`
    FileSpace space = FileSpace::linear;
    bool displayReferred = false;  // written by writeExr(..., true): linear light that must not be tone mapped again
};

// Reads the first three channels of the first picture in the file; of one or two channels the first is repeated. What
// the file is, its content says, not its name. Integer files are taken as sRGB codes, float files as linear. Throws
// InputError: missing, not an image, truncated, no pixels, larger than kLargestSide.
LoadedImage readImage(const std::filesystem::path& file);

// Float EXR, ZIP, three channels R G B. `displayReferred` marks images that must not be tone mapped again.
void writeExr(const std::filesystem::path& file, const Rgb& linear, bool displayReferred);
// 8-bit codes floor(255 v + 0.5) of encoded values in [0,1].
void writePng(const std::filesystem::path& file, const Rgb& encoded);

// As one float EXR: channels NAME, or NAME.R/.G/.B.
void writeLayers(const std::filesystem::path& file, const std::vector<NamedPlanes>& layers);

// A path next to `file` to write to before renaming over it; another one in every process.
std::filesystem::path temporaryName(const std::filesystem::path& file);
void renameInto(const std::filesystem::path& temporary, const std::filesystem::path& file);  // throws InputError
// Removes the temporary file and throws InputError.
[[noreturn]] void giveUpWriting(const std::filesystem::path& file, const std::string& why);
// Writes a file through a temporary name. Throws InputError when it cannot.
void writeBytes(const std::filesystem::path& file, std::span<const unsigned char> bytes);
void writeText(const std::filesystem::path& file, const std::string& text);
// Makes a folder (and its parents) to write to; clears what killed processes left in it. Throws InputError.
void makeWritableFolder(const std::filesystem::path& folder);

}  // namespace aa
