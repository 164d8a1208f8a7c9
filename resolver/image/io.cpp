#include "image/io.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <mutex>
#include <set>
#include <sstream>
#include <string_view>
#include <system_error>

#include "image/error.h"
#include "image/exr.h"
#include "image/exr_layers.h"
#include "image/inputs.h"
#include "image/other_formats.h"
#include "image/output_error.h"
#include "image/png.h"
#include "image/readable.h"

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
// When a process first writes into a folder: a single file is asked for in any.
void clearOnce(const fs::path& folder) {
    static std::mutex one;
    static std::set<fs::path> cleared;
    const std::lock_guard lock(one);
    if (cleared.insert(folder).second) removePartials(folder.empty() ? "." : folder);
}
// What a link leads to is written, and not the link.
fs::path behindLinks(const fs::path& file) {
    std::error_code failed;
    if (!fs::is_symlink(fs::symlink_status(file, failed))) return file;
    const fs::path target = fs::weakly_canonical(file, failed);
    return failed ? file : target;
}
// A device or a pipe stays one: it is written as it is.
bool isWrittenAsItIs(const fs::path& file) {
    std::error_code failed;
    const fs::file_status about = fs::status(file, failed);
    return fs::exists(about) && !fs::is_regular_file(about) && !fs::is_directory(about);
}
}  // namespace

fs::path temporaryName(const fs::path& file) {
    if (isWrittenAsItIs(file)) return file;
    requireNoInput(file);
    const fs::path target = behindLinks(file);
    clearOnce(target.parent_path());
    // Of a long name as much as leaves room for the rest: names have at most 255 bytes.
    std::string name = "." + target.stem().string().substr(0, 180);
    name += writerOf(std::to_string(::getpid()));
    name += kPartial;
    name += target.extension().string();
    return target.parent_path() / name;
}

void renameInto(const fs::path& temporary, const fs::path& file) {
    if (temporary == file) return;
    std::error_code failed;
    fs::rename(temporary, behindLinks(file), failed);
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
    if (!isWrittenAsItIs(file)) fs::remove(temporaryName(file), ignored);
    throw OutputError(file.string() + ": cannot be written (" + why + "); check permissions and free disk space");
}

void requireWritable(const fs::path& file) {
    requireNoInput(file);
    const fs::path folder = file.has_parent_path() ? file.parent_path() : ".";
    std::error_code ignored;
    if (::access(folder.c_str(), W_OK | X_OK) != 0) giveUpWriting(file, std::generic_category().message(errno));
    if (!fs::is_directory(folder, ignored)) giveUpWriting(file, std::generic_category().message(ENOTDIR));
    if (fs::is_directory(file, ignored)) giveUpWriting(file, std::generic_category().message(EISDIR));
}

void writeStream(const fs::path& file, const std::function<void(std::ostream&)>& content) {
    const fs::path temporary = temporaryName(file);
    std::ofstream out(temporary, std::ios::binary);
    content(out);
    out.close();
    if (!out) giveUpWriting(file, std::generic_category().message(errno));
    renameInto(temporary, file);
}
void writeBytes(const fs::path& file, std::span<const unsigned char> bytes) {
    writeStream(file, [&](std::ostream& out) {
        out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    });
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
LoadedImage readExr(const fs::path& file, const std::string& asked) {
    ExrFile exr(file, "write the file again");
    const ExrLayer layer = chooseLayer(exr, asked);
    const ExrPart& part = exr.parts()[layer.part];
    std::vector<std::string> names = layer.rgb;
    if (names.empty())
        names.assign(layer.channels.begin(), layer.channels.begin() + (layer.channels.size() < 3 ? 1 : 3));
    const auto isUint = [&](const std::string& c) { return part.find(c)->type == ChannelType::uint; };
    LoadedImage image;
    if (std::all_of(layer.channels.begin(), layer.channels.end(), isUint)) image.space = FileSpace::encoded;
    image.half = part.find(names[0])->type == ChannelType::half;
    image.shown = part.shown;
    if (layersOf(exr).size() > 1) image.layer = layer.name;
    const auto mark = part.integers.find(kDisplayReferred);
    image.displayReferred = mark != part.integers.end() && mark->second != 0;
    std::array<PlaneU, 4> codes;
    std::array<PlaneF*, 4> planes = {&image.rgb.c[0], &image.rgb.c[1], &image.rgb.c[2], &image.alpha};
    std::vector<ChannelTarget> targets;
    const size_t colours = names.size();
    if (layer.alpha && std::find(names.begin(), names.end(), *layer.alpha) == names.end())
        names.push_back(*layer.alpha);
    const auto planeOf = [&](size_t i) { return i < colours ? i : 3; };
    for (size_t i = 0; i < names.size(); i++)
        if (isUint(names[i]))
            targets.push_back({names[i], &codes[planeOf(i)]});
        else
            targets.push_back({names[i], planes[planeOf(i)]});
    exr.read(part, targets);
    for (size_t i = 0; i < names.size(); i++)
        if (isUint(names[i])) fromCodes(codes[planeOf(i)], *planes[planeOf(i)]);
    for (size_t c = colours; c < 3; c++) image.rgb.c[c] = image.rgb.c[0];
    return image;
}

// Upright, of a picture that is to be shown as EXIF's orientation says (1 to 8; anything else: as it is).
PlaneF upright(const PlaneF& in, int orientation) {
    const bool swaps = orientation >= 5;
    const int w = in.width(), h = in.height();
    PlaneF out(swaps ? h : w, swaps ? w : h);
    for (int y = 0; y < out.height(); y++)
        for (int x = 0; x < out.width(); x++) {
            int i = swaps ? y : x, j = swaps ? x : y;
            if (orientation == 2 || orientation == 3 || orientation == 7 || orientation == 8) i = w - 1 - i;
            if (orientation == 3 || orientation == 4 || orientation == 6 || orientation == 7) j = h - 1 - j;
            out.at(x, y) = in.at(i, j);
        }
    return out;
}
PlaneF shownOf(const PlaneF& in, const Window& shown) {
    PlaneF out(shown.width, shown.height);
    for (int y = 0; y < shown.height; y++)
        for (int x = 0; x < shown.width; x++) {
            const int64_t i = int64_t(x) + shown.x, j = int64_t(y) + shown.y;
            if (i >= 0 && j >= 0 && i < in.width() && j < in.height()) out.at(x, y) = in.at(int(i), int(j));
        }
    out.fillBorder();
    return out;
}
}  // namespace

