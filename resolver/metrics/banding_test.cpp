#include "metrics/banding.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aa {
namespace {
// codesPerPx along x; each channel somewhat higher than the one before.
Rgb gradient(double codesPerPx, int w = 160, int h = 90) {
    Rgb r(w, h);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) r.c[c].at(x, y) = float((100.3 + 7.1 * double(c) + codesPerPx * x) / 255);
    r.fillBorder();
    return r;
}
TEST(Banding, RoundingBandsAndDitherIsGrain) {
    const Rgb truth = gradient(0.04);  // steps of 25 px
    EXPECT_EQ(banding(truth, truth, {}).banding, 0);
    EXPECT_EQ(banding(truth, truth, {}).grain, 0);
    Rgb rounded = truth, dithered = truth;
    quantise8(rounded, {});
    dither8(dithered, 3, {});
    const Banding r = banding(rounded, truth, {}), d = banding(dithered, truth, {});
    // A saw of one code has an RMS of 1/sqrt(12); the blur keeps its first harmonics, exp(-2 (pi 4/25)^2) = 0.60.
    EXPECT_GT(r.banding, 0.6 * 0.22);
    EXPECT_LT(r.banding, std::sqrt(1.0 / 12));
    EXPECT_GT(r.grain, 0);  // the steps' corners
    EXPECT_LT(std::hypot(r.banding, r.grain), std::sqrt(1.0 / 12));
    // A coin of probability f has variance f (1 - f), 1/6 in the mean; the blur averages 4 pi 16 = 201 pixels.
    EXPECT_NEAR(d.grain, std::sqrt(1.0 / 6), 0.01);
    EXPECT_NEAR(d.banding, std::sqrt(1.0 / 6 / 201), 0.01);
    EXPECT_GT(d.share, 0.5);
}
TEST(Banding, OnlySlowGradientsCount) {
    for (const double slope : {0.0, 0.5}) {  // even; a step every other pixel
        const Rgb truth = gradient(slope);
        Rgb rounded = truth;
        quantise8(rounded, {});
        EXPECT_EQ(banding(rounded, truth, {}).share, 0) << slope;
        EXPECT_EQ(banding(rounded, truth, {}).banding, 0) << slope;
    }
    Rgb edge = gradient(0.04);
    for (auto& channel : edge.c)
        for (int y = 0; y < edge.height(); y++) channel.at(80, y) = 1;
    edge.fillBorder();
    // 25 columns around the edge fall out, and their error with them.
    const double all = banding(gradient(0.04), gradient(0.04), {}).share;
    EXPECT_NEAR(banding(gradient(0.04), edge, {}).share, all * (136.0 - 25) / 136, 1e-9);
    EXPECT_EQ(banding(gradient(0.04), edge, {}).banding, 0);
    EXPECT_EQ(banding(Rgb(20, 90, 0.5f), Rgb(20, 90, 0.5f), {}).share, 0) << "narrower than the window";
}
TEST(Banding, TheSameForAnyThreads) {
    const Rgb truth = gradient(0.1);
    Rgb rounded = truth;
    quantise8(rounded, {});
    const Banding many = banding(rounded, truth, {}), one = banding(rounded, truth, {.parallel = false});
    EXPECT_EQ(many.banding, one.banding);
    EXPECT_EQ(many.grain, one.grain);
}
}  // namespace
}  // namespace aa
