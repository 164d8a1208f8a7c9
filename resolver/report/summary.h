// One page for several runs: methods over scenes, and runs of one shot against each other. It needs no network.
#pragma once
#include <string>
#include <vector>

#include "study/summary.h"

namespace aa {

std::string summaryHtml(const std::vector<NamedRun>& runs);
std::vector<std::string> summaryInWords(const std::vector<NamedRun>& runs, const Summary& summary,
                                        const std::vector<RunAgainstRun>& against);

}  // namespace aa
