// What a sweep found: the best values and which cannot be told apart from them, in words, and as a page with curves of
// every figure against a parameter and heat maps over two.
#pragma once
#include <string>
#include <vector>

#include "study/sweep.h"

namespace aa {

// Per swept method: its best values, those that cannot be told apart from them, what the parameters decide at most, and
// a best value at the end of a range. Without truth one sentence that says so.
std::vector<std::string> sweepWords(const RunResults& run, const SweepOptions& options);
std::string sweepHtml(const RunResults& run, const SweepOptions& options);

}  // namespace aa
