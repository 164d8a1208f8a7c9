#include "image/exr_zip.h"

#include <isa-l/igzip_lib.h>
#include <libdeflate.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <memory>
#include <new>

namespace aa {
namespace {
static_assert(std::endian::native == std::endian::little, "EXR files are little-endian, and so are the sums below");

constexpr uint32_t kLevel = 1, kWorkingBytes = ISAL_DEF_LVL1_DEFAULT;  // decisions 56

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
using SixteenBytes = uint8_t __attribute__((vector_size(16)));

// `v`, its bytes that many places further on, behind zeros.
template <int kPlaces>
SixteenBytes moved(SixteenBytes v) {
    constexpr auto from = [](int to) { return to < kPlaces ? 0 : 16 + to - kPlaces; };
    return __builtin_shufflevector(SixteenBytes{}, v, from(0), from(1), from(2), from(3), from(4), from(5), from(6),
                                   from(7), from(8), from(9), from(10), from(11), from(12), from(13), from(14),
                                   from(15));
}
SixteenBytes lastEverywhere(SixteenBytes v) {
    return __builtin_shufflevector(v, v, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15);
}

// The sums of differences, 16 bytes at a time: each adds what stands one, two, four and eight places before, then the
// sum of all bytes before them.
void fromDifferences(uint8_t* bytes, size_t count) {
    bytes[0] ^= 128;  // the first is no difference
    SixteenBytes before{};
    size_t i = 0;
    for (; i + 16 <= count; i += 16) {
        SixteenBytes sums;
        std::memcpy(&sums, bytes + i, 16);
        sums ^= 128;
        sums += moved<1>(sums);
        sums += moved<2>(sums);
        sums += moved<4>(sums);
        sums += moved<8>(sums);
        const SixteenBytes all = sums + before;
        before += lastEverywhere(sums);
        std::memcpy(bytes + i, &all, 16);
    }
    uint8_t sum = before[0];
    for (; i < count; i++) bytes[i] = sum = uint8_t(sum + (bytes[i] ^ 128u));
}
}  // namespace

// ISA-L's packing depends on where its stream lies in memory. On x86-64 it begins by noting the third place of the
// input under a hash of the stream's address, bits 16 to 47, where the hash of the four bytes there is meant (2.30
// to 2.32, igzip_icf_body_h1_gr_bt.asm, .write_first_byte). Under that hash the first, which is also what stands where
// nothing is noted, or the second may have been meant to be found; and as distances are taken modulo 32768, so are the
// places 32768, 65536 ... behind the first and the third. One picture in twenty thousand came out otherwise from run to
// run. So a chunk takes a stream whose address has the hash of none of these places, of which the largest chunk has
// half as many as there are hashes.
struct ZipPacker::Streams {
    // Their memory is left as it is: of 82 kB each, ISA-L uses the first hundreds of bytes at this level.
    std::vector<std::unique_ptr<isal_zstream>> all;

    isal_zstream& of([[maybe_unused]] std::span<const uint8_t> plain) {
#ifdef __x86_64__
        const size_t run = runAtTheBegin(plain);
#endif
        for (size_t i = 0;; i++) {
            if (i == all.size()) all.emplace_back(new isal_zstream);
#ifdef __x86_64__
            const uint32_t own = hash(uint32_t(reinterpret_cast<uintptr_t>(all[i].get()) >> 16));
            if (isFoundBy(own, plain, 0) || (run > 0 && isFoundBy(own, plain, run))) continue;
#endif
            return *all[i];
        }
    }

#ifdef __x86_64__
  private:
    __attribute__((target("sse4.2"))) static uint32_t hash(uint32_t v) { return __builtin_ia32_crc32si(0, v); }
    // A long run of zeros or ones is packed apart, and all begins behind it.
    static size_t runAtTheBegin(std::span<const uint8_t> plain) {
        if (plain[0] != 0 && plain[0] != 255) return 0;
        return size_t(std::find_if(plain.begin(), plain.end(), [&](uint8_t b) { return b != plain[0]; }) -
                      plain.begin());
    }
    static bool isFoundBy(uint32_t own, std::span<const uint8_t> plain, size_t begin) {
        const size_t table = std::min(2 * std::bit_floor(plain.size()), size_t(IGZIP_LVL1_HASH_SIZE));
        const auto isIt = [&](size_t place) {
            if (place + 4 > plain.size()) return false;
            uint32_t four;
            std::memcpy(&four, plain.data() + place, 4);
            return (hash(four) ^ own) % table == 0;
        };
        if (isIt(begin + 1)) return true;
        for (size_t place = begin; place < plain.size(); place += 32768)
            if (isIt(place) || isIt(place + 2)) return true;
        return false;
    }
#endif
};

namespace {
// In zlib's format; 0 where it does not fit.
size_t deflate(std::span<const uint8_t> plain, std::span<uint8_t> packed, std::vector<uint8_t>& working,
               isal_zstream& stream) {
    working.resize(kWorkingBytes);
    isal_deflate_stateless_init(&stream);
    stream.hist_bits = 0;  // 2.30 leaves it as the memory was, and from 1 to 14 it is a shorter window
    stream.level = kLevel, stream.level_buf = working.data(), stream.level_buf_size = kWorkingBytes;
    stream.gzip_flag = IGZIP_ZLIB;
    stream.end_of_stream = 1;
    stream.next_in = const_cast<uint8_t*>(plain.data()), stream.avail_in = uint32_t(plain.size());
    stream.next_out = packed.data(), stream.avail_out = uint32_t(packed.size());
    return isal_deflate_stateless(&stream) == COMP_OK ? stream.total_out : 0;
}
}  // namespace

ZipPacker::ZipPacker() : streams_(new Streams) {}
ZipPacker::~ZipPacker() = default;

std::span<const uint8_t> ZipPacker::pack(std::span<const uint8_t> chunk) {
    assert(chunk.size() % 2 == 0 && !chunk.empty());
    if (chunk.size() > kLargestChunk) return chunk;
    const size_t bytes = chunk.size(), half = bytes / 2;
    sorted_.resize(2 * bytes);
    packed_.resize(bytes);
    uint8_t *const sorted = sorted_.data(), *const differences = sorted + bytes;
    sortBytes(chunk.data(), half, sorted, sorted + half);
    toDifferences(sorted, bytes, differences);
    // What does not fit is as good as too large.
    const size_t packed =
        deflate({differences, bytes}, {packed_.data(), bytes - 1}, working_, streams_->of({differences, bytes}));
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
