#include "image/other_formats.h"

#include <algorithm>
#include <fstream>
#include <memory>
#include <string_view>
#include <vector>

#include "formats/module.h"
#include "image/error.h"
#include "image/io.h"
#include "image/own_module.h"

namespace aa {
namespace fs = std::filesystem;

namespace {
constexpr const char* kModule = "aaresolve_formats.so";
constexpr const char* kVariable = "AARESOLVE_FORMATS";

// A damaged size must not ask for the machine's memory. WebP and the like need no bytes for a picture of one colour, so
// that one of 3840 x 2160 always goes; beyond, what deflate unpacks furthest to: 1032 codes, four of them from a bit
// each.
constexpr size_t kAlwaysValues = 4 * size_t(3840) * 2160, kMostValuesPerByte = 8 * 1032;

struct Module {
    AaOpenPicture open = nullptr;
    AaReadPicture read = nullptr;
    AaClosePicture close = nullptr;
    std::string why;  // it cannot be used
    bool usable() const { return open && read && close; }
};

Module load() {
    OwnModule library(kModule, kVariable);
    Module m{library.function<AaOpenPicture>(kAaOpenPicture),
             library.function<AaReadPicture>(kAaReadPicture),
             library.function<AaClosePicture>(kAaClosePicture),
             {}};
    if (!m.usable()) m.why = library.whyNot();
    return m;
}

// In words, for the message when there is no module; by the first bytes, else by the name.
std::string kindOf(const fs::path& file) {
    struct Kind {
        std::string_view start, name;
    };
    static constexpr Kind kinds[] = {
        {"\xff\xd8\xff", "JPEG"}, {{"II*\0", 4}, "TIFF"}, {{"MM\0*", 4}, "TIFF"}, {"#?RADIANCE", "HDR"},
        {"SDPX", "DPX"},          {"XPDS", "DPX"},        {"GIF8", "GIF"},        {"8BPS", "Photoshop"},
        {"RIFF", "WebP"},         {"BM", "BMP"},          {"P6", "PPM"},          {"PF", "PFM"}};
    std::string bytes(16, ' ');
    std::ifstream(file, std::ios::binary).read(bytes.data(), std::streamsize(bytes.size()));
    for (const auto& kind : kinds)
        if (bytes.starts_with(kind.start)) return std::string(kind.name) + " file";
    const std::string named = file.extension().string();
    return named.empty() || named == ".png" || named == ".exr" ? "file of unknown kind" : "'" + named + "' file";
}
}  // namespace

StoredPicture readOtherFormat(const fs::path& file) {
    if (std::error_code ignored; fs::is_directory(file, ignored))
        throw InputError(file.string() + ": is a folder; expected an image, PNG or EXR");
    static const Module module = load();
    if (!module.usable())
        throw InputError(file.string() + ": neither PNG nor EXR but a " + kindOf(file) + ", which needs the module " +
                         kModule + " and OpenImageIO (" + module.why + "); install them, set " + kVariable +
                         " to the module's path, or convert the file to PNG or EXR");
    AaPicture picture{};
    const std::unique_ptr<void, AaClosePicture> opened(module.open(file.c_str(), &picture), module.close);
    if (!opened) throw InputError(file.string() + ": not an image that can be read; expected PNG or EXR");
    const auto [w, h, stored, isFloat, alpha, orientation] = picture;
    if (w < 1 || h < 1 || stored < 1) throw InputError(file.string() + ": has no pixels");
    if (w > kLargestSide || h > kLargestSide)
        throw InputError(file.string() + ": " + std::to_string(w) + " x " + std::to_string(h) +
                         " pixels; expected 1..16384 a side");
    const size_t channels = size_t(std::min(stored, 4));
    const size_t values = size_t(w) * size_t(h) * channels;
    std::error_code ignored;
    const uintmax_t bytes = fs::file_size(file, ignored);
    if (values > kAlwaysValues && values / kMostValuesPerByte > bytes)
        throw InputError(file.string() + ": " + std::to_string(w) + " x " + std::to_string(h) +
                         " pixels cannot be in a file of " + std::to_string(bytes) + " bytes; write the file again");
    std::vector<float> pixels(values);
    if (!module.read(opened.get(), int(channels), pixels.data()))
        throw InputError(file.string() + ": truncated or damaged; write the file again");
    StoredPicture read{Rgb(w, h), {}, isFloat != 0, orientation};
    const bool hasAlpha = alpha >= 0 && alpha < int(channels);
    if (hasAlpha) read.alpha = PlaneF(w, h);
    const float* from = pixels.data();
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++, from += channels) {
            for (size_t c = 0; c < 3; c++) read.rgb.c[c].at(x, y) = from[channels < 3 ? 0 : c];
            if (hasAlpha) read.alpha.at(x, y) = from[alpha];
        }
    return read;
}

}  // namespace aa
