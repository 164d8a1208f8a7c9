// historyBits and dither (conventions 8): what narrow storage does to a history, and INSIDE's blur of the screen.
#include <gtest/gtest.h>

#include "methods/temporal/temporal_test_frames.h"

namespace aa {
namespace {
using namespace testing;

constexpr int kSize = 17, kMiddle = 8;

// Mean over the last frames of the middle pixel, whose value jumps from one display code to another and stays. Its
// neighbours span a wide colour box.
double settled(const std::string& method, float from, float to) {
    RunningMethod m = running(method, kSize, kSize, true);
    double sum = 0;
    for (int n = 0; n < 600; n++) {
        Frame f = temporalFrame(n, kSize, kSize, [&](int x, int y, int) {
            return x == kMiddle && y == kMiddle ? (n == 0 ? from : to) : float((x + y) % 2);
        });
        f.colorEncoded = f.colorLinear;
        m.resolve(f, {}, {});
        if (n >= 400) sum += double(m.out.c[1].at(kMiddle, kMiddle)) / 200;
    }
    return sum;
}

// The nearest binary16, of two the even one: multiples of 2^-24 and of 2^-11 of the octave.
float nearestHalf(float v) {
    const int unit = std::max(std::ilogb(v), -14) - 10;
    return std::min(std::ldexp(std::nearbyint(std::ldexp(v, -unit)), unit), 65504.0f);
}
TEST(HistoryStorage, HalfIsTheNearest) {
    RunningMethod m = running("taaSimplest:k=1,historyBits=16f", 1000, 1, true);
    const auto value = [](int x) {
        if (x < 4) return float(x + 1) * 3e4f;               // beyond 65504: the largest half
        if (x < 6) return float(1 + (1 + 2 * x) * 0x1p-11);  // between two: the even one
        return float(std::pow(10.0, -9 + 13.5 * x / 999.0) * (1 + 0.37 * (x % 7)));
    };
    for (int n = 0; n < 2; n++) m.resolve(temporalFrame(n, 1000, 1, [&](int x, int, int) { return value(x); }), {}, {});
    for (int x = 0; x < 1000; x++) EXPECT_EQ(m.out.c[0].at(x, 0), nearestHalf(value(x))) << value(x);
}
// (c - h) (1 - k) below half a step never reaches the stored value; chance carries it there in the mean.
TEST(HistoryStorage, NarrowHistoriesStallAndDitherFreesThem) {
    const std::string slow = "unchartedNoSharpen:kmin=0.97,kmax=0.97";
    const float from = 128.0f / 255, to = 136.0f / 255;  // eight codes: steps of 0.24 code
    EXPECT_NEAR(settled(slow, from, to), to, 1e-6);
    const double stalled = settled(slow + ",historyBits=8", from, to);
    EXPECT_NEAR(stalled, from + 0.03 * (to - from), 1e-6);
    EXPECT_NEAR(settled(slow + ",historyBits=8,dither=on", from, to), to,
                2.0 / 255);  // a random walk of about two codes
    // binary16 near 0.5: steps of 2^-11; a change of 1 % stalls.
    const float near = from * 1.01f;
    const double half = settled(slow + ",historyBits=16f", from, near);
    EXPECT_LT(half, from + 0.1f * (near - from));
    EXPECT_NEAR(settled(slow + ",historyBits=16f,dither=on", from, near), near, 1e-3);
}
TEST(HistoryStorage, DitherKeepsTheMean) {
    RunningMethod m = running("taaSimplest:k=1,historyBits=16f,dither=on", 256, 256, true);
    const float value = 0.3001f;  // between the halves 0.30005 and 0.30029
    for (int n = 0; n < 2; n++) m.resolve(temporalFrame(n, 256, 256, [&](int, int, int) { return value; }), {}, {});
    double mean = 0;
    for (int y = 0; y < 256; y++)
        for (int x = 0; x < 256; x++) mean += double(m.out.c[0].at(x, y)) / 65536;
    EXPECT_NEAR(mean, value, 2e-6);  // five standard deviations
}
// Every value is one of 256 codes, also where chance lifts white.
TEST(HistoryStorage, BytesAreCodes) {
    RunningMethod m = running("unchartedNoSharpen:kmin=1,kmax=1,historyBits=8,dither=on", 256, 64, true);
    for (int n = 0; n < 40; n++) {
        Frame f = temporalFrame(n, 256, 64, [](int x, int, int) { return float(x) / 255.0f; });
        f.colorEncoded = f.colorLinear;
        m.resolve(f, {}, {});
        for (int y = 0; y < 64; y++)
            for (int x = 0; x < 256; x++) {
                const float v = m.out.c[0].at(x, y);
                ASSERT_EQ(v, std::round(v * 255.0f) / 255.0f) << x << ' ' << y << ' ' << n;
                ASSERT_LE(v, 1.0f) << x << ' ' << y << ' ' << n;
            }
    }
}
TEST(HistoryStorage, EightBitsAreForEncodedColoursOnly) {
    EXPECT_THROW(running("salvi:historyBits=8", 8, 8), std::exception);
    EXPECT_NO_THROW(running("inside:historyBits=8", 8, 8));
}
TEST(Inside, MotionBlurReachesTheScreenAlone) {
    RunningMethod sharp = running("inside", 64, 16), blurred = running("inside:motionBlur=1", 64, 16);
    const auto differs = [&](int n, double speedPx) {
        Frame f = temporalFrame(n, 64, 16, noisePicture(unsigned(n)), {speedPx, 0});
        sharp.resolve(f, {}, {}), blurred.resolve(f, {}, {});
        double largest = 0;
        for (int x = 0; x < 64; x++)
            largest = std::max(largest, std::abs(double(sharp.out.c[0].at(x, 8)) - double(blurred.out.c[0].at(x, 8))));
        return largest;
    };
    EXPECT_EQ(differs(0, 0), 0);
    EXPECT_GT(differs(1, 12), 0.1);
    EXPECT_EQ(differs(2, 2), 0);  // slow enough to trust; and the history was never blurred
}
// At 15 px and beyond the screen shows the seven taps alone: a step becomes a ramp as wide as the motion.
TEST(Inside, MotionBlurIsAsLongAsTheMotion) {
    RunningMethod m = running("inside:motionBlur=1", 96, 64);
    for (int n = 0; n < 2; n++)
        m.resolve(temporalFrame(n, 96, 64, [](int x, int, int) { return x < 48 ? 0.0f : 1.0f; }, {20, 0}), {}, {});
    std::vector<double> column(96);
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 96; x++) column[size_t(x)] += double(m.out.c[0].at(x, y)) / 64;
    EXPECT_NEAR(column[48 - 13], 0, 1e-6);  // half the motion, and half a step of chance: 11.67 px on either side
    EXPECT_NEAR(column[48 + 12], 1, 1e-6);
    for (int x = 36; x < 60; x++) EXPECT_NEAR(column[size_t(x)], (double(x) + 0.5 - 36.3) / 23.3, 0.09) << x;
}
}  // namespace
}  // namespace aa