bool LoadedImage::isOpaque() const {
    return alpha.empty() || !anyValue(alpha, [](float v) { return v != 1; });
}

void willRead(const fs::path& file) {
#ifdef POSIX_FADV_WILLNEED
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) return;
    ::posix_fadvise(descriptor, 0, 0, POSIX_FADV_WILLNEED);
    ::close(descriptor);
#endif
}

LoadedImage readImage(const fs::path& file, const ReadOptions& o) {
    noteInput(file);
    std::error_code ignored;
    requireReadable(file);
    if (!fs::is_regular_file(file, ignored) && !fs::is_directory(file, ignored))
        throw InputError(file.string() + ": is a pipe or a device; expected an image, PNG or EXR");
    const bool exr = isExr(file);
    if (!exr && !o.layer.empty()) throw UsageError("--layer " + o.layer + ": " + file.string() + " is no EXR");
    StoredPicture stored;
    if (!exr) stored = isPng(file) ? readPng(file) : readOtherFormat(file);
    LoadedImage image;
    if (exr) {
        image = readExr(file, o.layer);
    } else {
        image.rgb = std::move(stored.rgb), image.alpha = std::move(stored.alpha);
        image.space = stored.isFloat ? FileSpace::linear : FileSpace::encoded;
        if (stored.orientation > 1 && stored.orientation <= 8) {
            for (auto& plane : image.rgb.c) plane = upright(plane, stored.orientation);
            if (!image.alpha.empty()) image.alpha = upright(image.alpha, stored.orientation);
        }
        image.shown = {0, 0, image.rgb.width(), image.rgb.height()};
    }
    image.counts =
        sanitiseColour(image.rgb, image.half, o.policy, o.use,
                       {file.string() + (image.layer.empty() ? "" : ", layer '" + image.layer + "'"), {"R", "G", "B"}});
    image.rgb.fillBorder();
    return image;
}

void showDisplayWindow(LoadedImage& image, const fs::path& file) {
    if (image.allShown()) return;
    const Window& w = image.shown;
    if (w.width < 1 || w.height < 1 || w.width > kLargestSide || w.height > kLargestSide)
        throw InputError(file.string() + ": its display window has " + std::to_string(w.width) + " x " +
                         std::to_string(w.height) + " pixels; expected 1..16384 a side");
    for (auto& plane : image.rgb.c) plane = shownOf(plane, w);
    if (!image.alpha.empty()) image.alpha = shownOf(image.alpha, w);
    image.shown = {0, 0, w.width, w.height};
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

void writeExr(const fs::path& file, const Rgb& linear, bool displayReferred, const Beside& beside) {
    std::vector<ChannelSource> channels = {{"R", &linear.c[0]}, {"G", &linear.c[1]}, {"B", &linear.c[2]}};
    if (beside.alpha) channels.push_back({"A", beside.alpha});
    writeParts(file, {{"", channels, {{kDisplayReferred, displayReferred ? 1 : 0}}, beside.shown}});
}

void writePng(const fs::path& file, const Rgb& encoded, const PlaneF* alpha) {
    writeBytes(file, pngBytes(codesOf(encoded, alpha), encoded.width(), encoded.height(),
                              {.alpha = alpha != nullptr, .quick = true}));
}

}  // namespace aa
