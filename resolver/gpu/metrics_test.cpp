#include "gpu/metrics.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "gpu/gpu_testing.h"
#include "metrics/flip.h"

using namespace aa;
using namespace aa::gpu;

namespace {

const std::set<std::string_view> kFigures = {"ssimLuma", "ssimRgb", "ssimMatlab3D", "flip"};
struct Size {
    int width, height;
};
// One pixel; less than every window; parts of every workgroup; whole workgroups.
constexpr Size kSizes[] = {{1, 1}, {7, 5}, {67, 43}, {64, 32}};

Rgb noise(Size size, unsigned seed, float low = 0, float high = 1) {
    std::mt19937 random(seed);
    Rgb image(size.width, size.height);
    for (auto& plane : image.c)
        for (int y = 0; y < size.height; y++)
            for (int x = 0; x < size.width; x++) plane.at(x, y) = low + (high - low) * float(random() >> 8) * 0x1p-24f;
    return image;
}
// Slow waves, and a little noise of `grain`: a picture and its anti-aliased form.
Rgb waves(Size size, unsigned seed, float grain) {
    Rgb image = noise(size, seed, -grain, grain);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < size.height; y++)
            for (int x = 0; x < size.width; x++)
                image.c[c].at(x, y) += 0.5f + 0.3f * std::sin(0.21f * float(x) + 0.13f * float(y) + float(c));
    return image;
}
struct Pair {
    const char* name;
    Rgb test, reference;
};
std::vector<Pair> pairs(Size size) {
    return {{"noise", noise(size, 1), noise(size, 2)},
            {"smooth", waves(size, 1, 0.01f), waves(size, 2, 0.02f)},
            {"flat", Rgb(size.width, size.height, 0.25f), Rgb(size.width, size.height, 0.75f)},
            {"beyond [0, 1]", noise(size, 1, -0.5f, 1.5f), noise(size, 2)}};
}
double measuredHere(std::string_view figure, const Rgb& test, const Rgb& reference, PlaneF& map) {
    if (figure == "flip") return flip(test, reference, {}, &map);
    if (figure == "ssimLuma") return ssimLuma(test, reference, {}, &map);
    return figure == "ssimRgb" ? ssimRgb(test, reference, {}, &map) : ssimMatlab3D(test, reference, {}, &map);
}
double largestDifference(const PlaneF& a, const PlaneF& b) {
    double largest = 0;
    for (int y = 0; y < a.height(); y++)
        for (int x = 0; x < a.width(); x++) {
            const double d = std::abs(double(a.at(x, y)) - double(b.at(x, y)));
            if (!(d <= largest)) largest = d;  // NaN, too
        }
    return largest;
}

class GpuMetrics : public DeviceTest {
  protected:
    void open() override { session = std::make_unique<Session>(Settings{.device = "vulkan"}); }
    std::unique_ptr<Session> session;
};

