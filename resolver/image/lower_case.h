// Letters of ASCII as small ones: names and endings of files, channels, families.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

namespace aa {

inline std::string lowerCase(std::string_view text) {
    std::string s(text);
    for (char& c : s)
        if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
    return s;
}
inline std::string lowerExtension(const std::filesystem::path& file) { return lowerCase(file.extension().string()); }

}  // namespace aa
