#include <gtest/gtest.h>

#include "methods/temporal/temporal_test_frames.h"

namespace aa {
namespace {
using namespace testing;

TEST(MotionBlur, SpreadsAPointAlongTheMotionOnly) {
    const int w = 41, h = 9;
    RunningMethod m = running("taaSimplest+motionBlur=1", w, h);
    const auto point = [](int x, int y, int) { return x == 20 && y == 4 ? 1.0f : 0.0f; };
    m.resolve(temporalFrame(0, w, h, point, {5, 0}), {}, {});
    // n = 5: the pixel itself and taps at 5 (i/4 - 1/2), i = 1..4: -1.25, 0, 1.25, 2.5.
    EXPECT_NEAR(m.out.c[0].at(20, 4), 2.0 / 5, 1e-6);
    EXPECT_NEAR(m.out.c[0].at(21, 4), 0.75 / 5, 1e-6);  // its tap at -1.25 lies 0.25 from the point
    EXPECT_NEAR(m.out.c[0].at(19, 4), 0.75 / 5, 1e-6);
    EXPECT_NEAR(m.out.c[0].at(17, 4), 0.5 / 5, 1e-6);
    EXPECT_EQ(m.out.c[0].at(20, 3), 0.0f);
    EXPECT_EQ(m.out.c[0].at(24, 4), 0.0f);
}
TEST(MotionBlur, RestAndBrokenMotionKeepThePixel) {
    for (const double v : {0.0, 1.9, double(NAN), double(INFINITY)}) {
        RunningMethod m = running("taaSimplest+motionBlur=1", 20, 8);
        const Frame f = temporalFrame(0, 20, 8, noisePicture(3), {v, 0});
        m.resolve(f, {}, {});
        EXPECT_TRUE(m.out.samePixels(f.colorLinear)) << v;
    }
}
// More than two pictures is how a motion that nobody knows is written (conventions 9): before it is scaled.
TEST(MotionBlur, MotionOfMoreThanTwoPicturesKeepsThePixel) {
    const auto keeps = [](const char* scale, glm::dvec2 motionPx) {
        RunningMethod m = running(std::string("taaSimplest+motionBlur=") + scale, 20, 8);
        const Frame f = temporalFrame(0, 20, 8, noisePicture(3), motionPx);
        m.resolve(f, {}, {});
        return m.out.samePixels(f.colorLinear);
    };
    for (const char* scale : {"1", "0.1"}) {
        EXPECT_TRUE(keeps(scale, {1e6, 1e6})) << scale;
        EXPECT_TRUE(keeps(scale, {-40.5, 0})) << scale;
        EXPECT_TRUE(keeps(scale, {30, 16.5})) << scale;
        EXPECT_FALSE(keeps(scale, {-40, 0})) << scale;
        EXPECT_FALSE(keeps(scale, {30, 16})) << scale;
    }
}
TEST(MotionBlur, APictureOfOnePixelKeepsIt) {  // half of it is shorter than one step
    RunningMethod m = running("taaSimplest+motionBlur=1", 1, 1);
    const Frame f = temporalFrame(0, 1, 1, noisePicture(3), {7, 0});
    m.resolve(f, {}, {});
    EXPECT_TRUE(m.out.samePixels(f.colorLinear));
}
}  // namespace
}  // namespace aa
