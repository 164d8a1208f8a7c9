// A command writes over nothing that it has read: the user's shot, pictures and results stay what they are, whatever
// name its output is given.
#pragma once
#include <filesystem>

namespace aa {

// From now on what is read is remembered; the program begins with it.
void protectInputs();
void noteInput(const std::filesystem::path& file);
// A file of the command's own, which it goes on with.
void mayBeReplaced(const std::filesystem::path& file);
// Throws UsageError where the command has read `file`.
void requireNoInput(const std::filesystem::path& file);

}  // namespace aa
