// Why a file cannot be read: that it is missing asks for something else than that it may not be opened.
#pragma once
#include <filesystem>
#include <string>

namespace aa {

// Throws InputError, one line: "no such file", ended by `ifMissing`, or not permitted. What else may be wrong with it
// (a folder, a device, its content) is the reader's to say.
void requireReadable(const std::filesystem::path& file, const std::string& ifMissing = "");
// The same of a folder that is to be listed; also for what is no folder.
void requireFolder(const std::filesystem::path& folder, const std::string& ifMissing = "");
// All of a text file. Throws InputError as above, and for a folder or a device.
std::string requiredText(const std::filesystem::path& file, const std::string& ifMissing = "");

}  // namespace aa
