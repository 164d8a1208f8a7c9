// Displays and where their viewer sits: what turns pixel values into light in cd/m2, and pixels into degrees.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace aa {

struct DisplayModel {
    std::string_view name;
    std::string_view title;  // in words, with the viewing distance
    int widthPx = 0, heightPx = 0;
    double diagonalInches = 0, distanceM = 0;  // flat screens; both 0 where the field of view is given
    double fieldOfViewDegrees = 0;             // along the diagonal, of a headset
    double peak = 0, black = 0;                // of the screen alone, cd/m2
    double ambientLux = 0;
    // High dynamic range: it is fed linear light instead of sRGB codes and clips what it cannot show.
    bool isHdr = false;

    double pixelsPerDegree() const;  // at the centre
    double reflected() const;        // light of the room on the screen, cd/m2
};

// Linear light of 1 on a display of high dynamic range, cd/m2: white paper [ITU 2023].
inline constexpr double kHdrWhite = 203;

// The displays of [Mantiuk 2024] that take sRGB codes or linear light; the first is the default.
const std::vector<DisplayModel>& displayModels();
const DisplayModel& displayModelByName(std::string_view name);  // throws UsageError: unknown, with those that there are
std::string listOfDisplayModels();                              // for help: "\n  name  title"
// "standard_4k (30-inch 4K monitor ...): 75.4 pixels per degree, peak 200, black 0.2, reflected 0.398 cd/m2".
std::string inWords(const DisplayModel& display);

}  // namespace aa
