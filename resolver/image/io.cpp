#include "image/io.h"

#include <OpenImageIO/imageio.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "image/error.h"
#include "image/no_date.h"

namespace aa {
namespace fs = std::filesystem;
constexpr int kLargestSide = 16384;  // conventions 10

using OIIO::ImageInput;
using OIIO::ImageOutput;
using OIIO::ImageSpec;
using OIIO::TypeDesc;

fs::path temporaryName(const fs::path& file) {
    std::string name = ".";
    name += file.stem().string();
    name += ".partial";
    name += file.extension().string();
    return file.parent_path() / name;
}

void renameInto(const fs::path& temporary, const fs::path& file) {
    std::error_code failed;
    fs::rename(temporary, file, failed);
    if (failed)
        throw InputError(file.string() + ": cannot be put in place (" + failed.message() +
                         "); check the folder's permissions");
}

void makeWritableFolder(const fs::path& folder) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed || ::access(folder.c_str(), W_OK) != 0)
        throw InputError(folder.string() + ": not a writable folder" + (failed ? " (" + failed.message() + ")" : "") +
                         "; choose another output folder or change its permissions");
}

void writeText(const fs::path& file, const std::string& text) {
    const fs::path temporary = temporaryName(file);
    std::ofstream out(temporary, std::ios::binary);
    out << text;
    out.close();
    if (!out) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw InputError(file.string() + ": cannot be written; check permissions and free disk space");
    }
    renameInto(temporary, file);
}

LoadedImage readImage(const fs::path& file) {
    if (!fs::exists(file)) throw InputError(file.string() + ": no such file");
    auto in = ImageInput::open(file.string());
    if (!in) {
        OIIO::geterror();
        throw InputError(file.string() + ": not an image that can be read; expected PNG or EXR");
    }
    const ImageSpec& spec = in->spec();
    if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1) throw InputError(file.string() + ": has no pixels");
    if (spec.width > kLargestSide || spec.height > kLargestSide)
        throw InputError(file.string() + ": " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                         " pixels; expected 1..16384 a side");
    const int channels = std::min(spec.nchannels, 3);
    std::vector<float> pixels(size_t(spec.width) * size_t(spec.height) * size_t(channels));
    if (!in->read_image(0, 0, 0, channels, TypeDesc::FLOAT, pixels.data())) {
        in->geterror();
        throw InputError(file.string() + ": truncated or damaged; write the file again");
    }
    LoadedImage image{Rgb(spec.width, spec.height),
                      spec.format.is_floating_point() ? FileSpace::linear : FileSpace::encoded};
    image.displayReferred = spec.get_int_attribute("aaresolve:displayReferred", 0) != 0;
    for (int c = 0; c < 3; c++) {
        const int from = channels == 3 ? c : 0;
        for (int y = 0; y < spec.height; y++)
            for (int x = 0; x < spec.width; x++)
                image.rgb.c[size_t(c)].at(x, y) =
                    pixels[(size_t(y) * size_t(spec.width) + size_t(x)) * size_t(channels) + size_t(from)];
    }
    image.rgb.fillBorder();
    return image;
}

namespace {
// Writes interleaved pixels under a temporary name and renames.
void writePixels(const fs::path& file, const ImageSpec& spec, const void* pixels) {
    const fs::path temporary = temporaryName(file);
    auto out = ImageOutput::create(temporary.string());
    std::string why = out ? "" : OIIO::geterror();
    if (out && (!out->open(temporary.string(), spec) || !out->write_image(spec.format, pixels) || !out->close()))
        why = out->geterror();
    if (!why.empty()) {
        std::error_code ignored;
        fs::remove(temporary, ignored);
        throw InputError(file.string() + ": cannot be written (" + why.substr(0, why.find('\n')) +
                         "); check permissions and free disk space");
    }
    renameInto(temporary, file);
}
template <class T, class Convert>
void writeRgb(const fs::path& file, const Rgb& image, const ImageSpec& spec, Convert convert) {
    const int w = image.width(), h = image.height();
    std::vector<T> pixels(size_t(w) * size_t(h) * 3);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            for (int c = 0; c < 3; c++)
                pixels[(size_t(y) * size_t(w) + size_t(x)) * 3 + size_t(c)] = convert(image.c[size_t(c)].at(x, y));
    writePixels(file, spec, pixels.data());
}
}  // namespace

void writeLayers(const fs::path& file, const std::vector<NamedPlanes>& layers) {
    if (layers.empty()) throw InputError(file.string() + ": this method has no debug layers");
    std::vector<const PlaneF*> planes;
    std::vector<std::string> channels;
    for (const auto& layer : layers)
        for (size_t i = 0; i < layer.planes.size(); i++) {
            planes.push_back(&layer.planes[i]);
            channels.push_back(layer.planes.size() == 1 ? layer.name : layer.name + "." + "RGB"[i]);
        }
    const int w = planes[0]->width(), h = planes[0]->height(), n = int(planes.size());
    std::vector<float> pixels(size_t(w) * size_t(h) * size_t(n));
    for (int c = 0; c < n; c++)
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++)
                pixels[(size_t(y) * size_t(w) + size_t(x)) * size_t(n) + size_t(c)] = planes[size_t(c)]->at(x, y);
    ImageSpec spec(w, h, n, TypeDesc::FLOAT);
    spec.channelnames = channels;
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", kNoDate);
    writePixels(file, spec, pixels.data());
}

void writeExr(const fs::path& file, const Rgb& linear, bool displayReferred) {
    ImageSpec spec(linear.width(), linear.height(), 3, TypeDesc::FLOAT);
    spec.attribute("compression", "zip");
    spec.attribute("DateTime", kNoDate);
    spec.attribute("oiio:ColorSpace", "Linear");
    spec.attribute("aaresolve:displayReferred", displayReferred ? 1 : 0);
    writeRgb<float>(file, linear, spec, [](float v) { return v; });
}

void writePng(const fs::path& file, const Rgb& encoded) {
    ImageSpec spec(encoded.width(), encoded.height(), 3, TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    writeRgb<uint8_t>(file, encoded, spec,
                      [](float v) { return uint8_t(std::floor(255.0f * (v > 0 ? (v < 1 ? v : 1.0f) : 0.0f) + 0.5f)); });
}

}  // namespace aa
