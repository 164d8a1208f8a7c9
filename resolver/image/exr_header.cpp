#include "image/exr_header.h"

#include <cstdint>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>

namespace aa {
namespace fs = std::filesystem;

namespace {
constexpr uint32_t kMultiPart = 0x1000;  // flag of the version field: several headers, an empty one ends them
constexpr size_t kLongestName = 255;

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
            if (!header.holds(*size) || (*type == "stringvector" && !header.holdsTexts(*size)))
                throw std::runtime_error("its attribute '" + *name + "' is said to be larger than the file");
            if (*type != "stringvector") header.skip(*size);
        }
        if (!(*version & kMultiPart)) return;
    }
}

}  // namespace aa