// Relative to 1 for SSIM, whose mean may be near 0.
TEST_F(GpuMetrics, AgreeWithTheProcessor) {
    constexpr double kFigure = 1e-5, kPixel = 2e-5;
    for (const Size size : kSizes) {
        Metrics metrics(*session, size.width, size.height);
        for (const Pair& p : pairs(size)) {
            SCOPED_TRACE(testing::Message() << p.name << " " << size.width << "x" << size.height);
            const Metrics::Result found = metrics.measure(p.test, p.reference, kFigures, true);
            const SquaredError squares = squaredError(p.test, p.reference, {});
            EXPECT_NEAR(found.squares.mse, squares.mse, kFigure * squares.mse);
            EXPECT_NEAR(found.squares.reference, squares.reference, kFigure * squares.reference);
            for (const std::string_view name : kFigures) {
                PlaneF map;
                const double expected = measuredHere(name, p.test, p.reference, map);
                const Metrics::Figure& figure = found.others.find(name)->second;
                EXPECT_NEAR(figure.mean, expected, kFigure * (name == "flip" ? expected : 1)) << name;
                ASSERT_EQ(figure.map.width(), size.width);
                ASSERT_EQ(figure.map.height(), size.height);
                EXPECT_LE(largestDifference(figure.map, map), kPixel) << name;
                EXPECT_EQ(figure.map.at(-1, -1), figure.map.at(0, 0));
            }
        }
    }
}
TEST_F(GpuMetrics, EqualPicturesAreExactlyEqual) {
    for (const Size size : kSizes) {
        Metrics metrics(*session, size.width, size.height);
        for (const Rgb& picture : {noise(size, 1), waves(size, 3, 0.02f), Rgb(size.width, size.height, 0.3f)}) {
            const Metrics::Result found = metrics.measure(picture, picture, kFigures);
            EXPECT_EQ(found.squares.mse, 0);
            for (const std::string_view name : kFigures)
                EXPECT_EQ(found.others.find(name)->second.mean, name == "flip" ? 0 : 1) << name;
        }
    }
}
// One changed pixel, wherever it lies, changes every figure; a figure asked for twice is the same.
TEST_F(GpuMetrics, AChangedPixelChangesEveryFigure) {
    const Size size{67, 43};
    const Rgb reference = waves(size, 1, 0.02f);
    Metrics metrics(*session, size.width, size.height);
    for (const auto& [x, y] : {std::pair{0, 0}, {66, 42}, {15, 16}, {40, 31}})
        for (size_t c = 0; c < 3; c++) {
            Rgb test = reference;
            test.c[c].at(x, y) += 0.1f;
            const Metrics::Result found = metrics.measure(test, reference, kFigures),
                                  again = metrics.measure(test, reference, kFigures);
            EXPECT_NEAR(found.squares.mse, 0.01 / (3 * 67 * 43), 1e-8);
            EXPECT_EQ(found.squares.mse, again.squares.mse);
            for (const auto& [name, figure] : found.others) {
                const bool isFlip = name == "flip";
                EXPECT_TRUE(isFlip ? figure.mean > 1e-6 : figure.mean < 1 - 1e-6) << name << " " << figure.mean;
                EXPECT_EQ(figure.mean, again.others.find(name)->second.mean) << name;
                EXPECT_TRUE(figure.map.empty());
            }
        }
}
TEST_F(GpuMetrics, OnlyWhatIsAskedForIsMeasured) {
    const Size size{7, 5};
    const Rgb test = noise(size, 1), reference = noise(size, 2);
    Metrics metrics(*session, size.width, size.height);
    EXPECT_TRUE(metrics.measure(test, reference, {}).others.empty());
    EXPECT_EQ(metrics.measure(test, reference, {"flip"}).others.size(), 1u);
    EXPECT_GT(metrics.measure(test, reference, {"flip"}).squares.mse, 0);
}
TEST_F(GpuMetrics, NoNumberInThePicture) {
    const Size size{20, 20};
    Rgb test = noise(size, 1);
    test.c[1].at(3, 4) = NAN, test.c[0].at(5, 6) = INFINITY;
    Metrics metrics(*session, size.width, size.height);
    const Metrics::Result found = metrics.measure(test, noise(size, 2), kFigures);
    EXPECT_TRUE(std::isnan(found.squares.mse));
    PlaneF map;
    const double expected = flip(test, noise(size, 2), {}, &map);  // NaN counts as 0, Inf as 1
    EXPECT_NEAR(found.others.find("flip")->second.mean, expected, 1e-5 * expected);
}

TEST(GpuMetricsNames, ThoseWithAShader) {
    for (const std::string_view name : kFigures) EXPECT_TRUE(Metrics::measures(name)) << name;
    for (const std::string_view name : {"mse", "relMse", "fmse", ""}) EXPECT_FALSE(Metrics::measures(name)) << name;
}
}  // namespace
