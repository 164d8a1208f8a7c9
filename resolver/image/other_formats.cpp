#include "image/other_formats.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <string_view>
#include <vector>

#include "formats/module.h"
#include "image/error.h"
#include "image/program_folder.h"

namespace aa {
namespace fs = std::filesystem;

namespace {
constexpr const char* kModule = "aaresolve_formats.so";
constexpr const char* kVariable = "AARESOLVE_FORMATS";

struct Module {
    AaOpenPicture open = nullptr;
    AaReadPicture read = nullptr;
    AaClosePicture close = nullptr;
    std::string why;  // it cannot be used
};

std::vector<fs::path> places() {
    std::vector<fs::path> all;
    if (const fs::path folder = programFolder(); !folder.empty())
        all = {folder / kModule, folder.parent_path() / "lib" / "aaresolve" / kModule};
    if (const char* named = std::getenv(kVariable)) all.push_back(named);
    return all;
}
Module load() {
    Module m;
    const auto all = places();
    std::error_code ignored;
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& p) { return fs::exists(p, ignored); });
    if (found == all.end()) {
        m.why = "looked for";
        for (const auto& place : all) m.why += (place == all.front() ? " " : ", ") + place.string();
        return m;
    }
    void* library = dlopen(found->c_str(), RTLD_NOW | RTLD_LOCAL);  // stays loaded: its threads may run
    if (library) {
        m.open = reinterpret_cast<AaOpenPicture>(dlsym(library, kAaOpenPicture));
        m.read = reinterpret_cast<AaReadPicture>(dlsym(library, kAaReadPicture));
        m.close = reinterpret_cast<AaClosePicture>(dlsym(library, kAaClosePicture));
    }
    if (!m.open || !m.read || !m.close)
        if (const char* why = dlerror()) m.why = why;
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

LoadedImage readOtherFormat(const fs::path& file) {
    if (std::error_code ignored; fs::is_directory(file, ignored))
        throw InputError(file.string() + ": is a folder; expected an image, PNG or EXR");
    static const Module module = load();
    if (!module.close)
        throw InputError(file.string() + ": neither PNG nor EXR but a " + kindOf(file) + ", which needs the module " +
                         kModule + " and OpenImageIO (" + module.why + "); install them, set " + kVariable +
                         " to the module's path, or convert the file to PNG or EXR");
    AaPicture picture{};
    const std::unique_ptr<void, AaClosePicture> opened(module.open(file.c_str(), &picture), module.close);
    if (!opened) throw InputError(file.string() + ": not an image that can be read; expected PNG or EXR");
    const auto [w, h, stored, isFloat] = picture;
    if (w < 1 || h < 1 || stored < 1) throw InputError(file.string() + ": has no pixels");
    if (w > kLargestSide || h > kLargestSide)
        throw InputError(file.string() + ": " + std::to_string(w) + " x " + std::to_string(h) +
                         " pixels; expected 1..16384 a side");
    const size_t channels = size_t(std::min(stored, 3));
    std::vector<float> pixels(size_t(w) * size_t(h) * channels);
    if (!module.read(opened.get(), int(channels), pixels.data()))
        throw InputError(file.string() + ": truncated or damaged; write the file again");
    LoadedImage image{Rgb(w, h), isFloat ? FileSpace::linear : FileSpace::encoded};
    for (size_t c = 0; c < 3; c++) {
        const float* from = pixels.data() + (channels == 3 ? c : 0);
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++, from += channels) image.rgb.c[c].at(x, y) = *from;
    }
    return image;
}

}  // namespace aa
