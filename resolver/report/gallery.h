// The pictures of a run as they are shown: encoded images of one frame, the windows worth a closer look, error maps.
#pragma once
#include <filesystem>

#include "study/results.h"

namespace aa {

// One frame of all methods as the run compared them: displayed by its chain and rounded by its protocol.
struct Pictures {
    int frame = 0;
    Rgb truth;                 // empty when this frame has none
    std::vector<Rgb> methods;  // as RunResults::methods
};

// Frames of which every method has an image on disk, ascending.
std::vector<int> framesWithPictures(const RunResults& run);
// Throws InputError: no such frame, a file missing, damaged or of another size.
Pictures loadPictures(const RunResults& run, const std::filesystem::path& folder, int frame, const Exec& exec);

struct Window {
    int x = 0, y = 0, width = 0, height = 0;
    bool overlaps(const Window& o) const {
        return x < o.x + o.width && o.x < x + width && y < o.y + o.height && o.y < y + height;
    }
};
// Up to `count` windows that do not overlap, in which the methods differ most: greatest variance between methods of the
// root mean squared error against the truth; without truth, of the colours themselves; of a single method, its error.
// Windows without any difference are left out; left to right, then top to bottom.
std::vector<Window> mostTellingWindows(const Pictures& pictures, int width, int height, int count);

// Root mean square over the channels of (T - R), encoded units.
PlaneF errorMap(const Rgb& test, const Rgb& reference);
// The one scale of every error map: black at 0, lightest at this error or more (0.2 = 51 of 255 codes).
inline constexpr double kErrorScale = 0.2;
// An error map as a picture: errorColour() on that scale.
Rgb colouredError(const PlaneF& error);

}  // namespace aa
