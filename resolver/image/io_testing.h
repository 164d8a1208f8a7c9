// For tests: temporary files of this process and of one that has ended.
#pragma once
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "image/io.h"

namespace aa {

// What a killed process would have left of `file`.
inline std::filesystem::path leftover(const std::filesystem::path& file) {
    const pid_t ended = ::fork();
    if (ended == 0) ::_exit(0);
    ::waitpid(ended, nullptr, 0);
    const std::filesystem::path ours = temporaryName(file);
    std::string name = ours.filename().string();
    const std::string process = "-" + std::to_string(::getpid()) + ".";
    name.replace(name.rfind(process), process.size(), "-" + std::to_string(ended) + ".");
    return ours.parent_path() / name;
}
inline bool hasTemporaryFiles(const std::filesystem::path& folder) {
    const auto entries = std::filesystem::recursive_directory_iterator(folder);
    return std::any_of(begin(entries), end(entries), [](const auto& entry) {
        return entry.path().filename().string().find(".partial") != std::string::npos;
    });
}

}  // namespace aa
