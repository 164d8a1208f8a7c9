#include "image/io.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>

#include "image/error.h"
#include "image/exr.h"
#include "image/other_formats.h"
#include "image/output_error.h"
#include "image/png.h"

namespace aa {
namespace fs = std::filesystem;
constexpr const char* kDisplayReferred = "aaresolve:displayReferred";  // attribute of an EXR: 1 or 0

namespace {
constexpr std::string_view kPartial = ".partial";
// Between a file's stem and kPartial: who writes it. Two processes never share a temporary file, and what a killed one
// left behind is known for what it is.
std::string writerOf(const std::string& process) {
    char host[256] = {};
    ::gethostname(host, sizeof host - 1);
    std::ostringstream text;
    text << "." << std::hex << (std::hash<std::string_view>()(host) & 0xffffffff) << "-" << process;
    return text.str();
}
bool isRunning(long process) { return ::kill(pid_t(process), 0) == 0 || errno != ESRCH; }

// Removes the temporary files of processes of this machine that have ended.
void removePartials(const fs::path& folder) {
    std::error_code failed;
    const std::string mark = writerOf("");
    for (const auto& entry : fs::directory_iterator(folder, failed)) {
        const std::string name = entry.path().filename().string();
        const size_t partial = name.rfind(kPartial), writer = name.rfind(mark, partial);
        if (!name.starts_with(".") || partial == std::string::npos || writer == std::string::npos) continue;
        const std::string process = name.substr(writer + mark.size(), partial - writer - mark.size());
        long number = 0;
        const auto read = std::from_chars(process.data(), process.data() + process.size(), number);
        if (read.ec == std::errc() && read.ptr == process.data() + process.size() && number > 0 && !isRunning(number))
            fs::remove(entry.path(), failed);
    }
}
}  // namespace

fs::path temporaryName(const fs::path& file) {
    std::string name = ".";
    name += file.stem().string();
    name += writerOf(std::to_string(::getpid()));
    name += kPartial;
    name += file.extension().string();
    return file.parent_path() / name;
}

void renameInto(const fs::path& temporary, const fs::path& file) {
    std::error_code failed;
    fs::rename(temporary, file, failed);
    if (failed)
        throw OutputError(file.string() + ": cannot be put in place (" + failed.message() +
                          "); check the folder's permissions");
}

void makeWritableFolder(const fs::path& folder) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed || ::access(folder.c_str(), W_OK) != 0)
        throw OutputError(folder.string() + ": not a writable folder" + (failed ? " (" + failed.message() + ")" : "") +
                          "; choose another output folder or change its permissions");
    removePartials(folder);
}

void giveUpWriting(const fs::path& file, const std::string& why) {
    std::error_code ignored;
    fs::remove(temporaryName(file), ignored);
    throw OutputError(file.string() + ": cannot be written (" + why + "); check permissions and free disk space");
}

void writeBytes(const fs::path& file, std::span<const unsigned char> bytes) {
    const fs::path temporary = temporaryName(file);
    std::ofstream out(temporary, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    out.close();
    if (!out) giveUpWriting(file, std::generic_category().message(errno));
    renameInto(temporary, file);
}
void writeText(const fs::path& file, const std::string& text) {
    writeBytes(file, {reinterpret_cast<const unsigned char*>(text.data()), text.size()});
}

namespace {
// Whole numbers of 32 bits are codes too, of 2^32 - 1, when a file holds nothing else.
void fromCodes(const PlaneU& codes, PlaneF& values) {
    constexpr float kScale = 1.0f / 4294967295.0f;
    values = PlaneF(codes.width(), codes.height());
    for (int y = 0; y < codes.height(); y++)
        for (int x = 0; x < codes.width(); x++) values.at(x, y) = float(codes.at(x, y)) * kScale;
}
LoadedImage readExr(const fs::path& file) {
    ExrFile exr(file, "write the file again");
    const ExrPart& part = exr.parts()[0];
    const auto isUint = [](const ExrChannel& c) { return c.type == ChannelType::uint; };
    if (part.channels.empty()) throw InputError(file.string() + ": has no pixels");
    LoadedImage image;
    if (std::all_of(part.channels.begin(), part.channels.end(), isUint)) image.space = FileSpace::encoded;
    const auto mark = part.integers.find(kDisplayReferred);
    image.displayReferred = mark != part.integers.end() && mark->second != 0;
    const size_t channels = part.channels.size() < 3 ? 1 : 3;
    std::array<PlaneU, 3> codes;
    std::vector<ChannelTarget> targets;
    for (size_t c = 0; c < channels; c++)
        if (isUint(part.channels[c]))
            targets.push_back({part.channels[c].name, &codes[c]});
        else
            targets.push_back({part.channels[c].name, &image.rgb.c[c]});
    exr.read(part, targets);
    for (size_t c = 0; c < channels; c++)
        if (isUint(part.channels[c])) fromCodes(codes[c], image.rgb.c[c]);
    for (size_t c = channels; c < 3; c++) image.rgb.c[c] = image.rgb.c[0];
    return image;
}
}  // namespace

LoadedImage readImage(const fs::path& file) {
    if (!fs::exists(file)) throw InputError(file.string() + ": no such file");
    LoadedImage image = isExr(file)   ? readExr(file)
                        : isPng(file) ? LoadedImage{readPng(file), FileSpace::encoded}
                                      : readOtherFormat(file);
    image.rgb.fillBorder();
    return image;
}

void writeLayers(const fs::path& file, const std::vector<NamedPlanes>& layers) {
    if (layers.empty()) throw InputError(file.string() + ": this method has no debug layers");
    PartSource part;
    for (const auto& layer : layers)
        for (size_t i = 0; i < layer.planes.size(); i++)
            part.channels.push_back(
                {layer.planes.size() == 1 ? layer.name : layer.name + "." + "RGB"[i], &layer.planes[i]});
    writeParts(file, {part});
}

void writeExr(const fs::path& file, const Rgb& linear, bool displayReferred) {
    const std::vector<ChannelSource> channels = {{"R", &linear.c[0]}, {"G", &linear.c[1]}, {"B", &linear.c[2]}};
    writeParts(file, {{"", channels, {{kDisplayReferred, displayReferred ? 1 : 0}}}});
}

void writePng(const fs::path& file, const Rgb& encoded) {
    writeBytes(file, pngBytes(codesOf(encoded), encoded.width(), encoded.height(), {}));
}

}  // namespace aa
