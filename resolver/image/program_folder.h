// Where this program's own files are.
#pragma once

#include <filesystem>

namespace aa {

// The folder that holds the running program; empty when the system does not say (no /proc).
std::filesystem::path programFolder();

}  // namespace aa
