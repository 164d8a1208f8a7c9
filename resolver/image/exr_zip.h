// OpenEXR's compressions ZIP and ZIPS: 16 lines of a part, or one, packed by themselves (openexr.com, "OpenEXR
// File Layout").
//
// Of a chunk's bytes those at even places come first and those at odd places after them, so that like stands beside
// like; each but the first is stored as its difference from the one before, plus 128; the whole is deflated, in zlib's
// format. A chunk that this would not make smaller is stored as it is.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "image/io.h"

struct libdeflate_decompressor;

namespace aa {

inline constexpr int kZipLines = 16;
// Bytes: 32 planes of the largest side. A larger one is stored as it is.
inline constexpr size_t kLargestChunk = size_t(kZipLines) * kLargestSide * 32 * sizeof(float);

// One per thread.
class ZipPacker {
  public:
    ZipPacker();
    ~ZipPacker();
    // An even number of bytes as they are stored in the file; valid until the next call.
    std::span<const uint8_t> pack(std::span<const uint8_t> chunk);

  private:
    struct Streams;
    std::unique_ptr<Streams> streams_;
    std::vector<uint8_t> sorted_, packed_, working_;
};

// One per thread.
class ZipUnpacker {
  public:
    ZipUnpacker();
    ~ZipUnpacker();
    ZipUnpacker(const ZipUnpacker&) = delete;
    ZipUnpacker& operator=(const ZipUnpacker&) = delete;
    // A chunk that holds `bytes`, an even number. False where it is damaged. `packed` is read until the next call.
    bool unpack(std::span<const uint8_t> packed, size_t bytes);
    // So many of them, from an even place on.
    void copy(size_t from, size_t bytes, void* to) const;

  private:
    libdeflate_decompressor* decompressor_;
    std::vector<uint8_t> sorted_;
    std::span<const uint8_t> plain_;  // of a chunk that is stored as it is
    size_t half_ = 0;
};

}  // namespace aa
