#include "metrics/maps.h"

#include <algorithm>
#include <cmath>

#include "image/colour_map.h"
#include "image/error.h"
#include "metrics/cvvdp.h"
#include "metrics/flip.h"
#include "metrics/fourier.h"
#include "metrics/metrics.h"

namespace aa {
namespace {

// `place`: where a value lies between the scale's ends, 0 to 1.
template <class Place>
Rgb coloured(const PlaneF& map, Place place) {
    Rgb image(map.width(), map.height());
    for (int y = 0; y < map.height(); y++)
        for (int x = 0; x < map.width(); x++) {
            const Colour c = errorColour(place(double(map.at(x, y))));
            for (size_t k = 0; k < 3; k++) image.c[k].at(x, y) = c[k];
        }
    return image;
}

Rgb drawError(const Rgb& test, const Rgb& reference, const Exec&) { return colouredError(errorMap(test, reference)); }
// Grey, as the theses print it.
Rgb drawSsim(const Rgb& test, const Rgb& reference, const Exec& exec) {
    PlaneF map;
    ssimLuma(test, reference, exec, &map);
    for (int y = 0; y < map.height(); y++)
        for (int x = 0; x < map.width(); x++) map.at(x, y) = std::clamp(map.at(x, y), 0.0f, 1.0f);
    Rgb grey;
    grey.c = {map, map, map};
    return grey;
}
Rgb drawFlip(const Rgb& test, const Rgb& reference, const Exec& exec) {
    PlaneF map;
    flip(test, reference, exec, &map);
    return coloured(map, [](double v) { return v; });
}
// Four decades: from a fortieth of an 8-bit code to all of the range.
Rgb drawFourier(const Rgb& test, const Rgb& reference, const Exec& exec) {
    constexpr double kDecades = 4;
    return coloured(fourierDifference(test, reference, exec),
                    [](double v) { return v > 0 ? 1 + std::log10(v) / kDecades : 0.0; });
}
constexpr double kMostJod = 3;
Rgb colouredJod(const PlaneF& lost) {
    return coloured(lost, [](double v) { return v / kMostJod; });
}
Rgb drawCvvdp(const Rgb& test, const Rgb& reference, const Exec& exec) {
    PlaneF map;
    cvvdpOfStill(test, reference, displayModels().front(), exec, &map);
    return colouredJod(map);
}
}  // namespace

const std::vector<MapKind>& mapKinds() {
    static const std::vector<MapKind> kinds = {
        {"error", "error of encoded values, RMS over R, G, B: black 0, lightest 0.2 (51 of 255 codes) or more",
         drawError},
        {"ssim", "SSIM of luma: white 1, where both are alike, black 0 or less", drawSsim},
        {"flip", "FLIP at 67 pixels per degree: black 0, lightest 1", drawFlip},
        {"cvvdp", "JOD that ColorVideoVDP takes off around a pixel: black 0, lightest 3 or more", drawCvvdp, "cvvdp",
         colouredJod},
        {"fourier",
         "difference by frequency, 0 in the centre, |F_T - F_R| / sqrt(W H), RMS over R, G, B, logarithmic: black "
         "0.0001 "
         "or less, lightest 1 or more",
         drawFourier},
    };
    return kinds;
}
const MapKind& mapKindByName(std::string_view name) {
    std::string names;
    for (const MapKind& k : mapKinds()) {
        if (k.name == name) return k;
        names += (names.empty() ? "" : ", ") + std::string(k.name);
    }
    throw UsageError("unknown map '" + std::string(name) + "'; expected one of " + names);
}
std::string listOfMapKinds() {
    std::string all;
    for (const MapKind& k : mapKinds())
        all += "\n  " + std::string(k.name) + std::string(9 - k.name.size(), ' ') + std::string(k.scale);
    return all;
}

double squaredDifference(const Rgb& a, const Rgb& b, int x, int y) {
    double sum = 0;
    for (size_t c = 0; c < 3; c++) sum += std::pow(double(a.c[c].at(x, y)) - double(b.c[c].at(x, y)), 2);
    return sum / 3;
}
PlaneF errorMap(const Rgb& test, const Rgb& reference) {
    PlaneF map(test.width(), test.height());
    for (int y = 0; y < map.height(); y++)
        for (int x = 0; x < map.width(); x++) map.at(x, y) = float(std::sqrt(squaredDifference(test, reference, x, y)));
    map.fillBorder();
    return map;
}
Rgb colouredError(const PlaneF& error) {
    return coloured(error, [](double v) { return v / kErrorScale; });
}

}  // namespace aa
