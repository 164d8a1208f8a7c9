#include "image/apng.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "image/io.h"
#include "image/png.h"

namespace aa {
namespace {
TEST(Apng, APlainReaderSeesTheFirstPicture) {
    std::vector<std::vector<unsigned char>> frames(3);
    for (size_t f = 0; f < 3; f++)
        for (size_t i = 0; i < 5 * 4 * 3; i++) frames[f].push_back(static_cast<unsigned char>(i * 3 + f * 50));
    const auto bytes = apngBytes(frames, 5, 4, 250);
    const auto file = std::filesystem::path(testing::TempDir()) / "aaresolve_loop.apng";
    writeBytes(file, bytes);
    EXPECT_EQ(codesOf(readPng(file).rgb), frames[0]);
    std::filesystem::remove(file);
    const std::string all(bytes.begin(), bytes.end());
    const auto count = [&](const char* name) {
        int n = 0;
        for (size_t at = all.find(name); at != std::string::npos; at = all.find(name, at + 1)) n++;
        return n;
    };
    EXPECT_EQ(count("acTL"), 1);
    EXPECT_EQ(count("fcTL"), 3);
    EXPECT_GE(count("fdAT"), 2);
    EXPECT_EQ(count("IEND"), 1);
}
}  // namespace
}  // namespace aa
