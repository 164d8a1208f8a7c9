#include "image/palette.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace aa {
namespace {
TEST(Palette, FewColoursAreExact) {
    std::vector<std::vector<unsigned char>> pictures(2);
    for (int i = 0; i < 256; i++)
        for (const int v : {i, 255 - i, i / 2}) pictures[i % 2].push_back(static_cast<unsigned char>(v));
    const Paletted p = paletted(pictures);
    EXPECT_EQ(p.palette.size(), 256u * 3);
    for (size_t f = 0; f < 2; f++)
        for (size_t i = 0; i < pictures[f].size(); i++)
            EXPECT_EQ(p.palette[size_t(p.frames[f][i / 3]) * 3 + i % 3], pictures[f][i]);
}
TEST(Palette, ManyColoursComeNearAndTheCommonOnesStay) {
    std::vector<unsigned char> picture;
    for (int i = 0; i < 20000; i++)
        for (const int v : {i * 7, i * 13, i * 29}) picture.push_back(static_cast<unsigned char>(v / 16));
    for (int i = 0; i < 60000; i++) picture.insert(picture.end(), {27, 27, 28});
    const std::vector<std::vector<unsigned char>> one(1, picture);
    const Paletted p = paletted(one);
    EXPECT_LE(p.palette.size(), 256u * 3);
    double error = 0;
    for (size_t i = 0; i < picture.size(); i++)
        error += std::abs(int(p.palette[size_t(p.frames[0][i / 3]) * 3 + i % 3]) - int(picture[i]));
    EXPECT_LT(error / double(picture.size()), 8);
    const unsigned char ground = p.frames[0].back();
    EXPECT_NEAR(p.palette[size_t(ground) * 3], 27, 1);
}
}  // namespace
}  // namespace aa
