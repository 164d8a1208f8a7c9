#include "shot/import/folder.h"

#include <algorithm>
#include <charconv>
#include <vector>

#include "image/error.h"
#include "shot/import/blender_exr.h"

namespace aa {
namespace fs = std::filesystem;
namespace {
constexpr int kLargestFrame = 1048574;  // Blender's MAXFRAME

std::string lowerExtension(const fs::path& file) {
    std::string e = file.extension().string();
    std::transform(e.begin(), e.end(), e.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return e;
}
int toFrame(std::string_view digits) {
    int n = -1;
    const auto [end, failed] = std::from_chars(digits.data(), digits.data() + digits.size(), n);
    return failed == std::errc{} && end == digits.data() + digits.size() && n <= kLargestFrame ? n : -1;
}
}  // namespace

int frameNumberOf(const std::string& fileName) {
    const std::string stem = fs::path(fileName).stem().string();
    const size_t last = stem.find_last_of("0123456789");
    if (last == std::string::npos) return -1;
    size_t first = last;
    while (first > 0 && stem[first - 1] >= '0' && stem[first - 1] <= '9') first--;
    return toFrame(std::string_view(stem).substr(first, last + 1 - first));
}

std::map<int, fs::path> renderedFrames(const fs::path& folder) {
    std::error_code failed;
    if (!fs::is_directory(folder, failed))
        throw InputError(folder.string() + ": no such folder; expected rendered frames (OpenEXR MultiLayer)");
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
        int number = frameNumberOf(file.filename().string());
        if (number < 0) number = toFrame(BlenderExr(file).text("Frame").value_or(""));
        if (number < 0)
            throw InputError(file.string() +
                             ": no frame number in its name nor in its attributes; name it like 0001.exr");
        const auto [other, isNew] = frames.emplace(number, file);
        if (!isNew)
            throw InputError(folder.string() + ": both " + other->second.filename().string() + " and " +
                             file.filename().string() + " are frame " + std::to_string(number) +
                             "; give each sequence a folder of its own");
    }
    return frames;
}

}  // namespace aa
