#include "metrics/error_bar.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <tuple>

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

// Halves of a truth around `exact`, and what measure() takes.
Reference noisyTruth(const Rgb& exact, double sigma, unsigned seed) {
    return makeReference(shifted(exact, sigma * std::sqrt(2), seed), shifted(exact, sigma * std::sqrt(2), seed + 1),
                         {.transfer = Transfer::identity}, {});
}
TEST(ErrorBar, ClearDifferenceIsResolved) {
    const Rgb exact(320, 160, 0.5f);
    const Reference truth = noisyTruth(exact, 0.003, 7);
    const TileErrors good = tileErrors(shifted(exact, 0.01, 1), truth, {}),
                     bad = tileErrors(shifted(exact, 0.02, 2), truth, {});
    const Comparison c = compareMethods(good, bad);
    EXPECT_TRUE(c.resolved);
    EXPECT_EQ(c.why, Unresolved::no);
    EXPECT_NEAR(c.mseDifference, 0.0001 - 0.0004, 1e-5);
    EXPECT_LT(c.low, c.mseDifference);
    EXPECT_GT(c.high, c.mseDifference);
    EXPECT_LT(c.high, 0);
    EXPECT_NEAR(c.gainDb, 20 * std::log10(2), 0.1);
    EXPECT_LT(c.gainLow, c.gainDb);
    EXPECT_GT(c.gainHigh, c.gainDb);
    EXPECT_LT(c.gainHigh - c.gainLow, 0.3);
    const Comparison reversed = compareMethods(bad, good);
    EXPECT_EQ(reversed.mseDifference, -c.mseDifference);
    EXPECT_NEAR(reversed.gainLow, -c.gainHigh, 1e-9);
    EXPECT_TRUE(reversed.resolved);
}
// The truth's variance and, to second order, what the encoding makes of it are taken off.
TEST(ErrorBar, SquaresAreFreeOfTheTruthsNoise) {
    const Rgb exact(320, 320, 0.2f);
    Rgb encoded;
    encode(exact, {}, {}, encoded);
    Rgb test = encoded;
    for (auto& p : test.c)
        for (int y = 0; y < 320; y++)
            for (int x = 0; x < 320; x++) p.at(x, y) -= 0.05f;
    const double sigma = 0.02;
    const Reference truth =
        makeReference(shifted(exact, sigma * std::sqrt(2), 1), shifted(exact, sigma * std::sqrt(2), 2), {}, {});
    const TileErrors errors = tileErrors(test, truth, {});
    const double raw = errors.squaredError().mse, exactMse = 0.05 * 0.05;
    double free = 0, values = 0;
    const ErrorParts parts = errorParts(errors)[0];
    for (size_t i = 0; i < parts.squares.size(); i++) free += parts.squares[i], values += parts.values[i];
    EXPECT_GT(std::abs(raw - exactMse), 4e-4);
    EXPECT_GT(std::abs(raw - truth.noise - exactMse), 5e-5) << "first order alone";
    EXPECT_NEAR(free / values, exactMse, 2e-5);  // its standard error is 4e-6
}
TEST(ErrorBar, ReasonsAreNamed) {
    const Rgb exact(160, 96, 0.5f);
    const Comparison same = compareMethods(tileErrors(exact, exact, {}), tileErrors(exact, exact, {}));
    EXPECT_EQ(same.why, Unresolved::equal);
    EXPECT_FALSE(same.resolved);
    EXPECT_EQ(same.gainDb, 0);
    // One is better on the left and the other on the right.
    Rgb left = exact, right = exact;
    for (int y = 0; y < 96; y++)
        for (int x = 0; x < 80; x++) left.c[0].at(x, y) += 0.05f, right.c[0].at(x + 80, y) += 0.051f;
    EXPECT_FALSE(compareMethods(tileErrors(left, exact, {}), tileErrors(right, exact, {})).resolved);
    // Now and then in every part: nothing hangs together.
    std::mt19937 random(3);
    Rgb a = exact, b = exact;
    for (int i = 0; i < 40; i++) {
        Rgb& image = i % 2 ? a : b;
        const int x0 = 8 * int(random() % 20), y0 = 8 * int(random() % 12);
        for (int y = y0; y < y0 + 8; y++)
            for (int x = x0; x < x0 + 8; x++) image.c[1].at(x, y) += 0.05f;
    }
    EXPECT_EQ(compareMethods(tileErrors(a, exact, {}), tileErrors(b, exact, {})).why, Unresolved::varies);
    // Everywhere the same small difference, under a noisy truth.
    Rgb fine = exact, coarse = exact;
    for (int y = 0; y < 96; y++)
        for (int x = 0; x < 160; x++) fine.c[1].at(x, y) += 0.0001f, coarse.c[1].at(x, y) -= 0.0002f;
    const Reference noisy = noisyTruth(exact, 0.02, 11);
    EXPECT_EQ(compareMethods(tileErrors(fine, noisy, {}), tileErrors(coarse, noisy, {})).why, Unresolved::truthNoise);
    EXPECT_TRUE(compareMethods(tileErrors(fine, exact, {}), tileErrors(coarse, exact, {})).resolved) << "an exact one";
    // 16 x 16 px hold four tiles.
    const Rgb little(16, 16, 0.5f), other(16, 16, 0.6f);
    const Comparison small = compareMethods(tileErrors(little, little, {}), tileErrors(other, little, {}));
    EXPECT_EQ(small.why, Unresolved::tooSmall);
    EXPECT_EQ(small.gainLow, -std::numeric_limits<double>::infinity());
    EXPECT_LT(small.mseDifference, 0);
    for (const Unresolved why :
         {Unresolved::no, Unresolved::truthNoise, Unresolved::varies, Unresolved::tooSmall, Unresolved::equal})
        EXPECT_EQ(unresolvedByName(nameOf(why)), why);
    EXPECT_THROW(unresolvedByName("weather"), std::runtime_error);
}
// The same picture by another order of sums, as ssaa and msaa give it: whichever way its last places go is no
// difference, even where it is the same way in every part.
TEST(ErrorBar, RoundingIsNoDifference) {
    const Rgb exact(160, 96, 0.5f);
    Rgb one = exact;
    for (int y = 0; y < 96; y++)
        for (int x = 0; x < 160; x++) one.c[1].at(x, y) += 0.02f;
    Rgb farther = one, other = one;
    for (int y = 0; y < 96; y++)
        for (int x = 0; x < 160; x += 3) {
            farther.c[1].at(x, y) += 0x1p-24f;
            other.c[1].at(x, y) += 0.0001f;  // less than a fortieth of an 8-bit code, and yet another picture
        }
    const auto errors = [&](const Rgb& image) { return tileErrors(image, exact, {}); };
    ASSERT_NE(errors(one).totalSum(), errors(farther).totalSum());
    const Comparison same = compareMethods(errors(one), errors(farther));
    EXPECT_EQ(same.why, Unresolved::equal);
    EXPECT_FALSE(same.resolved);
    for (const double v : {same.mseDifference, same.low, same.high, same.gainDb, same.gainLow, same.gainHigh})
        EXPECT_EQ(v, 0);
    EXPECT_TRUE(compareMethods(errors(one), errors(other)).resolved);
    // Sums that agree by chance make no two pictures one: a mirrored one has the same error elsewhere.
    Rgb left = exact, right = exact;
    for (int y = 0; y < 96; y++)
        for (int x = 0; x < 80; x++) left.c[0].at(x, y) += 0.05f, right.c[0].at(159 - x, y) += 0.05f;
    EXPECT_EQ(errors(left).totalSum(), errors(right).totalSum());
    EXPECT_NE(compareMethods(errors(left), errors(right)).why, Unresolved::equal);
}
TEST(ErrorBar, PartsAreNearSquareAndHoldEveryTile) {
    for (const auto& [w, h, columns, rows] :
         {std::tuple{160, 90, 4, 4}, {400, 60, 8, 2}, {16, 900, 1, 16}, {24, 24, 3, 3}, {32, 32, 4, 4}}) {
        const Rgb image(w, h, 0.5f), other(w, h, 0.25f);
        const TileErrors tiles = tileErrors(image, other, {});
        const ErrorParts parts = errorParts(tiles)[0];
        EXPECT_EQ(parts.columns, columns) << w << " x " << h;
        EXPECT_EQ(parts.rows, rows) << w << " x " << h;
        double squares = 0, values = 0;
        for (size_t i = 0; i < parts.squares.size(); i++) squares += parts.squares[i], values += parts.values[i];
        EXPECT_NEAR(squares, tiles.totalSum(), 1e-9 * squares);
        EXPECT_EQ(values, 3.0 * w * h);
    }
}
// A method that equals the truth: the gain is infinite, its lower bound not always.
TEST(ErrorBar, NoErrorAtAll) {
    const Rgb exact(64, 64, 0.5f);
    const Comparison c = compareMethods(tileErrors(exact, exact, {}), tileErrors(shifted(exact, 0.02, 1), exact, {}));
    EXPECT_TRUE(c.resolved);
    EXPECT_EQ(c.gainDb, std::numeric_limits<double>::infinity());
    EXPECT_EQ(c.gainHigh, std::numeric_limits<double>::infinity());
    EXPECT_GT(c.gainLow, 0);
}

