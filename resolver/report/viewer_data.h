// What the report's viewer holds of a run: its pictures, packed (image/picture_codec.h), and where to look.
#pragma once
#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "image/picture_codec.h"
#include "report/gallery.h"

namespace aa {

enum class Embed {
    full,   // whole pictures
    crops,  // the windows where the methods differ most
    none,
};
struct EmbedOptions {
    Embed what = Embed::full;
    // Linear light as 32-bit floats instead of the 8-bit codes that are displayed: exposure shows what lies beyond
    // white.
    bool floats = false;
    size_t limitBytes = 38'000'000;  // of the page's pictures, so that all is below 40 MB; 0: no limit
};

// One picture. `source` is a method's index, or kTruth.
struct PackedPicture {
    static constexpr int kTruth = -1;
    int frame = 0, source = kTruth;
    bool alone = true;  // coded without another picture
    int fromFrame = 0, fromSource = kTruth;
    Guess guess = Guess::med;
    bool displayReferred = false;
    std::vector<unsigned char> bytes = {};
};
// One part of the picture over time.
struct PackedView {
    Window window;
    std::vector<int> frames;  // ascending
    std::vector<PackedPicture> pictures;
};
// Where the methods differ most in a frame.
struct TellingPlaces {
    int frame = 0;
    std::vector<Window> windows;
};
struct ViewerData {
    bool floats = false;
    std::vector<PackedView> views = {};      // empty: there is nothing to show
    std::vector<TellingPlaces> places = {};  // within the views
    std::vector<int> leftOut = {};           // frames that the limit kept out
    size_t textBytes() const;                // of the packed pictures in the page
};

// Frames are taken from the last backwards while the limit allows, and the last in any case; of pictures too large for
// it, the part where the methods differ most. Throws InputError as loadPictures().
ViewerData viewerData(const RunResults& run, const std::filesystem::path& folder, const EmbedOptions& options,
                      const Exec& exec);

// The index that the page reads, and the pictures themselves as elements of it.
nlohmann::ordered_json viewerJson(const ViewerData& data, const RunResults& run, const Exec& exec);
std::string viewerElements(const ViewerData& data);

// The least linear value displayed as code 1, 2, ... 255, found through encode() itself.
std::vector<float> codeThresholds(const DisplayChain& chain, const Exec& exec);

}  // namespace aa
