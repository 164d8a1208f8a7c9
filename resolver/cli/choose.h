// Methods as every command takes them: by name, by set, with commas (methods/choosing.h).
#pragma once
#include <filesystem>

#include "cli/command.h"
#include "methods/choosing.h"

namespace aa {

// "-m,--method" with its help; `what` begins it.
Option addMethodOption(Command& command, std::vector<std::string>& to, const std::string& what, bool withShot);
// What a command line names.
std::vector<MethodSpec> chosen(const std::vector<std::string>& texts);
// On a shot, which `runnable` asks; what it leaves out is said on stderr.
std::vector<MethodSpec> chosenFor(const std::filesystem::path& shot, const std::vector<std::string>& texts);

}  // namespace aa
