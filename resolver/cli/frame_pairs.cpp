#include "cli/frame_pairs.h"

#include <algorithm>
#include <map>

#include "image/error.h"
#include "image/inputs.h"
#include "image/lower_case.h"
#include "image/readable.h"
#include "shot/import/folder.h"

namespace aa {
namespace fs = std::filesystem;
namespace {

bool isPicture(const fs::path& p) {
    const std::string e = p.extension().string();
    return (e == ".png" || e == ".exr" || e == ".PNG" || e == ".EXR") && !p.filename().string().starts_with('.') &&
           p.stem().extension() != ".layers";
}
std::vector<fs::path> picturesIn(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const auto& e : fs::directory_iterator(folder))
        if (e.is_regular_file() && isPicture(e.path())) files.push_back(e.path());
    std::sort(files.begin(), files.end());
    if (files.empty()) throw InputError(folder.string() + ": no PNG or EXR frames in this folder");
    return files;
}
// Of pictures that are there as EXR and as PNG: which of them goes with these. EXR holds more.
PictureKind kindBeside(const std::vector<fs::path>& others) {
    const auto isPng = [](const fs::path& p) { return lowerExtension(p) == ".png"; };
    return std::all_of(others.begin(), others.end(), isPng) ? PictureKind::png : PictureKind::exr;
}
// By a key; empty where two pictures share one or a name holds none, which `complaint` tells.
template <class Key>
std::map<Key, fs::path> keyed(const std::vector<fs::path>& files, Key (*keyOf)(const fs::path&),
                              std::string& complaint) {
    std::map<Key, fs::path> all;
    for (const auto& file : files) {
        const auto [other, isNew] = all.emplace(keyOf(file), file);
        if (isNew) continue;
        complaint = file.parent_path().string() + ": " + other->second.filename().string() + " and " +
                    file.filename().string() + " are both frame " + file.stem().string() + "; keep one of them";
        if constexpr (std::is_same_v<Key, std::optional<int>>)
            complaint = file.parent_path().string() + ": " + other->second.filename().string() + " and " +
                        file.filename().string() + " have the same number or none; pair them by --pair order";
        return {};
    }
    return all;
}
std::string nameOf(const fs::path& file) { return file.stem().string(); }
std::optional<int> numberOf(const fs::path& file) { return frameNumberOf(file.filename().string()); }

template <class Key>
bool sameKeys(const std::map<Key, fs::path>& a, const std::map<Key, fs::path>& b) {
    return !a.empty() &&
           std::equal(a.begin(), a.end(), b.begin(), b.end(), [](auto& x, auto& y) { return x.first == y.first; });
}
template <class Key>
void requirePartners(const std::map<Key, fs::path>& a, const fs::path& folderA, const std::map<Key, fs::path>& b,
                     const fs::path& folderB, const std::string& what) {
    const auto lacks = [&](const auto& some, const auto& other, const fs::path& has, const fs::path& misses) {
        for (const auto& [key, file] : some)
            if (!other.contains(key))
                throw InputError(misses.string() + ": no frame of the " + what + " of '" + file.filename().string() +
                                 "', which " + has.string() +
                                 " has; --pair name, number or order says what belongs together");
    };
    lacks(a, b, folderA, folderB);
    lacks(b, a, folderB, folderA);
}
template <class Key>
FramePairs joined(const std::map<Key, fs::path>& a, const std::map<Key, fs::path>& b, const std::string& by) {
    FramePairs r{{}, by};
    for (const auto& [key, file] : a) r.pairs.push_back({file.stem().string(), file, b.at(key)});
    return r;
}
}  // namespace

FramePairs pairFrames(const fs::path& a, const fs::path& b, const std::string& by) {
    for (const auto& p : {a, b}) requireReadable(p), noteInput(p);
    if (fs::is_directory(a) != fs::is_directory(b))
        throw UsageError("compare: '" + a.string() + "' and '" + b.string() +
                         "' must both be images or both be folders of frames");
    if (!fs::is_directory(a)) return {{{a.filename().string(), a, b}}, ""};
    const auto allA = picturesIn(a), allB = picturesIn(b);
    const auto inA = ofOneKind(allA, kindBeside(allB)), inB = ofOneKind(allB, kindBeside(allA));
    if (by == "order") {
        if (inA.size() != inB.size())
            throw InputError(b.string() + ": expected " + std::to_string(inA.size()) + " frames as in " + a.string() +
                             ", found " + std::to_string(inB.size()) + "; only as many can be paired by their order");
        FramePairs r{{}, by};
        for (size_t i = 0; i < inA.size(); i++) r.pairs.push_back({inA[i].stem().string(), inA[i], inB[i]});
        return r;
    }
    std::string complaint;
    const auto namesA = keyed(inA, nameOf, complaint), namesB = keyed(inB, nameOf, complaint);
    if (by == "name" || (by == "auto" && sameKeys(namesA, namesB))) {
        if (!complaint.empty()) throw InputError(complaint);
        requirePartners(namesA, a, namesB, b, "name");
        return joined(namesA, namesB, "name");
    }
    std::string unnumbered;
    const auto numbersA = keyed(inA, numberOf, unnumbered), numbersB = keyed(inB, numberOf, unnumbered);
    if (!unnumbered.empty()) throw InputError(by == "auto" && !complaint.empty() ? complaint : unnumbered);
    requirePartners(numbersA, a, numbersB, b, "number");
    return joined(numbersA, numbersB, "number");
}

}  // namespace aa
