// The colours of error maps: lightness rises evenly from near black to near white in OKLab [Ottosson 2020], hue turns
// from violet over red to yellow, chroma is what sRGB allows. So equal steps of error look equally large, also in grey.
#pragma once
#include <array>

namespace aa {

using Colour = std::array<float, 3>;  // encoded sRGB, [0,1]

// t in [0,1]; values outside and NaN take the nearest end (NaN the lowest).
Colour errorColour(double t);
// OKLab -> encoded sRGB without clipping: components may leave [0,1] (linear slope outside).
std::array<double, 3> encodedFromOkLab(double lightness, double a, double b);

}  // namespace aa
