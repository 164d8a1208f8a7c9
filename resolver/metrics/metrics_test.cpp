#include "metrics/metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "metrics/metrics_testing.h"

namespace aa {
namespace {
constexpr double kInf = std::numeric_limits<double>::infinity();

// Smooth waves with a little noise: like an image and its anti-aliased form.
Rgb waves(int w, int h, unsigned seed, float grain) {
    Rgb image = noisePicture(w, h, seed, -grain, grain);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++)
                image.c[c].at(x, y) += 0.5f + 0.3f * std::sin(0.21f * float(x) + 0.13f * float(y) + float(c));
    return image;
}
double luma(const Rgb& i, int x, int y) {
    return 0.299 * double(i.c[0].clamped(x, y)) + 0.587 * double(i.c[1].clamped(x, y)) +
           0.114 * double(i.c[2].clamped(x, y));
}

// Straight from the definition: 121 weights, two passes, double.
using Pixel = std::function<double(const Rgb&, int, int, int)>;  // image, x, y, z
double naiveSsimAt(const Rgb& t, const Rgb& r, int x0, int y0, int z0, int reachZ, const Pixel& value) {
    double total = 0, mx = 0, my = 0, sx = 0, sy = 0, sxy = 0;
    const auto w = [](int i) { return std::exp(-i * i / 4.5); };
    const auto each = [&](const std::function<void(double, double, double)>& f) {
        for (int k = -reachZ; k <= reachZ; k++)
            for (int j = -5; j <= 5; j++)
                for (int i = -5; i <= 5; i++)
                    f(w(i) * w(j) * (reachZ ? w(k) : 1), value(t, x0 + i, y0 + j, z0 + k),
                      value(r, x0 + i, y0 + j, z0 + k));
    };
    each([&](double g, double a, double b) { total += g, mx += g * a, my += g * b; });
    mx /= total, my /= total;
    each([&](double g, double a, double b) {
        sx += g * (a - mx) * (a - mx), sy += g * (b - my) * (b - my), sxy += g * (a - mx) * (b - my);
    });
    sx /= total, sy /= total, sxy /= total;
    const double c1 = 1e-4, c2 = 9e-4;
    return (2 * mx * my + c1) * (2 * sxy + c2) / ((mx * mx + my * my + c1) * (sx + sy + c2));
}
double naiveSsim(const Rgb& t, const Rgb& r, int channels, int reachZ, const Pixel& value) {
    double sum = 0;
    for (int z = 0; z < channels; z++)
        for (int y = 0; y < t.height(); y++)
            for (int x = 0; x < t.width(); x++) sum += naiveSsimAt(t, r, x, y, z, reachZ, value);
    return sum / (double(channels) * t.width() * t.height());
}
const Pixel kLuma = [](const Rgb& i, int x, int y, int) { return luma(i, x, y); };
const Pixel kChannel = [](const Rgb& i, int x, int y, int z) {
    return double(i.c[size_t(std::clamp(z, 0, 2))].clamped(x, y));
};

TEST(SquaredError, AgreesWithTheDefinition) {
    for (const auto& [w, h] : {std::pair{1, 1}, {7, 3}, {31, 40}, {33, 33}, {100, 65}}) {
        const Rgb t = noisePicture(w, h, 1), r = noisePicture(w, h, 2);
        double mse = 0, power = 0, rel = 0;
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < h; y++)
                for (int x = 0; x < w; x++) {
                    const double b = double(r.c[c].at(x, y)), d = double(t.c[c].at(x, y)) - b;
                    mse += d * d, power += b * b, rel += d * d / (b * b + 0.01);
                }
        const double n = 3.0 * w * h;
        const SquaredError e = squaredError(t, r, {});
        EXPECT_NEAR(e.mse, mse / n, 1e-7 * mse / n) << w << "x" << h;
        EXPECT_NEAR(e.reference, power / n, 1e-7 * power / n);
        EXPECT_NEAR(relMse(t, r, {}), rel / n, 1e-6 * rel / n);
    }
}
TEST(SquaredError, HandComputed) {
    Rgb t(2, 1), r(2, 1);
    t.c[0].at(0, 0) = 0.5f;  // one of six values differs by 0.5
    r.c[1].at(1, 0) = t.c[1].at(1, 0) = 1.0f;
    const SquaredError e = squaredError(t, r, {});
    EXPECT_DOUBLE_EQ(e.mse, 0.25 / 6);
    EXPECT_DOUBLE_EQ(e.reference, 1.0 / 6);
    EXPECT_NEAR(psnr(e.mse), 10 * std::log10(24.0), 1e-12);
    EXPECT_NEAR(snr(e), 10 * std::log10(4.0), 1e-12);
    EXPECT_NEAR(relMse(t, r, {}), (0.25 / 0.01) / 6, 1e-5);
}
TEST(SquaredError, PublishedTriples) {  // MSE in 8-bit units, RMSD and PSNR of the tables of [Oliveros 2018]
    EXPECT_NEAR(psnr(8.608, 255), 38.782, 5e-4);
    EXPECT_NEAR(psnr(149.271, 255), 26.391, 5e-4);
    EXPECT_NEAR(rmse(149.271), 12.218, 5e-4);
    EXPECT_NEAR(psnr(149.271 / 65025), 26.391, 5e-4);
}
TEST(SquaredError, InfinitiesAndNan) {
    const Rgb a = noisePicture(9, 9, 3), black(9, 9);
    EXPECT_EQ(psnr(squaredError(a, a, {}).mse), kInf);
    EXPECT_EQ(snr(squaredError(a, a, {})), kInf);
    EXPECT_EQ(snr(squaredError(a, black, {})), -kInf);
    EXPECT_EQ(snr(squaredError(black, black, {})), kInf);
    Rgb broken = a;
    broken.c[1].at(8, 8) = NAN;
    EXPECT_TRUE(std::isnan(squaredError(broken, a, {}).mse));
    EXPECT_TRUE(std::isnan(psnr(squaredError(broken, a, {}).mse)));
    EXPECT_TRUE(std::isnan(ssimLuma(broken, a, {})));
}
TEST(SquaredError, PaddingDoesNotCount) {
    Rgb t = noisePicture(13, 5, 4), r = noisePicture(13, 5, 5);
    const double clean = squaredError(t, r, {}).mse, ssim = ssimRgb(t, r, {});
    for (auto* image : {&t, &r})
        for (auto& p : image->c)
            for (int y = -kBorderY; y < 5 + kBorderY; y++)
                for (int x = -kBorderX; x < p.stride() - kBorderX; x++)
                    if (x < 0 || x >= 13 || y < 0 || y >= 5) p.at(x, y) = NAN;
    EXPECT_EQ(squaredError(t, r, {}).mse, clean);
    EXPECT_EQ(ssimRgb(t, r, {}), ssim);
}
TEST(SquaredError, TilesSumToTheWhole) {
    const Rgb t = noisePicture(70, 40, 6), r = noisePicture(70, 40, 7);
    const TileErrors tiles = tileErrors(t, r, {});
    ASSERT_EQ(tiles.sum.size(), 9u * 5);
    EXPECT_EQ(tiles.columns, 9u);
    EXPECT_EQ(tiles.values[0], 3.0 * 8 * 8);
    EXPECT_EQ(tiles.values[8], 3.0 * 6 * 8);
    const std::vector<double> coarse = tiles.coarse(4);
    ASSERT_EQ(coarse.size(), 6u);
    EXPECT_EQ(tiles.totalValues(), 3.0 * 70 * 40);
    double corner = 0;
    for (size_t c = 0; c < 3; c++)
        for (int y = 32; y < 40; y++)
            for (int x = 64; x < 70; x++) corner += std::pow(double(t.c[c].at(x, y)) - double(r.c[c].at(x, y)), 2);
    EXPECT_NEAR(coarse[5], corner, 1e-6 * corner);
    EXPECT_EQ(tiles.sum[44], coarse[5]);
    TileErrors twice = tiles;
    twice += tiles;
    EXPECT_DOUBLE_EQ(twice.squaredError().mse, tiles.squaredError().mse);
    EXPECT_DOUBLE_EQ(twice.squaredError().reference, tiles.squaredError().reference);
}

