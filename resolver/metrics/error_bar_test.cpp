#include "metrics/error_bar.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "metrics/measure.h"

namespace aa {
namespace {
Rgb shifted(const Rgb& from, double sigma, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> error(0, sigma);
    Rgb image = from;
    for (auto& p : image.c)
        for (int y = 0; y < p.height(); y++)
            for (int x = 0; x < p.width(); x++) p.at(x, y) += float(error(random));
    return image;
}

// Two noisy halves around a known exact image: a quarter of their MSE must be the noise of their mean, and taking it
// off must bring the measured MSE back to the exact one.
TEST(ErrorBar, NoiseOfTheMeanOfTwoHalves) {
    const Rgb exact(200, 160, 0.5f);
    const double sigma = 0.02;
    const Rgb a = shifted(exact, sigma, 1), b = shifted(exact, sigma, 2), test = shifted(exact, 0.03, 3);
    Rgb mean = a;
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < 160; y++)
            for (int x = 0; x < 200; x++) mean.c[c].at(x, y) = 0.5f * (a.c[c].at(x, y) + b.c[c].at(x, y));
    const double noise = truthNoise(squaredError(a, b, {}).mse);
    EXPECT_NEAR(noise, sigma * sigma / 2, 0.02 * sigma * sigma);
    EXPECT_NEAR(noise, squaredError(mean, exact, {}).mse, 0.02 * sigma * sigma);
    const MseInterval bar = mseInterval(squaredError(test, mean, {}).mse, noise);
    const double exactMse = squaredError(test, exact, {}).mse;
    EXPECT_NEAR(bar.corrected, exactMse, 0.02 * exactMse);
    EXPECT_GT(bar.raw, 1.15 * exactMse);
    EXPECT_EQ(mseInterval(1.0, 2.0).corrected, 0.0);
}
TEST(ErrorBar, ReferenceIsTheMeanOfTheHalves) {
    const Reference r = makeReference(Rgb(5, 4, 0.25f), Rgb(5, 4, 0.75f), {}, {});
    EXPECT_EQ(r.linear.c[1].at(2, 2), 0.5f);
    EXPECT_NEAR(r.encoded.c[1].at(2, 2), 0.735357f, 1e-6f);
    const double e1 = 1.055 * std::pow(0.25, 1 / 2.4) - 0.055, e2 = 1.055 * std::pow(0.75, 1 / 2.4) - 0.055;
    EXPECT_NEAR(r.noise, (e1 - e2) * (e1 - e2) / 4, 1e-6);
    EXPECT_EQ(makeReference(Rgb(5, 4, 0.5f), Rgb(5, 4, 0.5f), {}, {}).noise, 0.0);
    // In one space the mean is displayed as it is, clamped once, and the count of what was clamped is kept.
    const DisplayChain identity{.transfer = Transfer::identity};
    const Reference shown = makeReference(Rgb(5, 4, 0.25f), Rgb(5, 4, 0.75f), identity, {});
    EXPECT_EQ(shown.encoded.c[0].at(2, 2), 0.5f);
    EXPECT_TRUE(shown.linear.samePixels(shown.encoded));
    EXPECT_EQ(shown.clippedPixels, 0u);
    EXPECT_EQ(shown.noise, 0.25 / 4);
    const Reference bright = makeReference(Rgb(5, 4, 0.5f), Rgb(5, 4, 2.0f), identity, {});
    EXPECT_EQ(bright.encoded.c[0].at(2, 2), 1.0f);
    EXPECT_EQ(bright.clippedPixels, 20u);
    // Rounded, the displayed truth is a code; its noise is that of the halves, not of the rounding.
    const Reference eightBit = makeReference(Rgb(5, 4, 0.25f), Rgb(5, 4, 0.75f), identity, {}, true);
    EXPECT_EQ(eightBit.encoded.c[0].at(2, 2), 128.0f / 255);
    EXPECT_EQ(eightBit.linear.c[0].at(2, 2), 0.5f);
    EXPECT_EQ(eightBit.noise, shown.noise);
}

TEST(ErrorBar, ClearDifferenceIsResolved) {
    const Rgb truth(320, 160, 0.5f);
    const TileErrors good = tileErrors(shifted(truth, 0.01, 1), truth, {}),
                     bad = tileErrors(shifted(truth, 0.02, 2), truth, {});
    const Comparison c = compareMethods(good, bad, 1e-5);
    EXPECT_TRUE(c.resolved);
    EXPECT_NEAR(c.mseDifference, 0.0001 - 0.0004, 1e-5);
    EXPECT_LT(c.low, c.mseDifference);
    EXPECT_GT(c.high, c.mseDifference);
    EXPECT_LT(c.high, 0);
    EXPECT_NEAR(c.gainDb, 20 * std::log10(2), 0.1);
    EXPECT_LT(c.gainLow, c.gainDb);
    EXPECT_GT(c.gainHigh, c.gainDb);
    EXPECT_LT(c.gainHigh - c.gainLow, 1.2);  // the noise of 1e-5 alone may hide 0.3 dB
    EXPECT_GT(c.gainHigh - c.gainDb, 0.3);
    const Comparison reversed = compareMethods(bad, good, 1e-5);
    EXPECT_EQ(reversed.mseDifference, -c.mseDifference);
    EXPECT_TRUE(reversed.resolved);
}
TEST(ErrorBar, DifferenceBelowTheTruthsNoiseIsNot) {
    const Rgb truth(320, 160, 0.5f);
    const TileErrors good = tileErrors(shifted(truth, 0.01, 1), truth, {}),
                     bad = tileErrors(shifted(truth, 0.02, 2), truth, {});
    EXPECT_FALSE(compareMethods(good, bad, 4e-4).resolved);
}
TEST(ErrorBar, DifferenceFromAFewTilesIsNot) {
    // Equal everywhere but in one tile of 50: the mean differs, yet half the resamples hardly see it.
    TileErrors a, b;
    a.sum.assign(50, 1.0), a.values.assign(50, 3072);
    b = a;
    b.sum[7] = 3;
    const Comparison c = compareMethods(a, b, 0);
    EXPECT_LT(c.mseDifference, 0);
    EXPECT_EQ(c.high, 0);
    EXPECT_FALSE(c.resolved);
}
TEST(ErrorBar, SameMethodTwice) {
    TileErrors a;
    a.sum.assign(10, 1.0), a.values.assign(10, 3072);
    const Comparison c = compareMethods(a, a, 0);
    EXPECT_FALSE(c.resolved);
    EXPECT_EQ(c.mseDifference, 0);
    EXPECT_EQ(c.gainDb, 0);
}
TEST(ErrorBar, BootstrapRepeats) {
    std::mt19937 random(5);
    TileErrors a, b;
    for (int i = 0; i < 40; i++)
        a.sum.push_back(double(random() % 1000)), b.sum.push_back(double(random() % 1000)), a.values.push_back(3072),
            b.values.push_back(3072);
    const Comparison c = compareMethods(a, b, 0), again = compareMethods(a, b, 0);
    EXPECT_EQ(c.low, again.low);
    EXPECT_EQ(c.high, again.high);
    // The interval's half width is about two standard errors of the mean difference.
    double mean = 0, var = 0;
    for (size_t i = 0; i < 40; i++) mean += (a.sum[i] - b.sum[i]) / 3072 / 40;
    for (size_t i = 0; i < 40; i++) var += std::pow((a.sum[i] - b.sum[i]) / 3072 - mean, 2) / 39;
    EXPECT_NEAR(c.high - c.low, 2 * 1.96 * std::sqrt(var / 40), 0.15 * (c.high - c.low));
}

TEST(Measure, OneCallGivesAllFigures) {
    const Rgb truth(40, 30, 0.2f), half = truth;
    Rgb linear = shifted(truth, 0.02, 4), encoded;
    encode(linear, {}, {}, encoded);
    const Reference reference = makeReference(half, half, {}, {});
    TileErrors pool;
    const FrameMetrics m = measure(encoded, &linear, reference, measureOptions({"ssimRgb", "relMse"}), {}, pool);
    EXPECT_EQ(m.mse, squaredError(encoded, reference.encoded, {}).mse);
    EXPECT_EQ(m.psnr, psnr(m.mse));
    EXPECT_EQ(m.figure("ssimLuma"), ssimLuma(encoded, reference.encoded, {}));
    EXPECT_EQ(m.figure("ssimRgb"), ssimRgb(encoded, reference.encoded, {}));
    EXPECT_EQ(m.figure("relMse"), relMse(linear, reference.linear, {}));
    EXPECT_EQ(pool.squaredError().mse, m.mse);
    EXPECT_FALSE(measure(encoded, nullptr, reference, measureOptions({"relMse"}), {}, pool).figure("relMse"));
    EXPECT_EQ(pool.totalValues(), 2.0 * 3 * 40 * 30);
}

// Three methods over 16 frames: the second has a quarter of the first's ghost, the third differs from the first by the
// frames' own scatter alone.
TEST(ErrorBar, OverTime) {
    std::vector<FrameSum> first, quarter, alike;
    std::mt19937 random(5);
    std::normal_distribution<double> scatter(0, 0.05);
    for (int n = 0; n < 16; n++) {
        const double pixels = 100 + n;
        first.push_back({pixels * 0.01 * (1 + scatter(random)), pixels});
        quarter.push_back({first.back().sum / 4 * (1 + scatter(random)), pixels});
        alike.push_back({pixels * 0.01 * (1 + scatter(random)), pixels});
    }
    const auto clear = compareOverTime(quarter, first), none = compareOverTime(alike, first);
    ASSERT_TRUE(clear && none);
    EXPECT_NEAR(clear->gainDb, 6.02, 0.2);
    EXPECT_TRUE(clear->resolved);
    EXPECT_LT(clear->high - clear->low, 1);
    EXPECT_FALSE(none->resolved);
    EXPECT_LT(none->low * none->high, 0);
    const auto error = errorOverTime(first);
    ASSERT_TRUE(error);
    EXPECT_GT(*error, 1e-5);  // 0.01 with 5 % scatter over 16 frames: about +- 2.7 %
    EXPECT_LT(*error, 1e-3);
    // Equal frames have no spread.
    EXPECT_NEAR(*errorOverTime(std::vector<FrameSum>(12, {3.0, 10.0})), 0, 1e-15);
    // Too few frames, and nothing at all, give no interval.
    EXPECT_FALSE(errorOverTime(std::vector<FrameSum>(2, {1.0, 10.0})));
    EXPECT_FALSE(compareOverTime(std::vector<FrameSum>(8, {0.0, 10.0}), std::vector<FrameSum>(8, {1.0, 10.0})));
}
}  // namespace
}  // namespace aa
