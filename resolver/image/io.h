// Still images on disk: EXR (image/exr.h) and PNG (image/png.h) in the program itself, every other kind through a
// module (image/other_formats.h). Files are written under a temporary name and renamed when complete.
#pragma once
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "image/input_policy.h"
#include "image/plane.h"
#include "image/window.h"

namespace aa {

inline constexpr int kLargestSide = 16384;  // px, conventions 10

// How the three channels of a file are to be read.
enum class FileSpace {
    encoded,  // 8/16-bit files: codes / max, sRGB
    linear,   // float or half files: linear light
};
struct LoadedImage {
    Rgb rgb;  // encoded in [0,1] or linear, by `space`; of files with alpha the stored colours, never multiplied
    FileSpace space = FileSpace::linear;
    bool displayReferred = false;  // written by writeExr(..., true): linear light that must not be tone mapped again
    PlaneF alpha = {};             // in [0,1]; empty where the file has none
    Window shown = {};             // the display window, in pixels from the first one stored
    std::string layer = {};        // what was read, where the file holds more than one layer
    bool half = false;             // stored in 16 bits
    ColourCounts counts = {};      // of what is shown or hidden
    bool allShown() const { return shown == Window{0, 0, rgb.width(), rgb.height()}; }
    bool isOpaque() const;  // alpha is 1 everywhere, or there is none
};
// How a picture is read: the same for every command.
struct ReadOptions {
    std::string layer = {};  // of an EXR; empty: image/exr_layers.h tells
    InputPolicy policy = InputPolicy::raw;
    ColourUse use = ColourUse::measured;
};

// Lets the system read a file ahead that will be opened soon, and goes on; one that is not there is left alone.
void willRead(const std::filesystem::path& file);

// Reads one picture of the file; of one or two channels the first is repeated. What the file is, its content says, not
// its name. Integer files are taken as sRGB codes, float files as linear. A picture that its file says lies turned is
// turned upright. Throws InputError: missing, not an image, truncated, no pixels, larger than kLargestSide; deep or
// sub-sampled pixels; several layers and no telling which; what the policy refuses.
LoadedImage readImage(const std::filesystem::path& file, const ReadOptions& options = {});
// What the display window shows: black, and clear, where nothing is stored. Throws InputError: larger than
// kLargestSide.
void showDisplayWindow(LoadedImage& image, const std::filesystem::path& file);

// What goes beside the colours of a picture that is written.
struct Beside {
    const PlaneF* alpha = nullptr;
    std::optional<Window> shown = {};  // the display window, in pixels from the first
};
// Float EXR, ZIP, channels R G B and A where there is alpha. `displayReferred` marks images that must not be tone
// mapped again.
void writeExr(const std::filesystem::path& file, const Rgb& linear, bool displayReferred, const Beside& beside = {});
// 8-bit codes floor(255 v + 0.5) of encoded values in [0,1].
void writePng(const std::filesystem::path& file, const Rgb& encoded, const PlaneF* alpha = nullptr);

// As one float EXR: channels NAME, or NAME.R/.G/.B.
void writeLayers(const std::filesystem::path& file, const std::vector<NamedPlanes>& layers);

// Where to write `file` before renaming over it, its own in every process; asked first, clears what killed ones left.
std::filesystem::path temporaryName(const std::filesystem::path& file);
void renameInto(const std::filesystem::path& temporary, const std::filesystem::path& file);  // throws InputError
// Removes the temporary file and throws InputError.
[[noreturn]] void giveUpWriting(const std::filesystem::path& file, const std::string& why);
// For what is written at the end of long work: throws at its beginning what the writing would.
void requireWritable(const std::filesystem::path& file);
// Write a file through a temporary name: what `content` puts into the stream, bytes, a text. Throw InputError when they
// cannot.
void writeStream(const std::filesystem::path& file, const std::function<void(std::ostream&)>& content);
void writeBytes(const std::filesystem::path& file, std::span<const unsigned char> bytes);
void writeText(const std::filesystem::path& file, const std::string& text);
// Makes a folder (and its parents) to write to; clears what killed processes left in it. Throws InputError.
void makeWritableFolder(const std::filesystem::path& folder);

}  // namespace aa