TEST(Ssim, AgreesWithTheDefinition) {
    for (const auto& [w, h] : {std::pair{1, 1}, {1, 9}, {9, 1}, {5, 4}, {30, 17}, {75, 20}, {140, 3}})
        for (const float grain : {0.01f, 0.2f}) {
            const Rgb t = waves(w, h, 1, grain), r = waves(w, h, 2, grain);
            for (const auto precision : {Precision::fast, Precision::oracle}) {
                Exec exec;
                exec.precision = precision;
                // float storage of local moments of values <= 2: 1e-7, against C2 = 9e-4
                const double tolerance = precision == Precision::oracle ? 1e-8 : 2e-5;
                EXPECT_NEAR(ssimLuma(t, r, exec), naiveSsim(t, r, 1, 0, kLuma), tolerance)
                    << w << "x" << h << " " << grain;
                EXPECT_NEAR(ssimRgb(t, r, exec), naiveSsim(t, r, 3, 0, kChannel), tolerance);
                EXPECT_NEAR(ssimMatlab3D(t, r, exec), naiveSsim(t, r, 3, 5, kChannel), tolerance);
            }
        }
}
TEST(Ssim, MapIsThePerPixelValue) {
    const Rgb t = waves(70, 30, 1, 0.1f), r = waves(70, 30, 2, 0.1f);
    PlaneF map;
    const double mean = ssimLuma(t, r, {}, &map);
    double sum = 0;
    for (int y = 0; y < 30; y++)
        for (int x = 0; x < 70; x++) sum += double(map.at(x, y));
    EXPECT_NEAR(sum / (70 * 30), mean, 1e-6);
    for (const auto& [x, y] : {std::pair{0, 0}, {69, 29}, {35, 15}, {64, 2}})
        EXPECT_NEAR(double(map.at(x, y)), naiveSsimAt(t, r, x, y, 0, 0, kLuma), 2e-5);
}
TEST(Ssim, IdenticalIsExactlyOne) {
    for (const float grain : {0.0f, 0.3f}) {
        const Rgb a = waves(67, 21, 9, grain);
        EXPECT_EQ(ssimLuma(a, a, {}), 1.0);
        EXPECT_EQ(ssimRgb(a, a, {}), 1.0);
    }
    EXPECT_EQ(ssimLuma(Rgb(1, 1), Rgb(1, 1), {}), 1.0);
}
TEST(Ssim, ConstantsKeepTheLuminanceTermOnly) {
    const Rgb a(20, 20, 0.25f), b(20, 20, 0.75f);
    const double expected = (2 * 0.25 * 0.75 + 1e-4) / (0.25 * 0.25 + 0.75 * 0.75 + 1e-4);
    EXPECT_NEAR(ssimRgb(a, b, {}), expected, 1e-6);
    EXPECT_NEAR(ssimLuma(a, b, {}), expected, 1e-6);
}
// The kernel takes moments about one value of a tile, which here lies beyond an edge from most windows' pixels.
TEST(Ssim, EdgesFromWhichOneValueStandsOutCostNoPrecision) {
    const int w = 90, h = 70;
    Rgb t = waves(w, h, 1, 0.002f), r = waves(w, h, 2, 0.002f);
    for (auto* image : {&t, &r})
        for (auto& p : image->c)
            for (int y = 0; y < h; y++)
                for (int x = 0; x < w; x++) p.at(x, y) = 0.02f * p.at(x, y) + (x % 8 == 3 || y % 8 == 3 ? 0.9f : 0.05f);
    PlaneF found, expected;
    Exec oracle;
    oracle.precision = Precision::oracle;
    EXPECT_NEAR(ssimRgb(t, r, {}, &found), ssimRgb(t, r, oracle, &expected), 1e-7);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) ASSERT_NEAR(found.at(x, y), expected.at(x, y), 5e-6f) << x << "," << y;
}
TEST(Ssim, StructureCountsNotOnlyLevel) {  // the same histogram, mirrored structure: must be far below 1
    Rgb a(32, 32), b(32, 32);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < 32; y++)
            for (int x = 0; x < 32; x++) a.c[c].at(x, y) = float((x + y) & 1), b.c[c].at(x, y) = float((x + y + 1) & 1);
    EXPECT_LT(ssimLuma(a, b, {}), -0.99);
}

