#include "shot/import/folder.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <set>

#include "image/error.h"
#include "image/lower_case.h"
#include "image/readable.h"
#include "shot/import/blender_exr.h"
#include "shot/manifest.h"

namespace aa {
namespace fs = std::filesystem;
namespace {
int toFrame(std::string_view digits) {
    int n = -1;
    const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), n);
    return failed == std::errc{} && end == digits.data() + digits.size() && n <= kLastFrame ? n : -1;
}
}  // namespace

namespace {
// A group of digits in a name, and whether a minus stands before it that does not part two words.
struct Digits {
    int number = -1;
    bool negative = false;
};
std::vector<Digits> digitsOf(const std::string& stem) {
    const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
    std::vector<Digits> all;
    for (size_t i = 0; i < stem.size();) {
        if (!isDigit(stem[i])) {
            i++;
            continue;
        }
        size_t end = i;
        while (end < stem.size() && isDigit(stem[end])) end++;
        const bool minus = i > 0 && stem[i - 1] == '-';
        const bool partsWords = i > 1 && std::isalnum(static_cast<unsigned char>(stem[i - 2]));
        all.push_back({toFrame(std::string_view(stem).substr(i, end - i)), minus && !partsWords});
        i = end;
    }
    return all;
}
// The frame that the file's header names: "0001", "-004".
std::optional<int> headerFrame(const fs::path& file) {
    std::string text;
    try {
        text = BlenderExr(file).text("Frame").value_or("");
    } catch (const InputError&) {  // damaged: said when its turn comes
    }
    const bool negative = text.starts_with('-');
    const int n = toFrame(std::string_view(text).substr(negative));
    return n < 0 ? std::nullopt : std::optional(negative ? -n : n);
}
[[noreturn]] void refuseNegative(const fs::path& file) {
    throw InputError(file.string() +
                     ": a frame before 0; a shot's frames count from 0 on: move the animation's start to 0 or later, "
                     "or number the files anew");
}
// The header's frame where the name holds that number, else the name's last one, else the header's. A name alone does
// not tell "shot-0004", frame 4 of "shot-", from frame -4 of "shot", nor frame 7 of "0007_v2" from frame 2.
int frameOf(const fs::path& file) {
    const std::vector<Digits> digits = digitsOf(file.stem().string());
    const std::optional<int> header = headerFrame(file);
    const auto inName = [&](int n) {
        return std::any_of(digits.begin(), digits.end(), [&](const auto& d) { return d.number == std::abs(n); });
    };
    if (header && (digits.empty() || inName(*header))) {
        if (*header < 0) refuseNegative(file);
        return *header;
    }
    if (digits.empty() || digits.back().number < 0)
        throw InputError(file.string() + ": no frame number in its name nor in its attributes; name it like 0001.exr");
    if (digits.back().negative) refuseNegative(file);
    return digits.back().number;
}
}  // namespace

std::optional<int> frameNumberOf(const std::string& fileName) {
    const std::vector<Digits> digits = digitsOf(fs::path(fileName).stem().string());
    if (digits.empty() || digits.back().number < 0) return std::nullopt;
    return digits.back().negative ? -digits.back().number : digits.back().number;
}

std::vector<fs::path> ofOneKind(std::vector<fs::path> files, PictureKind kept) {
    std::set<fs::path> exrs, pngs;
    for (const auto& file : files) (lowerExtension(file) == ".exr" ? exrs : pngs).insert(file.stem());
    if (exrs != pngs) return files;
    std::erase_if(files, [&](const auto& f) { return (lowerExtension(f) == ".exr") != (kept == PictureKind::exr); });
    return files;
}

std::map<int, fs::path> renderedFrames(const fs::path& folder) {
    requireFolder(folder, "; expected rendered frames (OpenEXR MultiLayer)");
    std::error_code failed;
    std::vector<fs::path> files;
    size_t displayReferred = 0;
    for (fs::directory_iterator it(folder, failed), end; it != end; it.increment(failed)) {
        const std::string extension = lowerExtension(it->path());
        if (it->path().filename().string().starts_with(".")) continue;
        if (extension == ".exr") files.push_back(it->path());
        displayReferred += extension == ".png" || extension == ".jpg" || extension == ".jpeg" || extension == ".tif";
    }
    if (failed)
        throw InputError(folder.string() + ": cannot be read (" + failed.message() + "); check its permissions");
    if (files.empty())
        throw InputError(folder.string() + ": holds no EXR" +
                         (displayReferred ? " but " + std::to_string(displayReferred) +
                                                " PNG, JPEG or TIFF pictures, which are tone-mapped and hold no depth, "
                                                "motion or ids"
                                          : "") +
                         "; render with the output format OpenEXR MultiLayer");
    std::sort(files.begin(), files.end());
    std::map<int, fs::path> frames;
    for (const auto& file : files) {
        const int number = frameOf(file);
        const auto [other, isNew] = frames.emplace(number, file);
        if (!isNew)
            throw InputError(folder.string() + ": both " + other->second.filename().string() + " and " +
                             file.filename().string() + " are frame " + std::to_string(number) +
                             "; give each sequence a folder of its own");
    }
    return frames;
}

}  // namespace aa
