// Figures as text, the same in sheet, report and terminal.
#pragma once
#include <string>
#include <vector>

#include "study/results.h"

namespace aa {

std::string significant(double v, int digits = 4);  // 4 significant digits; Inf and NaN by name
std::string shortNumber(double v);                  // 3 significant digits, no exponent for everyday sizes
std::string decibelNumber(double v);                // 38.78
std::string signedDecibelNumber(double v);          // +3.21
std::string decibels(double v);                     // 38.78 dB
// By what the figure is: decibels, similarity, or 4 significant digits.
std::string shown(const Figure& figure, double v);
const char* name(FigureForm form);
std::string similarity(double v);  // 6 decimals: three saturate (conventions 13.2)

// What was run, in one line: size, jitter and whether its block is centred, machine.
std::string runLine(const RunResults& run);
// "a, b and c"; of more than `most` the first ones "and 4 more".
std::string enumerated(std::vector<std::string> parts, size_t most = SIZE_MAX);
// The 95 % interval of a gain: "+0.12 to +0.34", "above +0.12" or "below +0.34" where it has one end, "no interval".
std::string intervalInWords(double lowDb, double highDb);
std::string intervalInWords(const Comparison& c);
// "(95 %: +0.12 to +0.34)", "(no interval)"
std::string intervalInBrackets(double lowDb, double highDb);
std::string intervalInBrackets(const Comparison& c);
// What was measured of the machine while methods were timed, where it was too busy for their times to be trusted.
std::string busyInWords(const RunResults& run);
// What is not measured since it would have taken too long, and how to ask for it.
std::string leftOutInWords(const RunResults& run);

}  // namespace aa
