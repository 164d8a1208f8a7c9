// Multi-part EXR through OpenImageIO, part by part and channel by channel: what reader, writer and import share.
//
// Reading goes in blocks of rows straight into planes, so that a part of 40 channels needs no second copy of itself.
// Types are converted only without loss: half -> float; uint stays uint; an id stored as float must be a whole number.
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "image/plane.h"

namespace aa {

enum class ChannelType { half, real, uint, other };
std::string_view name(ChannelType type);

struct ExrChannel {
    std::string name;
    ChannelType type = ChannelType::real;
};
struct ExrPart {
    std::string name;
    int width = 0, height = 0;
    std::vector<ExrChannel> channels;
    std::string compression;                   // "zip", "dwaa:45", ...
    bool cropped = false;                      // the pixels stored are not the picture: a border, overscan
    std::map<std::string, std::string> texts;  // attributes that are texts
    const ExrChannel* find(std::string_view channel) const;
};

// Where a channel of a part goes. The target is allocated by the read.
struct ChannelTarget {
    std::string channel;
    std::variant<PlaneF*, PlaneU*> plane;
    ChannelType stored = ChannelType::real;  // set by the read
};

// An EXR file opened for reading. Not thread-safe; open one per thread. Errors are InputErrors of one line.
class ExrFile {
  public:
    explicit ExrFile(const std::filesystem::path& file);  // missing, not an EXR, damaged header
    ~ExrFile();
    ExrFile(ExrFile&&) noexcept;
    ExrFile& operator=(ExrFile&&) noexcept;

    const std::filesystem::path& path() const { return path_; }
    const std::vector<ExrPart>& parts() const { return parts_; }
    const ExrPart* find(std::string_view part) const;
    // Throws InputError: channel missing, wrong type, truncated or damaged pixels.
    void read(const ExrPart& part, std::vector<ChannelTarget>& targets);

  private:
    struct Input;
    std::filesystem::path path_;
    std::unique_ptr<Input> input_;
    std::vector<ExrPart> parts_;
};

// A part to be written: float or uint planes of one size. Parts may differ in size.
struct ChannelSource {
    std::string channel;
    std::variant<const PlaneF*, const PlaneU*> plane;
};
struct PartSource {
    std::string name;
    std::vector<ChannelSource> channels;
};
// ZIP, float and uint, through a temporary name. Throws InputError when it cannot (disk full, permissions).
void writeParts(const std::filesystem::path& file, const std::vector<PartSource>& parts);

}  // namespace aa
