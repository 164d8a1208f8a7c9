#include "metrics/display_model.h"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "image/error.h"

namespace aa {
namespace {
constexpr double kReflectivity = 0.005;  // of the screen [Mantiuk 2024]
constexpr double kMetresPerInch = 0.0254;
}  // namespace

double DisplayModel::pixelsPerDegree() const {
    const double diagonalPx = std::hypot(double(widthPx), double(heightPx));
    const double distancePx = fieldOfViewDegrees > 0
                                  ? diagonalPx / (2 * std::tan(fieldOfViewDegrees / 2 * std::numbers::pi / 180))
                                  : distanceM / (diagonalInches * kMetresPerInch / diagonalPx);
    return 1 / (2 * std::atan(0.5 / distancePx) * 180 / std::numbers::pi);
}
double DisplayModel::reflected() const { return ambientLux / std::numbers::pi * kReflectivity; }

const std::vector<DisplayModel>& displayModels() {
    static const std::vector<DisplayModel> all = {
        {"standard_4k", "30-inch 4K monitor, office light, seen from twice its height", 3840, 2160, 30, 0.7472, 0, 200,
         0.2, 250},
        {"standard_fhd", "24-inch Full HD monitor, office light, seen from twice its height", 1920, 1080, 24, 0.6, 0,
         200, 0.2, 250},
        {"standard_phone", "6-inch phone, office light, seen from 0.4 m", 2400, 1080, 6, 0.4, 0, 500, 0.05, 250},
        {"standard_hmd", "headset with a field of view of 110 degrees", 1440, 1600, 0, 0, 110, 100, 0.1, 0},
        {"sdr_4k_30", "30-inch 4K monitor of 100 cd/m2, office light, seen from 0.6 m", 3840, 2160, 30, 0.6, 0, 100,
         0.1, 250},
        {"sdr_fhd_24", "24-inch Full HD monitor of 100 cd/m2, office light, seen from 0.6 m", 1920, 1080, 24, 0.6, 0,
         100, 0.1, 250},
        {"standard_hdr_linear", "30-inch 4K HDR monitor, low light, seen from twice its height", 3840, 2160, 30, 0.7472,
         0, 1500, 0.0015, 10, true},
        {"standard_hdr_linear_dark", "30-inch 4K HDR monitor, dark room, seen from twice its height", 3840, 2160, 30,
         0.7472, 0, 1500, 0.0015, 0, true},
    };
    return all;
}
const DisplayModel& displayModelByName(std::string_view name) {
    std::vector<std::string_view> names;
    std::string list;
    for (const DisplayModel& d : displayModels()) {
        if (d.name == name) return d;
        names.push_back(d.name);
        list += (list.empty() ? "" : ", ") + std::string(d.name);
    }
    const std::string near = suggestion(name, names);
    throw UsageError("unknown display '" + std::string(name) + "'" +
                     (near.empty() ? "" : "; did you mean '" + near + "'?") + "; expected one of " + list);
}
std::string listOfDisplayModels() {
    size_t width = 0;
    for (const DisplayModel& d : displayModels()) width = std::max(width, d.name.size());
    std::string all;
    for (const DisplayModel& d : displayModels())
        all += "\n  " + std::string(d.name) + std::string(width + 2 - d.name.size(), ' ') + std::string(d.title);
    return all;
}
std::string inWords(const DisplayModel& d) {
    char text[200];
    std::snprintf(text, sizeof text, "%.1f pixels per degree, peak %g, black %g, reflected %.3g cd/m2",
                  d.pixelsPerDegree(), d.peak, d.black, d.reflected());
    return std::string(d.name) + " (" + std::string(d.title) + "): " + text;
}

}  // namespace aa
