#include "study/external.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>

#include "image/error.h"
#include "image/io.h"
#include "image/lower_case.h"
#include "image/readable.h"
#include "shot/import/folder.h"

namespace aa {
namespace fs = std::filesystem;
namespace {

// One picture for each frame.
std::map<int, fs::path> picturesIn(const fs::path& folder) {
    std::error_code failed;
    requireFolder(folder, "; expected one EXR or PNG for each frame");
    std::vector<fs::path> files;
    for (fs::directory_iterator it(folder, failed), end; !failed && it != end; it.increment(failed)) {
        const std::string extension = lowerExtension(it->path());
        if ((extension == ".exr" || extension == ".png") && !it->path().filename().string().starts_with('.') &&
            it->path().stem().extension() != ".layers")
            files.push_back(it->path());
    }
    if (failed)
        throw InputError(folder.string() + ": cannot be read (" + failed.message() + "); check its permissions");
    std::sort(files.begin(), files.end());
    files = ofOneKind(std::move(files), PictureKind::exr);
    std::map<int, fs::path> pictures;
    for (const auto& file : files) {
        const std::optional<int> number = frameNumberOf(file.filename().string());
        if (!number) throw InputError(file.string() + ": no frame number in its name; name it like 0001.exr");
        const auto [other, isNew] = pictures.emplace(*number, file);
        if (!isNew)
            throw InputError(folder.string() + ": both " + other->second.filename().string() + " and " +
                             file.filename().string() + " are frame " + std::to_string(*number) +
                             "; give each sequence a folder of its own");
        if (lowerExtension(file) != lowerExtension(files[0]))
            throw InputError(folder.string() + ": holds both EXR and PNG; give each kind a folder of its own");
    }
    if (pictures.empty()) throw InputError(folder.string() + ": holds no EXR and no PNG; expected one for each frame");
    return pictures;
}

// What kind of values its files hold: told by the first, expected of the others.
struct Kind {
    FileSpace space = FileSpace::linear;
    bool displayReferred = false;
    bool isEncoded() const { return space == FileSpace::encoded || displayReferred; }
};
std::string inWords(const Kind& k) {
    return k.space == FileSpace::encoded ? "8- or 16-bit codes"
           : k.displayReferred           ? "displayed light"
                                         : "linear light";
}

class ExternalMethod : public Method {
  public:
    ExternalMethod(std::map<int, fs::path> pictures, Kind kind, DisplayChain chain)
        : pictures_(std::move(pictures)), kind_(kind), chain_(chain) {}

    void resolve(const Frame& frame, const Exec& exec, Rgb& out) override {
        const auto it = pictures_.find(frame.number);
        if (it == pictures_.end())
            throw InputError(pictures_.begin()->second.parent_path().string() + ": no picture of frame " +
                             std::to_string(frame.number) + " among its " + std::to_string(pictures_.size()) + " (" +
                             std::to_string(pictures_.begin()->first) + " to " +
                             std::to_string(pictures_.rbegin()->first) + "); add it, or choose frames by --frames");
        LoadedImage image = readImage(it->second);
        showDisplayWindow(image, it->second);
        const auto size = [](int w, int h) { return std::to_string(w) + "x" + std::to_string(h); };
        if (image.rgb.width() != frame.width || image.rgb.height() != frame.height)
            throw InputError(it->second.string() + ": expected " + size(frame.width, frame.height) +
                             " pixels as in the shot, found " + size(image.rgb.width(), image.rgb.height()) +
                             "; render it at the shot's resolution");
        if (const Kind found{image.space, image.displayReferred}; found.isEncoded() != kind_.isEncoded())
            throw InputError(it->second.string() + ": expected " + inWords(kind_) + " as in " +
                             pictures_.begin()->second.filename().string() + ", found " + inWords(found));
        requireFinite(image.rgb, it->second);
        if (image.space == FileSpace::encoded)
            out = std::move(image.rgb);
        else if (image.displayReferred)
            encode(image.rgb, chain_.transferOnly(), exec, out);
        else if (chain_.transfer == Transfer::identity)
            encode(image.rgb, chain_, exec, out);  // as the frame's own colours: one space for everything
        else
            out = std::move(image.rgb);
    }

  private:
    static void requireFinite(const Rgb& image, const fs::path& file) {
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < image.height(); y++)
                for (int x = 0; x < image.width(); x++)
                    if (!std::isfinite(image.c[c].at(x, y)))
                        throw InputError(file.string() + ": pixel (" + std::to_string(x) + ", " + std::to_string(y) +
                                         ") is " + (std::isnan(image.c[c].at(x, y)) ? "NaN" : "infinite") +
                                         ", which no figure can be made of; write finite colours");
    }
    std::map<int, fs::path> pictures_;
    Kind kind_;
    DisplayChain chain_;
};

void requireName(const std::string& name) {
    const auto fits = [](unsigned char c) { return std::isalnum(c) || c == '.' || c == '_' || c == '-'; };
    if (name.empty() || name[0] == '.' || name[0] == '-' || !std::all_of(name.begin(), name.end(), fits))
        throw UsageError("--external: expected a name of letters, digits, '.', '_' and '-', found '" + name + "'");
    // Beside the folders lie results.json, sheet.png and their like.
    for (const char* ending : {".json", ".csv", ".html", ".svg", ".png", ".exr", ".pdf", ".webp", ".gif", ".apng"})
        if (lowerCase(name).ends_with(ending))
            throw UsageError("--external: '" + name + "' is a file's name, expected a row's; leave out '" + ending +
                             "'");
    const auto isTaken = [&](const auto& m) { return m.id == name; };
    if (name == "truth" || name == "maps" || std::any_of(registry().begin(), registry().end(), isTaken))
        throw UsageError("--external: '" + name + "' is taken; give the pictures another name");
}

// What the descriptor's texts point into.
struct Owned {
    std::string name, title, source;
    MethodDescriptor descriptor;
};
}  // namespace

MethodSpec externalMethod(const std::string& name, const fs::path& folder, const DisplayChain& chain) {
    requireName(name);
    const auto pictures = picturesIn(folder);
    const LoadedImage first = readImage(pictures.begin()->second);
    const Kind kind{first.space, first.displayReferred};
    auto own = std::make_shared<Owned>();
    own->name = name;
    own->title = name + ", made elsewhere";
    own->source = folder.string();
    own->descriptor = {
        .id = own->name,
        .title = own->title,
        .family = kExternalFamily,
        .summary = "Pictures that were made elsewhere.",
        .source = own->source,
        .output = kind.isEncoded() || chain.transfer == Transfer::identity ? Space::encoded : Space::linear,
        .temporal = true,  // held against the frames as they were jittered, and over time
        .fixedSet = true,  // its history is its own
        .create = [pictures, kind, chain](const Params&, const ShotInfo&) {
            return std::make_unique<ExternalMethod>(pictures, kind, chain);
        }};
    MethodSpec spec;
    spec.text = name;
    spec.method = &own->descriptor;
    spec.owner = own;
    return spec;
}

MethodSpec externalMethod(const std::string& text, const DisplayChain& chain) {
    const size_t equals = text.find('=');
    if (equals == std::string::npos || equals + 1 == text.size())
        throw UsageError("--external: expected NAME=FOLDER, found '" + text + "'");
    return externalMethod(text.substr(0, equals), fs::path(text.substr(equals + 1)), chain);
}

}  // namespace aa