TEST(Measure, OneCallGivesAllFigures) {
    const Rgb truth(40, 30, 0.2f), half = truth;
    Rgb linear = shifted(truth, 0.02, 4), encoded;
    encode(linear, {}, {}, encoded);
    const Reference reference = makeReference(half, half, {}, {});
    TileErrors pool;
    const FrameMetrics m = measure({encoded, &linear}, reference, measureOptions({"ssimRgb", "relMse"}), {}, pool);
    EXPECT_EQ(m.mse, squaredError(encoded, reference.encoded, {}).mse);
    EXPECT_EQ(m.psnr, psnr(m.mse));
    EXPECT_EQ(m.figure("ssimLuma"), ssimLuma(encoded, reference.encoded, {}));
    EXPECT_EQ(m.figure("ssimRgb"), ssimRgb(encoded, reference.encoded, {}));
    EXPECT_EQ(m.figure("relMse"), relMse(linear, reference.linear, {}));
    EXPECT_EQ(pool.squaredError().mse, m.mse);
    EXPECT_FALSE(measure({encoded}, reference, measureOptions({"relMse"}), {}, pool).figure("relMse"));
    EXPECT_EQ(pool.totalValues(), 2.0 * 3 * 40 * 30);
}

TEST(Measure, WhatIsPreparedOfTheReferenceChangesNoFigure) {
    const Rgb truth = shifted(Rgb(75, 43, 0.3f), 0.2, 7);
    MeasureOptions options = measureOptions({"ssimRgb", "ssimValid"});
    options.ofJudged = {findFigure("flip").metric};
    for (const Precision precision : {Precision::fast, Precision::scalar, Precision::oracle}) {
        const Exec exec{.precision = precision};
        const Reference plain = makeReference(truth, truth, {}, exec);
        Reference prepared = plain;
        prepare(prepared, options, exec, false);
        EXPECT_FALSE(prepared.prepared.contains(findFigure("flip").metric)) << "the frame is not judged by it";
        prepare(prepared, options, exec);
        EXPECT_TRUE(prepared.prepared.contains(findFigure("flip").metric));
        for (const unsigned seed : {1u, 2u}) {
            Rgb encoded;
            encode(shifted(truth, 0.05, seed), {}, exec, encoded);
            const PlaneF luma = pictureLuma(encoded, exec);
            TileErrors pool, other;
            const FrameMetrics m = measure({encoded, nullptr, &luma}, prepared, options, exec, pool),
                               expected = measure({encoded}, plain, options, exec, other);
            EXPECT_EQ(m.mse, expected.mse);
            EXPECT_EQ(m.snr, expected.snr);
            EXPECT_TRUE(std::equal(m.others.begin(), m.others.end(), expected.others.begin(), expected.others.end()));
            EXPECT_EQ(std::distance(m.others.begin(), m.others.end()), 7) << "SSIM of three kinds, FLIP, its quartiles";
        }
    }
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
    EXPECT_FALSE(errorOverTime(std::vector<FrameSum>(3, {1.0, 10.0})));
    EXPECT_FALSE(compareOverTime(std::vector<FrameSum>(8, {0.0, 10.0}), std::vector<FrameSum>(8, {1.0, 10.0})));
}
}  // namespace
}  // namespace aa
