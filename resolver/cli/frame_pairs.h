// Which pictures of two folders belong together.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace aa {

struct FramePair {
    std::string name;  // of the first, without its extension
    std::filesystem::path a, b;
};
struct FramePairs {
    std::vector<FramePair> pairs;
    std::string by;  // "name", "number", "order"; empty for two pictures
};
// Two pictures, or those of two folders (PNG, EXR). `by`: name = equal but for the extension; number = the last number
// of the name; order = the first with the first; auto = by name where all names agree, else by number. Throws
// UsageError, InputError: a picture without its partner, two of one name or number.
FramePairs pairFrames(const std::filesystem::path& a, const std::filesystem::path& b, const std::string& by);

}  // namespace aa
