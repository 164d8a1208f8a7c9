// What mirroring or turning an image by 90 degrees changes besides the place of the result's pixels, method by method.
// `aaresolve angles` measures how much of it shows on straight edges.
#pragma once
#include <string_view>

namespace aa {
// One sentence; empty for a method that treats all eight orientations alike, and for methods that read more than one
// image, whose sample patterns have a direction of their own.
std::string_view knownAsymmetry(std::string_view method);
}  // namespace aa
