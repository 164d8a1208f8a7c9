// What an EXR's header asks for, before OpenEXR makes room for it: an attribute's size stands in front of it, and a
// file of 100 bytes may say two thousand million.
#pragma once
#include <filesystem>

namespace aa {

// Throws std::runtime_error, with the attribute's name, when one is said to be larger than what is left of the file or
// has another size than its type.
// Whatever else is wrong with a header OpenEXR tells.
void checkAttributeSizes(const std::filesystem::path& file);

}  // namespace aa
