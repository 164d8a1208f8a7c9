#include "image/colour_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace aa {
namespace {
double encoded(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}
bool inGamut(const std::array<double, 3>& c) {
    return std::all_of(c.begin(), c.end(), [](double v) { return v >= 0 && v <= 1; });
}
Colour computed(double t) {
    const double lightness = 0.10 + 0.87 * t;                     // near black to near white
    const double hue = (285 + 185 * t) * std::numbers::pi / 180;  // violet, magenta, red, orange, yellow
    // The largest chroma that sRGB shows at this lightness and hue, by bisection, a little inside the border.
    double low = 0, high = 0.4;
    for (int i = 0; i < 40; i++) {
        const double chroma = (low + high) / 2;
        (inGamut(encodedFromOkLab(lightness, chroma * std::cos(hue), chroma * std::sin(hue))) ? low : high) = chroma;
    }
    const double chroma = std::min(0.95 * low, 0.2);
    const auto c = encodedFromOkLab(lightness, chroma * std::cos(hue), chroma * std::sin(hue));
    return {float(c[0]), float(c[1]), float(c[2])};
}
}  // namespace

std::array<double, 3> encodedFromOkLab(double lightness, double a, double b) {
    const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
    const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
    const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
    return {encoded(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
            encoded(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
            encoded(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s)};
}

Colour errorColour(double t) {
    constexpr int kSteps = 512;
    static const auto table = [] {
        std::vector<Colour> colours;
        for (int i = 0; i <= kSteps; i++) colours.push_back(computed(double(i) / kSteps));
        return colours;
    }();
    return table[t > 0 ? size_t(std::min(t, 1.0) * kSteps + 0.5) : 0];
}

}  // namespace aa
