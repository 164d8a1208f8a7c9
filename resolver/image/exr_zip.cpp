#include "image/exr_zip.h"

#include <libdeflate.h>

#include <bit>
#include <cassert>
#include <cstring>
#include <new>

namespace aa {
namespace {
static_assert(std::endian::native == std::endian::little, "EXR files are little-endian, and so are the sums below");

constexpr int kLevel = 1;  // decisions 56: of levels 1 to 6 the one that pays

void sortBytes(const uint8_t* __restrict bytes, size_t half, uint8_t* __restrict even, uint8_t* __restrict odd) {
    for (size_t i = 0; i < half; i++) {
        even[i] = bytes[2 * i];
        odd[i] = bytes[2 * i + 1];
    }
}
void joinBytes(const uint8_t* __restrict even, const uint8_t* __restrict odd, size_t half, uint8_t* __restrict bytes) {
    for (size_t i = 0; i < half; i++) {
        bytes[2 * i] = even[i];
        bytes[2 * i + 1] = odd[i];
    }
}

void toDifferences(const uint8_t* __restrict bytes, size_t count, uint8_t* __restrict differences) {
    differences[0] = bytes[0];
    for (size_t i = 1; i < count; i++) differences[i] = uint8_t(bytes[i] - bytes[i - 1] + 128);
}
// The sums of differences, eight bytes at a time: those at even and at odd places each in lanes of 16 bits, where a
// multiplication adds up what stands before.
void fromDifferences(uint8_t* bytes, size_t count) {
    constexpr uint64_t kLow = 0x00ff00ff00ff00ff, kOnes = 0x0001000100010001, kOffset = 0x8080808080808080;
    bytes[0] ^= 128;  // the first is no difference
    uint64_t before = 0;
    size_t i = 0;
    for (; i + 8 <= count; i += 8) {
        uint64_t x;
        std::memcpy(&x, bytes + i, 8);
        x ^= kOffset;
        const uint64_t even = (x & kLow) * kOnes, odd = (x >> 8 & kLow) * kOnes, start = before * kOnes;
        before = (before + (even >> 48) + (odd >> 48)) & 0xff;
        const uint64_t atEven = even + (odd << 16) + start, atOdd = even + odd + start;
        x = (atEven & kLow) | (atOdd & kLow) << 8;
        std::memcpy(bytes + i, &x, 8);
    }
    for (; i < count; i++) bytes[i] = uint8_t(before += bytes[i] ^ 128u);
}
}  // namespace

ZipPacker::ZipPacker() : compressor_(libdeflate_alloc_compressor(kLevel)) {
    if (!compressor_) throw std::bad_alloc();
}
ZipPacker::~ZipPacker() { libdeflate_free_compressor(compressor_); }

std::span<const uint8_t> ZipPacker::pack(std::span<const uint8_t> chunk) {
    assert(chunk.size() % 2 == 0 && !chunk.empty());
    const size_t bytes = chunk.size(), half = bytes / 2;
    sorted_.resize(2 * bytes);
    packed_.resize(bytes);
    uint8_t *const sorted = sorted_.data(), *const differences = sorted + bytes;
    sortBytes(chunk.data(), half, sorted, sorted + half);
    toDifferences(sorted, bytes, differences);
    // Nothing where it does not fit, which is as good as too large.
    const size_t packed = libdeflate_zlib_compress(compressor_, differences, bytes, packed_.data(), bytes - 1);
    return packed == 0 ? chunk : std::span<const uint8_t>(packed_.data(), packed);
}

ZipUnpacker::ZipUnpacker() : decompressor_(libdeflate_alloc_decompressor()) {
    if (!decompressor_) throw std::bad_alloc();
}
ZipUnpacker::~ZipUnpacker() { libdeflate_free_decompressor(decompressor_); }

bool ZipUnpacker::unpack(std::span<const uint8_t> packed, size_t bytes) {
    assert(bytes % 2 == 0 && bytes > 0);
    half_ = bytes / 2;
    plain_ = {};
    if (packed.size() >= bytes) {
        plain_ = packed;
        return packed.size() == bytes;
    }
    sorted_.resize(bytes);
    // Fails also where it gives less than was asked for.
    if (libdeflate_zlib_decompress(decompressor_, packed.data(), packed.size(), sorted_.data(), bytes, nullptr) !=
        LIBDEFLATE_SUCCESS)
        return false;
    fromDifferences(sorted_.data(), bytes);
    return true;
}

void ZipUnpacker::copy(size_t from, size_t bytes, void* to) const {
    assert(from % 2 == 0 && bytes % 2 == 0 && from + bytes <= 2 * half_);
    if (!plain_.empty()) {
        std::memcpy(to, plain_.data() + from, bytes);
        return;
    }
    const uint8_t* const even = sorted_.data() + from / 2;
    joinBytes(even, even + half_, bytes / 2, static_cast<uint8_t*>(to));
}

}  // namespace aa
