// Stability (study/stability.h) as a section of the report.
#pragma once
#include <filesystem>
#include <string>

namespace aa {

// What goes before </body> of the report: the data of FOLDER/stability.json and the script that draws them beside the
// price; empty when there is no such file. Throws InputError when it is damaged.
std::string stabilityForReport(const std::filesystem::path& folder);

}  // namespace aa
