#include "image/exr_zip.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>

#include "image/split_mix64.h"

namespace aa {
namespace {

// As the format's description says it, byte by byte, packed by the library that defines it.
std::vector<uint8_t> packedByZlib(const std::vector<uint8_t>& chunk) {
    std::vector<uint8_t> sorted;
    for (size_t start : {0, 1})
        for (size_t i = start; i < chunk.size(); i += 2) sorted.push_back(chunk[i]);
    std::vector<uint8_t> differences(sorted);
    for (size_t i = 1; i < sorted.size(); i++) differences[i] = uint8_t(sorted[i] - sorted[i - 1] + 128);
    uLongf size = compressBound(uLong(chunk.size()));
    std::vector<uint8_t> packed(size);
    EXPECT_EQ(compress(packed.data(), &size, differences.data(), uLong(differences.size())), Z_OK);
    packed.resize(size);
    return packed;
}
// Rows of slowly changing numbers, which packing makes smaller, or noise, which it does not.
std::vector<uint8_t> chunkOf(size_t bytes, bool noise) {
    SplitMix64 random(bytes);
    std::vector<uint8_t> chunk(bytes);
    for (size_t i = 0; i < bytes; i++) chunk[i] = uint8_t(noise ? random.next() >> 32 : i * i / 700 + i % 4 * 60);
    return chunk;
}
std::vector<uint8_t> whole(const ZipUnpacker& unpacker, size_t bytes) {
    std::vector<uint8_t> chunk(bytes);
    unpacker.copy(0, bytes, chunk.data());
    return chunk;
}

TEST(ExrZip, UnpacksWhatZlibPacked) {
    ZipUnpacker unpacker;
    for (const size_t bytes : {64, 66, 78, 200, 4096, 100'002}) {
        const auto chunk = chunkOf(bytes, false), packed = packedByZlib(chunk);
        ASSERT_LT(packed.size(), bytes);
        ASSERT_TRUE(unpacker.unpack(packed, bytes)) << bytes;
        EXPECT_EQ(whole(unpacker, bytes), chunk) << bytes;
        std::vector<uint8_t> part(20);
        unpacker.copy(bytes - 30, part.size(), part.data());
        EXPECT_TRUE(std::equal(part.begin(), part.end(), chunk.end() - 30)) << bytes;
    }
}

TEST(ExrZip, UnpacksWhatItPacked) {
    ZipPacker packer;
    ZipUnpacker unpacker;
    for (const bool noise : {false, true})
        for (const size_t bytes : {2, 4, 14, 16, 18, 1000, 65'536, 400'000}) {
            const auto chunk = chunkOf(bytes, noise);
            const auto packed = packer.pack(chunk);
            ASSERT_LE(packed.size(), bytes);
            EXPECT_EQ(packed.size() == bytes, noise || bytes < 100) << bytes;  // stored as it is
            ASSERT_TRUE(unpacker.unpack(packed, bytes));
            EXPECT_EQ(whole(unpacker, bytes), chunk) << bytes;
        }
}

TEST(ExrZip, WhatIsTooLargeIsStored) {
    ZipPacker packer;
    const std::vector<uint8_t> chunk(kLargestChunk + 2);
    EXPECT_EQ(packer.pack(chunk).size(), chunk.size());
    EXPECT_LT(packer.pack(std::span(chunk).first(kLargestChunk)).size(), kLargestChunk / 200);
}

// Files do not depend on where in memory the packer lies either. Chunks in which much is found again, by packers at
// other addresses: without the choice of a stream (exr_zip.cpp) one packing in 200 comes out otherwise.
TEST(ExrZip, AChunkIsPackedTheSameWhereverThePackerLies) {
    constexpr size_t kPackers = 64, kChunks = 1500;
    std::vector<std::unique_ptr<ZipPacker>> packers;
    SplitMix64 random(5);
    {
        // Memory that was used before; read as a window's bits, 10 is a short one.
        std::vector<std::vector<uint16_t>> used;
        std::vector<std::unique_ptr<char[]>> between;
        for (size_t i = 0; i < kPackers; i++) {
            packers.push_back(std::make_unique<ZipPacker>());
            used.emplace_back(50'000, uint16_t(10));
            between.push_back(std::unique_ptr<char[]>(new char[random.next() % 60'000 + 100]));
        }
        used.clear();
        for (const auto& packer : packers) packer->pack(std::vector<uint8_t>(1000));
    }
    const auto differences = [&](size_t bytes, size_t first) {
        std::vector<uint8_t> all(bytes);
        const uint64_t few = random.next() % 3 + 2;
        for (uint8_t& b : all) b = uint8_t(random.next() % few * 40 + 128);
        for (size_t i = 0; i < first; i++) all[i] = first % 2 ? 0 : 255;
        for (int repeats = 0; repeats < 4; repeats++)  // of the places that ISA-L may mistake
            for (size_t from : {first, first + 1, first + 2, first + 32768, first + 32770})
                if (from + 24 < bytes)
                    std::copy_n(all.begin() + ptrdiff_t(from), 12,
                                all.begin() + ptrdiff_t(from + 12 + random.next() % (bytes - from - 24)));
        return all;
    };
    // A chunk whose sorted differences are these.
    const auto chunkFrom = [](const std::vector<uint8_t>& all) {
        std::vector<uint8_t> sorted(all), chunk(all.size());
        for (size_t i = 1; i < all.size(); i++) sorted[i] = uint8_t(sorted[i - 1] + all[i] - 128);
        for (size_t i = 0; i < all.size() / 2; i++)
            chunk[2 * i] = sorted[i], chunk[2 * i + 1] = sorted[all.size() / 2 + i];
        return chunk;
    };
    for (size_t n = 0; n < kChunks; n++) {
        const size_t bytes = n % 50 == 0 ? 80'000 : 200 + random.next() % 400 * 2;
        const auto chunk = chunkFrom(differences(bytes, n % 100 == 0 ? 5001 + n % 200 : 0));
        const auto first = packers[0]->pack(chunk);
        ASSERT_LT(first.size(), bytes);
        for (const auto& packer : packers) {
            const auto packed = packer->pack(chunk);
            ASSERT_TRUE(std::equal(packed.begin(), packed.end(), first.begin(), first.end()))
                << "chunk " << n << " of " << bytes << " bytes";
        }
    }
}

// Files do not depend on which thread packed what before.
TEST(ExrZip, AChunkIsPackedAsIfItWereTheFirst) {
    ZipPacker packer;
    for (const bool noise : {false, true, false, true})
        for (const size_t bytes : {65'536, 1000, 400'000}) {
            auto chunk = chunkOf(bytes, false);
            const auto random = chunkOf(bytes, true);
            for (size_t i = 0; noise && i < bytes; i += 64) chunk[i] = random[i];  // it can still be packed
            ZipPacker other;
            const auto packed = packer.pack(chunk), first = other.pack(chunk);
            ASSERT_LT(packed.size(), bytes);
            EXPECT_TRUE(std::equal(packed.begin(), packed.end(), first.begin(), first.end())) << bytes << noise;
        }
}

TEST(ExrZip, ZlibUnpacksWhatItPacked) {
    ZipPacker packer;
    for (const size_t bytes : {200, 4096, 100'002, 3'000'000}) {
        const auto chunk = chunkOf(bytes, false);
        const auto packed = packer.pack(chunk);
        ASSERT_LT(packed.size(), bytes);
        std::vector<uint8_t> differences(bytes);
        uLongf size = uLongf(bytes);
        ASSERT_EQ(uncompress(differences.data(), &size, packed.data(), uLong(packed.size())), Z_OK);
        ASSERT_EQ(size, bytes);
        for (size_t i = 1; i < bytes; i++) differences[i] = uint8_t(differences[i] + differences[i - 1] - 128);
        for (size_t i = 0; i < bytes; i++) ASSERT_EQ(differences[i / 2 + (i % 2) * (bytes / 2)], chunk[i]) << i;
    }
}

TEST(ExrZip, DamagedChunksAreRefused) {
    ZipUnpacker unpacker;
    const auto chunk = chunkOf(4096, false), packed = packedByZlib(chunk);
    EXPECT_FALSE(unpacker.unpack(packed, 4098));  // too few bytes in it
    EXPECT_FALSE(unpacker.unpack(packed, 4094));  // too many
    EXPECT_FALSE(unpacker.unpack({packed.data(), packed.size() / 2}, 4096));
    EXPECT_FALSE(unpacker.unpack({}, 4096));
    EXPECT_FALSE(unpacker.unpack(chunk, 4094));  // stored as it is, and too long
    size_t refused = 0;
    for (size_t i = 2; i < packed.size(); i++) {
        auto damaged = packed;
        damaged[i] ^= 0x10;
        if (!unpacker.unpack(damaged, 4096)) {
            refused++;
            continue;
        }
        EXPECT_EQ(whole(unpacker, 4096), chunk) << i;  // a bit that means nothing
    }
    EXPECT_GE(refused + 10, packed.size());
}

}  // namespace
}  // namespace aa
