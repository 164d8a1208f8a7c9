// One page for several runs: methods over scenes, and runs of one shot against each other. It needs no network.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "study/summary.h"

namespace aa {

// `page`: where it will lie; it links to the reports that lie beside the results. Empty: no links.
std::string summaryHtml(const std::vector<NamedRun>& runs, const std::filesystem::path& page = {});
std::vector<std::string> summaryInWords(const std::vector<NamedRun>& runs, const Summary& summary,
                                        const std::vector<RunAgainstRun>& against);

}  // namespace aa