TEST(Metrics, SameBitsEverywhere) {
    const Rgb t = waves(201, 150, 1, 0.1f), r = waves(201, 150, 2, 0.1f);
    const Exec first{bestIsa(), Precision::scalar, false};
    PlaneF firstMap, map;
    const SquaredError e = squaredError(t, r, first);
    const double rel = relMse(t, r, first), s = ssimLuma(t, r, first, &firstMap), s3 = ssimMatlab3D(t, r, first);
    for (const Isa isa : kIsas)
        for (const auto precision : {Precision::fast, Precision::scalar})
            for (const bool parallel : {false, true}) {
                if (!isaSupported(isa)) continue;
                const Exec exec{isa, precision, parallel};
                EXPECT_EQ(squaredError(t, r, exec).mse, e.mse);
                EXPECT_EQ(squaredError(t, r, exec).reference, e.reference);
                EXPECT_EQ(relMse(t, r, exec), rel);
                EXPECT_EQ(ssimLuma(t, r, exec, &map), s);
                EXPECT_TRUE(map.samePixels(firstMap));
                EXPECT_EQ(ssimMatlab3D(t, r, exec), s3);
            }
}
TEST(Metrics, EightBitCodes) {
    Rgb a(4, 1);
    const float values[] = {0.5f, 127.4f / 255, 2.0f, -1.0f};
    for (int x = 0; x < 4; x++) a.c[0].at(x, 0) = values[x];
    Rgb q = a;
    quantise8(q, {});
    EXPECT_EQ(q.c[0].at(0, 0), 128.0f / 255);
    EXPECT_EQ(q.c[0].at(1, 0), 127.0f / 255);
    EXPECT_EQ(q.c[0].at(2, 0), 1.0f);
    EXPECT_EQ(q.c[0].at(3, 0), 0.0f);
}
TEST(Metrics, DitheredCodes) {
    Rgb a(64, 64, 0.3f);  // 76.5 codes
    a.c[1] = PlaneF(64, 64, 77.0f / 255);
    a.c[2] = PlaneF(64, 64, 2.0f);
    Rgb one = a, again = a, other = a;
    dither8(one, 5, {}), dither8(again, 5, {bestIsa(), Precision::oracle, false}), dither8(other, 6, {});
    double sum = 0;
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 64; x++) {
            const float code = one.c[0].at(x, y) * 255;
            EXPECT_TRUE(code == 76 || code == 77) << code;
            sum += double(code);
            EXPECT_EQ(one.c[1].at(x, y), 77.0f / 255) << "a whole code stays";
            EXPECT_EQ(one.c[2].at(x, y), 1.0f);
        }
    EXPECT_NEAR(sum / 4096, 76.5, 4 * 0.5 / 64);
    EXPECT_TRUE(one.c[0].samePixels(again.c[0])) << "the same in every run, precision and thread";
    EXPECT_FALSE(one.c[0].samePixels(other.c[0])) << "every frame has noise of its own";
}
}  // namespace
}  // namespace aa
