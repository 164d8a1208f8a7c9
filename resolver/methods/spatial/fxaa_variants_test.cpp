#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

#include "image/error.h"
#include "methods/spatial/fxaa.h"
#include "methods/spatial/spatial_testing.h"
#include "methods/spec.h"

namespace aa {
namespace {
using namespace aa::testing;

const int kX[] = {12, 16, 20, 24, 28, 30, 31, 32, 33, 35, 39, 44};
void expectRow4(const std::string& spec, const std::array<double, 12>& row) {
    const Rgb out = resolveOnce(spec, stepImage());
    for (size_t i = 0; i < 12; i++) EXPECT_NEAR(out.c[1].at(kX[i], 4), row[i], 6e-5) << spec << " x " << kX[i];
}

TEST(Fxaa1, StepVectors) {
    expectRow4("fxaa1:preset=3", {0, .0152, .0862, .1800, .3095, .3947, .4444, .5556, .6053, .6905, .8200, .9333});
    expectRow4("fxaa1:preset=5", {.1226, .1735, .2333, .3049, .3919, .4429, .4619, .5381, .5571, .6081, .6951, .7826});
    for (const char* spec : {"fxaa1:preset=3", "fxaa1:preset=5"})
        for (int x : {24, 30, 31}) EXPECT_NEAR(resolveOnce(spec, stepImage()).c[0].at(x, 3), 1, 6e-5) << spec << x;
}
TEST(Fxaa1, AcceleratedPresetsReachAsFar) {
    // Steps x pixels per read: 2 x 4, 4 x 3, 8 x 2, 16 x 1 pixels, so the blend starts that far before the step.
    const int reachPx[] = {8, 12, 16, 16};
    for (int preset = 0; preset < 4; preset++) {
        const Rgb out = resolveOnce("fxaa1:preset=" + std::to_string(preset), stepImage());
        int first = 0;
        while (out.c[0].at(first, 4) == 0.0f) first++;
        EXPECT_GE(first, 32 - reachPx[preset] - 5) << preset;
        EXPECT_LE(first, 32 - reachPx[preset] + 5) << preset;
    }
}
TEST(Fxaa1, LowPassRemovesSinglePixels) {
    Rgb image(9, 9, 0.0f);
    for (auto& p : image.c) p.at(4, 4) = 1.0f;
    // range 1, |mean of the cross - centre| = 1: blend = cap = 3/4 of the 3x3 mean 1/9, the rest shifted by nothing.
    const Rgb out = resolveOnce("fxaa1:preset=3", image);
    EXPECT_NEAR(out.c[0].at(4, 4), 0.75 / 9 + 0.25, 1e-6);
    const Rgb fast = resolveOnce("fxaa1:preset=0", image);  // 2/3 of the mean of five
    EXPECT_NEAR(fast.c[0].at(4, 4), 2.0 / 3 / 5 + 1.0 / 3, 1e-6);
}

TEST(FxaaCs, StepVector) {
    expectRow4("fxaacs", {.0315, .0315, .1081, .2258, .3333, .4000, .4574, .5426, .6000, .6667, .7742, .8919});
    const Rgb out = resolveOnce("fxaacs", stepImage());
    EXPECT_NEAR(out.c[2].at(24, 3), .9685, 6e-5);
    EXPECT_NEAR(out.c[2].at(30, 3), .9685, 6e-5);
    EXPECT_NEAR(out.c[2].at(31, 3), .9882, 6e-5);
}
TEST(FxaaCs, DirectionTiesGoToThePositiveSide) {
    Rgb image(9, 9, 0.0f);  // a line one pixel thin: both sides alike
    for (auto& p : image.c)
        for (int x = 0; x < 9; x++) p.at(x, 4) = x < 7 ? 0.9f : 0.1f;
    for (auto& p : image.c)
        for (int x = 0; x < 9; x++) p.at(x, 5) = 0.0f, p.at(x, 3) = 0.0f;
    Frame f = frameOf(image);
    const auto cs = resolveOnce("fxaacs:blendSpace=encoded,subpixelRemoval=1", f);
    EXPECT_LT(cs.c[0].at(3, 4), 0.9f);
    EXPECT_THROW(parseMethod("fxaacs:longest=36.5"), UsageError);
    EXPECT_NO_THROW(parseMethod("fxaacs:preset=39,longest=36.5"));
}

TEST(FxaaConsole, BlursAlongTheEdgeOnly) {
    // A clean horizontal edge: the taps run along it. The bias of one corner tilts the outer pair by 2 * (1/8) px, of
    // which one tap of four crosses the edge: 1/16.
    Rgb image(20, 20, 0.0f);
    for (auto& p : image.c)
        for (int y = 0; y < 10; y++)
            for (int x = 0; x < 20; x++) p.at(x, y) = 1.0f;
    const Rgb out = resolveOnce("fxaaconsole", image);
    for (int y = 0; y < 20; y++)
        EXPECT_NEAR(out.c[0].at(10, y), y == 9 ? 0.9375 : y < 10 ? 1 : y == 10 ? 0.0625 : 0, 0.002) << y;
    // A diagonal staircase becomes smoother: neighbours along the edge are averaged.
    for (auto& p : image.c)
        for (int y = 0; y < 20; y++)
            for (int x = 0; x < 20; x++) p.at(x, y) = x + y < 20 ? 1.0f : 0.0f;
    const Rgb diagonal = resolveOnce("fxaaconsole", image);
    EXPECT_LT(diagonal.c[0].at(9, 10), 0.9f);
    EXPECT_GT(diagonal.c[0].at(10, 10), 0.1f);
    // d1 = (1, -1)/sqrt(2), half a pixel: each tap is bilinear at +-.3536 px across the stair.
    EXPECT_NEAR(diagonal.c[0].at(9, 10) + diagonal.c[0].at(10, 10), 1.0f, 0.02f);
}
// A line one pixel thin, dark alike above and below, that ends at x = 20 where one side turns bright: that side's pair
// shows no end, the other's does. Ties of the two gradients go up in 3.11 and 1, down in CS.
TEST(FxaaFamily, TiesOfTheTwoSidesGoWhereTheVariantSays) {
    for (const bool brightBelow : {false, true}) {
        Rgb image(48, 15, 0.0f);
        for (auto& p : image.c)
            for (int x = 0; x < 48; x++) p.at(x, x < 20 ? 7 : brightBelow ? 8 : 6) = 1.0f;
        const auto shifted = [&](const char* spec) { return resolveOnce(spec, image).c[1].at(17, 7) < 0.99f; };
        EXPECT_EQ(shifted("fxaa311:subpix=0,preset=39"), brightBelow);
        EXPECT_EQ(shifted("fxaacs:subpixelRemoval=0,blendSpace=encoded"), !brightBelow);
    }
}
TEST(FxaaCs, RefusesAThresholdOfZero) {
    EXPECT_THROW(parseMethod("fxaacs:contrastThreshold=0"), UsageError);
    EXPECT_NO_THROW(parseMethod("fxaacs:contrastThreshold=0.01"));
}
// [Lottes 2011], console path, written a second time: per pixel, in double, with clamped bilinear reads.
TEST(FxaaConsole, ConformsToASecondForm) {
    using C = std::array<double, 4>;  // RGB and luma
    for (const auto& [spec, reach, sharpness] :
         {std::tuple{"fxaaconsole", 0.5, 8.0}, {"fxaaconsole:reach=0.33,sharpness=4", 0.33, 4.0}})
        for (const Rgb& image : {randomShapes(97, 61, 7), randomCodes(40, 33, 11), stepImage()}) {
            const auto at = [&image](int x, int y) {
                C c{};
                for (size_t k = 0; k < 3; k++) c[k] = image.c[k].clamped(x, y);
                c[3] = 0.299 * c[0] + 0.587 * c[1] + 0.114 * c[2];
                return c;
            };
            const auto tap = [&](double x, double y) {
                const double ax = std::floor(x), ay = std::floor(y), fx = x - ax, fy = y - ay;
                C sum{};
                for (int j = 0; j < 2; j++)
                    for (int i = 0; i < 2; i++) {
                        const C c = at(int(ax) + i, int(ay) + j);
                        for (size_t k = 0; k < 4; k++) sum[k] += (i ? fx : 1 - fx) * (j ? fy : 1 - fy) * c[k];
                    }
                return sum;
            };
            const auto mean = [](const C& a, const C& b) {
                C m;
                for (size_t k = 0; k < 4; k++) m[k] = (a[k] + b[k]) / 2;
                return m;
            };
            const Rgb out = resolveOnce(spec, image);
            int narrow = 0, wide = 0, ties = 0;
            for (int y = 0; y < image.height(); y++)
                for (int x = 0; x < image.width(); x++) {
                    const double nw = tap(x - .5, y - .5)[3], ne = tap(x + .5, y - .5)[3] + 1.0 / 384,
                                 sw = tap(x - .5, y + .5)[3], se = tap(x + .5, y + .5)[3], m = at(x, y)[3];
                    const double most = std::max({nw, ne, sw, se}), least = std::min({nw, ne, sw, se});
                    const double over = std::max(most, m) - std::min(least, m) - std::max(0.05, most * 0.125);
                    double dx = (sw - ne) + (se - nw), dy = (sw - ne) - (se - nw);
                    const double length = std::hypot(dx, dy);
                    C expected = at(x, y);
                    bool tie = std::abs(over) < 1e-6;
                    if (over >= 0) {
                        dx /= length, dy /= length;
                        const double smallest = sharpness * std::min(std::abs(dx), std::abs(dy));
                        const double fx = std::clamp(dx / smallest, -2.0, 2.0),
                                     fy = std::clamp(dy / smallest, -2.0, 2.0);
                        const C a = mean(tap(x - reach * dx, y - reach * dy), tap(x + reach * dx, y + reach * dy));
                        const C b = mean(a, mean(tap(x - 2 * fx, y - 2 * fy), tap(x + 2 * fx, y + 2 * fy)));
                        const bool kept = b[3] >= least && b[3] <= most;
                        expected = kept ? b : a;
                        (kept ? wide : narrow)++;
                        // Rounding of a luma turns a short direction or moves a bound.
                        tie = tie || length < 1e-3 || std::min(std::abs(b[3] - least), std::abs(b[3] - most)) < 1e-5;
                    }
                    ties += tie;
                    for (size_t c = 0; c < 3 && !tie; c++)
                        ASSERT_NEAR(out.c[c].at(x, y), expected[c], 1e-3 * (over >= 0)) << spec << x << "," << y;
                }
            EXPECT_GT(wide, 30) << spec;
            EXPECT_LT(ties, 0.03 * image.width() * image.height()) << spec;
            if (image.width() != 64) {
                EXPECT_GT(narrow, 30) << spec;
            }
        }
}

}  // namespace
}  // namespace aa
