// OpenEXR files, part by part and channel by channel: what images, shots and imports share.
//
// Pixels go straight between the file and planes, so that a part of 40 channels needs no second copy of itself. ZIP,
// which is all that we write, is unpacked and packed by image/exr_zip.h on all threads that the program may use (-j);
// what else others write OpenEXR unpacks, in as many threads of its own. Types are converted only without loss: half ->
// float; uint stays uint; an id stored as float must be a whole number.
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "image/plane.h"
#include "image/window.h"

namespace aa {

enum class ChannelType { half, real, uint, other };
std::string_view name(ChannelType type);

struct ExrChannel {
    std::string name;
    ChannelType type = ChannelType::real;
    bool subsampled = false;  // one value for several pixels, as chroma has
};
struct ExrPart {
    std::string name;
    int width = 0, height = 0;
    std::vector<ExrChannel> channels;  // image/channel_order.h
    std::string compression;           // "zip", "dwaa", ...
    std::string storage;               // "scanlineimage", "tiledimage", "deepscanline", "deeptile"
    bool deep = false;                 // several values per pixel
    Window shown;                      // the display window, in pixels from the first one stored
    bool cropped() const { return !(shown == Window{0, 0, width, height}); }  // a region, overscan
    std::map<std::string, std::string> texts;                                 // attributes that are texts
    std::map<std::string, int> integers;                                      // and whole numbers
    const ExrChannel* find(std::string_view channel) const;
};

using PlaneRef = std::variant<PlaneF*, PlaneU*>;

// Where a channel of a part goes. The target is allocated by the read.
struct ChannelTarget {
    std::string channel;
    PlaneRef plane;
    ChannelType stored = ChannelType::real;  // set by the read
};

bool isExr(const std::filesystem::path& file);  // by its first bytes

// Where every pixel must be there and no other, as in a shot: throws InputError for a region, overscan, or a data
// window that is cut to its content. `where` begins the line, `advice` ends it.
void requireWhole(const ExrPart& part, const std::string& where, const std::string& advice);

// An EXR file opened for reading. Not thread-safe; open one per thread. Errors are InputErrors of one line.
class ExrFile {
  public:
    // `advice` ends the errors. Throws: missing, not an EXR, damaged header.
    explicit ExrFile(const std::filesystem::path& file, std::string advice = "export the frame again");
    ~ExrFile();
    ExrFile(ExrFile&&) noexcept;
    ExrFile& operator=(ExrFile&&) noexcept;

    const std::filesystem::path& path() const { return path_; }
    const std::vector<ExrPart>& parts() const { return parts_; }
    const ExrPart* find(std::string_view part) const;
    // Each channel once. Throws InputError: channel missing, wrong type, truncated or damaged pixels.
    void read(const ExrPart& part, std::vector<ChannelTarget>& targets);

  private:
    struct Input;
    struct Slices;
    // False where OpenEXR's reader must: other compressions, and to say what is wrong.
    bool readLines(int part, const Slices& slices);
    void readByOpenExr(int part, const Slices& slices, const std::string& where);
    std::filesystem::path path_;
    std::string advice_;
    std::unique_ptr<Input> input_;
    std::vector<ExrPart> parts_;
};

// A part to be written: float or uint planes of one size. Parts may differ in size.
struct ChannelSource {
    std::string channel;
    std::variant<const PlaneF*, const PlaneU*> plane;
};
struct PartSource {
    std::string name;  // may be empty in a file of one part
    std::vector<ChannelSource> channels;
    std::map<std::string, int> integers = {};  // attributes
    std::optional<Window> shown = {};  // the display window, in pixels from the first; none: all of the first part
};
// ZIP, float and uint, through a temporary name. Throws InputError when it cannot (disk full, permissions).
void writeParts(const std::filesystem::path& file, const std::vector<PartSource>& parts);

}  // namespace aa
