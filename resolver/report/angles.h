// The half-plane study (study/angle_study.h) as files and as a section of the report.
#pragma once
#include <filesystem>
#include <string>

#include "study/angle_study.h"

namespace aa {

// angles.json: {"format": "aaresolve-angles", "version": 1, "degrees": [...], "noaaPsnr": [...], "methods": [{"text",
// "title", "family", "subsamples", "psnr": [...], "gainDb": [...], "pooledGainDb", "mirrorDb", "turnDb"}]}.
std::string toJsonText(const AngleStudy& study);
std::string toCsvText(const AngleStudy& study);  // one line per angle, one gain per method
std::string toSvgText(const AngleStudy& study);  // gain against angle, one line per method

// What goes before </body> of the report: the data of FOLDER/angles.json and the script that draws them; empty when
// there is no such file. Throws InputError when it is damaged.
std::string anglesForReport(const std::filesystem::path& folder);

}  // namespace aa
