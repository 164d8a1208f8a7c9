#include "metrics/maps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "image/colour_map.h"
#include "image/error.h"
#include "metrics/flip.h"
#include "metrics/fourier.h"
#include "metrics/metrics.h"

namespace aa {
namespace {
constexpr double kPi = std::numbers::pi;

Rgb flat(float value) {
    Rgb image(32, 24, value);
    image.fillBorder();
    return image;
}
// A block and a wave that only the test picture has.
Rgb wrong() {
    Rgb image = flat(0.5f);
    for (auto& p : image.c) {
        for (int y = 4; y < 8; y++)
            for (int x = 4; x < 8; x++) p.at(x, y) = 0.9f;
        p.fillBorder();
    }
    return image;
}
Colour at(const Rgb& image, int x, int y) { return {image.c[0].at(x, y), image.c[1].at(x, y), image.c[2].at(x, y)}; }

TEST(Maps, EqualPicturesShowTheLowEndOfEveryScale) {
    for (const MapKind& kind : mapKinds()) {
        const Rgb map = kind.draw(flat(0.5f), flat(0.5f), {});
        ASSERT_EQ(map.width(), 32);
        ASSERT_EQ(map.height(), 24);
        const Colour expected = kind.name == "ssim" ? Colour{1, 1, 1} : errorColour(0);
        for (const auto& [x, y] : {std::pair{0, 0}, {16, 12}, {31, 23}})
            EXPECT_EQ(at(map, x, y), expected) << kind.name;
    }
}
TEST(Maps, ShowWhatTheMetricsFind) {
    const Rgb test = wrong(), reference = flat(0.5f);
    PlaneF ssim, flips;
    ssimLuma(test, reference, {}, &ssim);
    flip(test, reference, {}, &flips);
    EXPECT_EQ(at(mapKindByName("error").draw(test, reference, {}), 5, 5), errorColour(1));  // 0.4 is beyond 0.2
    EXPECT_EQ(at(mapKindByName("flip").draw(test, reference, {}), 5, 5), errorColour(double(flips.at(5, 5))));
    const Colour grey = at(mapKindByName("ssim").draw(test, reference, {}), 5, 5);
    EXPECT_EQ(grey[1], std::max(0.0f, ssim.at(5, 5)));
    EXPECT_LT(grey[1], 0.5f);
}
// A wave of amplitude a has a W H / 2 at its frequency and at the opposite one.
TEST(Maps, AWaveIsTwoPointsAroundTheCentreOfTheSpectrum) {
    const Rgb reference = flat(0.5f);
    Rgb test = reference;
    for (auto& p : test.c)
        for (int y = 0; y < 24; y++)
            for (int x = 0; x < 32; x++) p.at(x, y) += float(0.01 * std::cos(2 * kPi * (5.0 * x / 32 + 3.0 * y / 24)));
    const PlaneF map = fourierDifference(test, reference, {});
    const double expected = 0.01 * std::sqrt(32.0 * 24) / 2;
    EXPECT_NEAR(map.at(16 + 5, 12 + 3), expected, 1e-6);
    EXPECT_NEAR(map.at(16 - 5, 12 - 3), expected, 1e-6);
    EXPECT_NEAR(map.at(16, 12), 0, 1e-6);
    EXPECT_NEAR(map.at(16 + 5, 12 - 3), 0, 1e-6);
    const Rgb picture = mapKindByName("fourier").draw(test, reference, {});
    EXPECT_EQ(at(picture, 21, 15), errorColour(1 + std::log10(double(map.at(21, 15))) / 4));
    // Brightness alone is the centre.
    const PlaneF brighter = fourierDifference(flat(0.75f), reference, {});
    EXPECT_NEAR(brighter.at(16, 12), 0.25 * std::sqrt(32.0 * 24), 1e-5);
    EXPECT_NEAR(brighter.at(17, 12), 0, 1e-6);
}
TEST(Maps, TheRootMeanSquareOfTheSpectrumIsThatOfThePicture) {
    const Rgb test = wrong(), reference = flat(0.25f);
    const PlaneF map = fourierDifference(test, reference, {});
    double sum = 0;
    for (int y = 0; y < 24; y++)
        for (int x = 0; x < 32; x++) sum += double(map.at(x, y)) * double(map.at(x, y));
    EXPECT_NEAR(sum / (32 * 24), squaredError(test, reference, {}).mse, 1e-7);
    for (const MapKind& kind : mapKinds())
        EXPECT_TRUE(
            kind.draw(test, reference, {.parallel = true}).samePixels(kind.draw(test, reference, {.parallel = false})))
            << kind.name;
}
TEST(Maps, UnknownKindsAreNamedWithThoseThatThereAre) {
    try {
        mapKindByName("ssmi");
        FAIL();
    } catch (const UsageError& e) {
        EXPECT_NE(std::string(e.what()).find("expected one of error, ssim, flip, cvvdp, fourier"), std::string::npos)
            << e.what();
    }
}

}  // namespace
}  // namespace aa
