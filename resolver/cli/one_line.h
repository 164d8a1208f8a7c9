// What a file says of itself, names of layers and objects above all, as the screen may show it.
#pragma once
#include <string>
#include <string_view>

namespace aa {

// On one line, and without what a terminal would obey: line ends are spaces, other control characters question marks.
std::string onOneLine(std::string_view text);

}  // namespace aa
