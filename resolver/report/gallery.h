// The pictures of a run as they are shown: encoded images of one frame, the windows worth a closer look.
#pragma once
#include <filesystem>

#include "image/window.h"
#include "study/results.h"

namespace aa {

// One frame of all methods as the run compared them: displayed by its chain and rounded by its protocol.
struct Pictures {
    int frame = 0;
    Rgb truth;                          // or the reference method's image; empty when this frame has none
    std::vector<Rgb> methods;           // as RunResults::methods
    std::optional<Window> region = {};  // that the figures are of; otherwise of the whole picture
};

// Frames of which every method has an image on disk, ascending.
std::vector<int> framesWithPictures(const RunResults& run);
// What has a run write those that it lacks: "run again with --write-frames all".
std::string howToWriteAll(const RunResults& run);
// Throws InputError: no such frame, a file missing, damaged or of another size.
Pictures loadPictures(const RunResults& run, const std::filesystem::path& folder, int frame, const Exec& exec);

// The same frame as its files hold it: linear light, before the display.
struct LinearPicture {
    Rgb linear;
    bool displayReferred = false;  // needs the display's transfer alone (image/io.h)
};
struct LinearPictures {
    std::optional<LinearPicture> truth;
    std::vector<LinearPicture> methods;
};
// Throws InputError as above, and where a file holds 8-bit codes only.
LinearPictures loadLinearPictures(const RunResults& run, const std::filesystem::path& folder, int frame);

// Up to `count` windows that do not overlap, in which the methods differ most: greatest spread between methods of the
// root mean squared error against the truth; without truth, of the colours themselves; of a single method, its error.
// After the first, those count less that lie near a chosen one or are like it: the same methods are good there, edges
// run the same way. Only in the region, where there is one. Windows without any difference are left out; left to right,
// then top to bottom.
std::vector<Window> mostTellingWindows(const Pictures& pictures, int width, int height, int count);
// The crops of contact sheet and report.
inline constexpr int kTellingCrops = 3, kTellingCropPx = 48;
std::vector<Window> tellingCrops(const Pictures& pictures, int count = kTellingCrops);

}  // namespace aa
