#include "image/picture_codec.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "image/png.h"

namespace aa {
namespace {

// A ramp with a bright block: flat, steep and edges.
Rgb scene(int width, int height) {
    Rgb image(width, height);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++)
                image.c[c].at(x, y) =
                    x > width / 2 && y > height / 2 ? 0.9f : float(x + y * int(c + 1)) / float(4 * width + 3 * height);
    return image;
}
Rgb noise(int width, int height, unsigned seed) {
    std::mt19937 random(seed);
    Rgb image(width, height);
    for (auto& plane : image.c)
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) plane.at(x, y) = float(random() >> 8) / float(1 << 24);
    return image;
}
// As a method differs from the picture that it smooths: along an edge.
Rgb smoothed(Rgb image) {
    for (auto& plane : image.c)
        for (int y = 0; y < image.height(); y++) plane.at(image.width() / 2, y) = 0.5f;
    return image;
}
void comesBack(const Words& picture, const Words* other) {
    for (const Guess guess : {Guess::zero, Guess::med}) {
        const auto bytes = packed(picture, other, guess);
        EXPECT_EQ(unpacked(bytes, picture.width, picture.height, picture.bits, other, guess).values, picture.values);
    }
}

TEST(PictureCodec, EveryPictureComesBack) {
    for (const auto& [w, h] : {std::pair(1, 1), {1, 7}, {7, 1}, {33, 21}}) {
        const Rgb a = scene(w, h), b = smoothed(a), c = noise(w, h, 3);
        for (const Rgb* picture : {&a, &b, &c})
            for (const Rgb* other : {&a, &b, &c}) {
                const Words codes = codeWords(*picture), otherCodes = codeWords(*other);
                comesBack(codes, &otherCodes);
                comesBack(codes, nullptr);
                const Words floats = floatWords(*picture), otherFloats = floatWords(*other);
                comesBack(floats, &otherFloats);
                comesBack(floats, nullptr);
            }
    }
}
TEST(PictureCodec, FloatsKeepTheirOrderAndEveryBit) {
    using Limits = std::numeric_limits<float>;
    const float ascending[] = {-Limits::infinity(), -3.5f, -Limits::denorm_min(), 0, Limits::denorm_min(), 1, 65504,
                               Limits::infinity()};
    Rgb image(8, 1);
    for (auto& plane : image.c)
        for (int x = 0; x < 8; x++) plane.at(x, 0) = ascending[x];
    const Words words = floatWords(image);
    for (size_t x = 1; x < 8; x++) EXPECT_LT(words.values[x - 1], words.values[x]);
    comesBack(words, nullptr);
    image.c[1].at(3, 0) = Limits::quiet_NaN();
    comesBack(floatWords(image), nullptr);
}
TEST(PictureCodec, WhatIsAlikeTakesLittle) {
    constexpr int kWidth = 200, kHeight = 120;
    const Rgb a = scene(kWidth, kHeight);
    const Words base = codeWords(a), edge = codeWords(smoothed(a));
    EXPECT_LT(packed(base, &base, Guess::zero).size(), 100u);
    const size_t png = pngBytes(codesOf(smoothed(a)), kWidth, kHeight, {.compressionLevel = 9}).size();
    EXPECT_LT(2 * packed(edge, &base, Guess::zero).size(), png);
    // The guess of the size orders what can be chosen as the sizes do.
    EXPECT_LT(packedSize(edge, &base, Guess::zero), packedSize(edge, nullptr, Guess::med));
    const Words grain = codeWords(noise(kWidth, kHeight, 1));
    EXPECT_LT(packedSize(base, nullptr, Guess::med), packedSize(base, &grain, Guess::zero));
    // Noise cannot be packed: three bytes per pixel and hardly more.
    EXPECT_LT(double(packed(grain, nullptr, Guess::zero).size()), 1.03 * 3 * kWidth * kHeight);
}

}  // namespace
}  // namespace aa
