#include "image/exr_header.h"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace aa {
namespace fs = std::filesystem;

namespace {
constexpr uint32_t kMultiPart = 0x1000;  // flag of the version field: several headers, an empty one ends them
constexpr size_t kLongestName = 255;
// OpenEXR reads these by their type and goes on behind what it has read, whatever size is stated.
constexpr std::pair<std::string_view, uint32_t> kSizes[] = {
    {"box2f", 16},
    {"box2i", 16},
    {"chromaticities", 32},
    {"compression", 1},
    {"deepImageState", 1},
    {"double", 8},
    {"envmap", 1},
    {"float", 4},
    {"int", 4},
    {"keycode", 28},
    {"lineOrder", 1},
    {"m33d", 72},
    {"m33f", 36},
    {"m44d", 128},
    {"m44f", 64},
    {"rational", 8},
    {"tiledesc", 9},
    {"timecode", 8},
    {"v2d", 16},
    {"v2f", 8},
    {"v2i", 8},
    {"v3d", 24},
    {"v3f", 12},
    {"v3i", 12},
};

class Header {
  public:
    Header(std::istream& in, uint64_t bytes) : in_(in), left_(bytes) {}

    std::optional<uint32_t> number() {
        unsigned char b[4];
        if (!in_.read(reinterpret_cast<char*>(b), sizeof b)) return std::nullopt;
        left_ -= sizeof b;
        return uint32_t(b[0]) | uint32_t(b[1]) << 8 | uint32_t(b[2]) << 16 | uint32_t(b[3]) << 24;
    }
    std::optional<std::string> name() {
        std::string text;
        for (char c; in_.get(c);) {
            left_--;
            if (c == 0) return text;
            if (text.size() == kLongestName) break;
            text += c;
        }
        return std::nullopt;
    }
    bool holds(uint32_t bytes) const { return bytes <= left_; }
    // What is read as texts, each with its length in front.
    bool holdsTexts(uint32_t bytes) {
        while (bytes >= 4) {
            const auto length = number();
            if (!length || *length > (bytes -= 4)) return false;
            skip(*length), bytes -= *length;
        }
        skip(bytes);
        return true;
    }
    // Names, each with 16 bytes behind it, up to an empty one that is the last byte.
    bool isOfChannels(uint32_t bytes) {
        for (;;) {
            const uint64_t before = left_;
            const auto channel = name();
            const uint64_t taken = before - left_;
            if (!channel || taken > bytes) return false;
            bytes -= uint32_t(taken);
            if (channel->empty()) return bytes == 0;
            if (bytes < 16) return false;
            skip(16), bytes -= 16;
        }
    }
    // Width, height, and four bytes for each pixel.
    bool isOfPreview(uint32_t bytes) {
        const auto width = number(), height = bytes >= 8 && width ? number() : std::nullopt;
        if (!height || (bytes - 8) % 4 || uint64_t(*width) * *height != (bytes - 8) / 4) return false;
        skip(bytes - 8);
        return true;
    }
    void skip(uint32_t bytes) {
        in_.seekg(std::streamoff(bytes), std::ios::cur);
        left_ -= bytes;
    }

  private:
    std::istream& in_;
    uint64_t left_;
};
}  // namespace

void checkAttributeSizes(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    Header header(in, fs::file_size(file));
    const auto magic = header.number(), version = header.number();
    if (!magic || !version) return;
    for (bool first = true;; first = false) {
        auto name = header.name();
        if (!name || (name->empty() && !first)) return;
        for (; name && !name->empty(); name = header.name()) {
            const auto type = header.name();
            const auto size = type ? header.number() : std::nullopt;
            if (!size) return;
            const std::string what = "its attribute '" + *name + "'";
            if (!header.holds(*size)) throw std::runtime_error(what + " is said to be larger than the file");
            const auto known =
                std::find_if(std::begin(kSizes), std::end(kSizes), [&](const auto& k) { return k.first == *type; });
            if (known != std::end(kSizes) && known->second != *size)
                throw std::runtime_error(what + " has " + std::to_string(*size) + " bytes, where " + *type + " has " +
                                         std::to_string(known->second));
            if (*type == "stringvector" ? !header.holdsTexts(*size)
                : *type == "chlist"     ? !header.isOfChannels(*size)
                : *type == "preview"    ? !header.isOfPreview(*size)
                                        : (header.skip(*size), false))
                throw std::runtime_error(what + " holds other than its size says");
        }
        if (!(*version & kMultiPart)) return;
    }
}

}  // namespace aa
