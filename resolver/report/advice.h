// Which method for whom: what a budget of processor time and a set of inputs buy, from the figures of one run.
#pragma once
#include <string>
#include <vector>

#include "study/results.h"

namespace aa {

// A method that is nearer to the truth than the one named before it, the first than noaa: by as much as can be
// resolved, or by a decibel and more.
struct AdviceStep {
    size_t method = 0;
    double nsPerPixel = 0;
    // What it is not told apart from: noaa first, then the cheaper ones that help, the best of them first.
    std::vector<size_t> alike;
};
// Methods by what they ask of a renderer.
struct AdviceGroup {
    std::string needs;  // "From colour alone"
    std::vector<AdviceStep> steps;
};
// Groups that have a step; each holds the methods of the groups before it, too, and is left out where what it asks for
// more buys nothing. Empty without noaa, truth and times.
std::vector<AdviceGroup> adviceOf(const RunResults& run);
std::vector<std::string> adviceInWords(const RunResults& run);

}  // namespace aa
