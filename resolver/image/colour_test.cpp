#include "image/colour.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace aa {
namespace {
double srgbEncode(double c) { return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055; }
double srgbDecode(double e) { return e <= 0.04045 ? e / 12.92 : std::pow((e + 0.055) / 1.055, 2.4); }

TEST(Colour, SrgbAgreesWithPowInDouble) {
    Rgb linear(1000, 3), encoded, back;
    for (int y = 0; y < 3; y++)
        for (int x = 0; x < 1000; x++)
            for (auto& p : linear.c) p.at(x, y) = float(std::pow(10.0, -6.0 + 6.0 * x / 999.0) * (y == 2 ? 0 : 1));
    for (const auto precision : {Precision::fast, Precision::scalar, Precision::oracle}) {
        Exec exec;
        exec.precision = precision;
        encode(linear, {}, exec, encoded);
        decode(encoded, {}, exec, back);
        for (int x = 0; x < 1000; x++) {
            const double c = linear.c[0].at(x, 0);
            EXPECT_NEAR(encoded.c[0].at(x, 0), srgbEncode(c), 3e-7) << c;
            EXPECT_NEAR(back.c[0].at(x, 0), srgbDecode(encoded.c[0].at(x, 0)), 3e-7) << c;
        }
    }
}

TEST(Colour, ExtremesStayInRange) {
    const float values[] = {-1, 0, 1, 1e6f, 1e30f, INFINITY, -INFINITY, NAN, 1e-40f};
    Rgb linear(9, 1), encoded;
    for (int x = 0; x < 9; x++)
        for (auto& p : linear.c) p.at(x, 0) = values[x];
    for (const auto map : {ToneMap::none, ToneMap::reinhard, ToneMap::aces}) {
        encode(linear, {2.0f, map}, {}, encoded);
        for (int x = 0; x < 9; x++) {
            EXPECT_GE(encoded.c[0].at(x, 0), 0.0f) << values[x];
            EXPECT_LE(encoded.c[0].at(x, 0), 1.0f) << values[x];
        }
        EXPECT_EQ(encoded.c[0].at(7, 0), 0.0f);
    }
}

TEST(Colour, IdentityTransferIsExactAndItsOwnInverse) {
    Rgb linear(257, 3), shown, back;
    for (int y = 0; y < 3; y++)
        for (int x = 0; x < 257; x++)
            for (size_t c = 0; c < 3; c++) linear.c[c].at(x, y) = float(x) / 200.0f - 0.1f + 0.01f * float(c);
    linear.c[0].at(0, 0) = NAN;
    const DisplayChain identity{.transfer = Transfer::identity};
    for (const auto precision : {Precision::fast, Precision::scalar, Precision::oracle}) {
        Exec exec;
        exec.precision = precision;
        encode(linear, identity, exec, shown);
        decode(shown, identity, exec, back);
        EXPECT_TRUE(back.samePixels(shown));
        EXPECT_EQ(shown.c[0].at(0, 0), 0.0f);
        for (int y = 0; y < 3; y++)
            for (int x = 1; x < 257; x++)
                for (size_t c = 0; c < 3; c++)
                    ASSERT_EQ(shown.c[c].at(x, y), std::min(std::max(linear.c[c].at(x, y), 0.0f), 1.0f));
    }
    // Exposure and tone map come before; the same image may be source and target.
    encode(linear, {1.0f, ToneMap::reinhard, Transfer::identity}, {}, shown);
    const double v = 2 * double(linear.c[1].at(120, 1));
    EXPECT_NEAR(shown.c[1].at(120, 1), v / (1 + v), 1e-7);
    encode(linear, {1.0f, ToneMap::reinhard, Transfer::identity}, {}, linear);
    EXPECT_TRUE(linear.samePixels(shown));
}

TEST(Colour, TheCeilingIsDisplayedAsOne) {
    for (const DisplayChain chain : {DisplayChain{1.5f, ToneMap::none, Transfer::identity},
                                     DisplayChain{-2.0f, ToneMap::aces, Transfer::identity}}) {
        const float ceiling = float(displayCeiling(chain));
        Rgb linear(3, 1), shown;
        const float values[] = {ceiling * 0.9999f, ceiling, ceiling * 1.5f};
        for (int x = 0; x < 3; x++)
            for (auto& p : linear.c) p.at(x, 0) = values[x];
        encode(linear, chain, {}, shown);
        EXPECT_LT(shown.c[0].at(0, 0), 1.0f);
        EXPECT_NEAR(shown.c[0].at(1, 0), 1.0f, 1e-6);
        EXPECT_EQ(shown.c[0].at(2, 0), 1.0f);
    }
    EXPECT_TRUE(std::isinf(displayCeiling({0, ToneMap::reinhard})));
}
TEST(Colour, ClippedPixelsAreCountedOnce) {
    Rgb linear(4, 2, 0.5f);
    linear.c[0].at(1, 0) = 1.01f, linear.c[2].at(1, 0) = 3.0f;
    linear.c[1].at(3, 1) = -0.01f;
    linear.c[1].at(0, 1) = 1.0f;
    EXPECT_EQ(clippedPixels(linear, {}), 2u);
    EXPECT_EQ(clippedPixels(linear, {1.5f}), 8u);
    EXPECT_EQ(clippedPixels(linear, {-2.0f}), 1u);
}
}  // namespace
}  // namespace aa
