#include "methods/temporal/karis.h"

#include <gtest/gtest.h>

#include "methods/method.h"

#define AA_ARCH block_test
#define AA_LANES 4
#include "kernels/pq.h"
#undef AA_ARCH

#include "methods/temporal/temporal_test_frames.h"

namespace aa {
namespace {
using namespace testing;

TEST(Pq, PartsAgreeWithLibm) {
    for (double u = -0.5; u <= 0.5; u += 0.01) EXPECT_NEAR(block_test::expm1Small(u), std::expm1(u), 2e-16);
    for (double t = -0.17; t <= 0.17; t += 0.01)
        EXPECT_NEAR(block_test::log2OfRatio(t), std::log2((1 + t) / (1 - t)), 1e-15);
    // ST 2084: 100 units encode to 0.508078.
    EXPECT_NEAR(block_test::pqEncode(100.0), 0.508078, 1e-6);
    EXPECT_NEAR(block_test::pqEncode(10000.0), 1.0, 1e-12);
}

TEST(Pq, TablesAgreeWithTheCurve) {
    static PqTables tables;
    block_test::fillTables(tables);
    double encoded = 0, decoded = 0;
    for (int i = 0; i <= 100000; i++) {
        const float linear = float(std::pow(10.0, -12 + 16.0 * i / 100000));
        const float e = block_test::pqEncode(tables, linear), back = block_test::pqDecode(tables, e);
        encoded = std::max(encoded, std::abs(double(e) - block_test::pqEncode(double(linear))));
        const double exact = block_test::pqDecode(double(e));
        decoded = std::max(decoded, std::abs(double(back) - exact) / exact);
    }
    EXPECT_LT(encoded, 1.2e-7);
    EXPECT_LT(decoded, 2e-7);
    for (float e = 0; e < 1e-6f; e = std::nextafter(e, 1.0f), e += e < 6e-7f ? 1e-9f : 0.0f)
        EXPECT_GE(block_test::pqDecode(tables, e), 0.0f) << e;
    for (const float dark : {0.0f, -1.0f, 1e-30f, NAN, -INFINITY})
        EXPECT_EQ(block_test::pqDecode(tables, block_test::pqEncode(tables, dark)), 0.0f) << dark;
    for (const float bright : {1e4f, 1e6f, INFINITY})
        EXPECT_EQ(block_test::pqDecode(tables, block_test::pqEncode(tables, bright)), 1e4f) << bright;
}
// A linear value through donut: first frame encodes and decodes only.
TEST(Donut, PqIsItsOwnInverse) {
    RunningMethod m = running("donut", 64, 1);
    const Frame f =
        temporalFrame(0, 64, 1, [](int x, int, int) { return x == 0 ? 0.0f : float(std::pow(10.0, -4 + x / 8.0)); });
    m.resolve(f, {}, {});
    for (int x = 0; x < 64; x++) {
        const double v = double(f.colorLinear.c[0].at(x, 0));
        if (v <= 1e4) {
            EXPECT_NEAR(m.out.c[0].at(x, 0), v, 4e-6 * v + 1e-7) << v;
        }
    }
}

// Static noise: the constrained history of every preset holds less noise than the input, and does not drift.
TEST(Karis, EveryPresetReducesNoiseWithoutDrift) {
    for (const char* id : {"karis", "salvi", "falcor", "donut"}) {
        RunningMethod m = running(id, 48, 32, true);
        double inVariance = 0, outVariance = 0, mean = 0, count = 0;
        for (int n = 0; n < 60; n++) {
            const Frame f = temporalFrame(n, 48, 32, noisePicture(unsigned(n)));
            m.resolve(f, {}, {});
            if (n < 30) continue;
            for (int y = 0; y < 32; y++)
                for (int x = 0; x < 48; x++) {
                    const double a = double(f.colorLinear.c[1].at(x, y)) - 0.5, b = double(m.out.c[1].at(x, y)) - 0.5;
                    inVariance += a * a, outVariance += b * b, mean += b, count++;
                }
        }
        EXPECT_LT(outVariance, 0.5 * inVariance) << id;
        EXPECT_NEAR(mean / count, 0, 0.12) << id;  // tone weights favour the dark
    }
}
TEST(Karis, FilterWeightsAreTheStatedOnes) {
    // One bright sample beside the pixel, jitter 0: weight exp(-2.29) against 1 + 4 exp(-2.29) + 4 exp(-4.58).
    RunningMethod m = running("karis:toneWeight=none,alpha=1,antiFlicker=none", 9, 9);
    m.resolve(temporalFrame(0, 9, 9, [](int, int, int) { return 0.0f; }), {}, {});
    m.resolve(temporalFrame(1, 9, 9, [](int x, int y, int) { return x == 5 && y == 4 ? 1.0f : 0.0f; }), {}, {});
    const double w1 = std::exp(-2.29), w2 = std::exp(-4.58);
    EXPECT_NEAR(m.out.c[0].at(4, 4), w1 / (1 + 4 * w1 + 4 * w2), 1e-6);
    EXPECT_NEAR(m.out.c[0].at(4, 3), w2 / (1 + 4 * w1 + 4 * w2), 1e-6);
    // conventions 15: at distances of 1/2, 1 and 1.414 px.
    EXPECT_NEAR(std::exp(-2.29 * 0.25), 0.5641, 1e-4);
    EXPECT_NEAR(w1, 0.10127, 1e-5);
    EXPECT_NEAR(w2, 0.010255, 1e-5);
    // Jitter moves the samples: with (1/2, 0) the pixel and its left neighbour lie equally far, at exp(-2.29 / 4).
    RunningMethod moved = running("karis:toneWeight=none,alpha=1,antiFlicker=none", 9, 9);
    moved.resolve(temporalFrame(0, 9, 9, [](int, int, int) { return 0.0f; }), {}, {});
    Frame f = temporalFrame(1, 9, 9, [](int x, int y, int) { return x == 3 && y == 4 ? 1.0f : 0.0f; });
    f.jitterPx = {0.5, 0};
    moved.resolve(f, {}, {});
    double all = 0;
    for (int j = -1; j <= 1; j++)
        for (int i = -1; i <= 1; i++) all += std::exp(-2.29 * ((i + 0.5) * (i + 0.5) + j * j));
    EXPECT_NEAR(moved.out.c[0].at(4, 4), 0.5641 / all, 1e-4);
}

// constraint=clipMean: toward the mean of the nine also where the box is one of bounds.
TEST(Karis, BoundsAreClippedTowardTheMean) {
    const int w = 18, h = 9;
    RunningMethod m = running("salvi:box=minmax,neighbourhood=3x3,filter=none,inverseLuminance=off,alpha=0", w, h);
    const double past[3] = {1.5, -0.0, 0.4};
    m.resolve(temporalFrame(0, w, h, [&](int, int, int c) { return float(past[c]); }), {}, {});
    const Frame f = temporalFrame(1, w, h, noisePicture(5));
    m.resolve(f, {}, {});
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            double mean[3] = {}, share = 1;
            for (size_t c = 0; c < 3; c++) {
                double lo = 9, hi = -9;
                for (int k = 0; k < 9; k++) {
                    const double v = double(f.colorLinear.c[c].clamped(x + k % 3 - 1, y + k / 3 - 1));
                    mean[c] += v / 9, lo = std::min(lo, v), hi = std::max(hi, v);
                }
                if (past[c] > hi) share = std::min(share, (hi - mean[c]) / (past[c] - mean[c]));
                if (past[c] < lo) share = std::min(share, (lo - mean[c]) / (past[c] - mean[c]));
            }
            for (size_t c = 0; c < 3; c++)
                ASSERT_NEAR(m.out.c[c].at(x, y), mean[c] + share * (past[c] - mean[c]), 1e-6) << x << " " << y;
        }
}

TEST(Raptor, PrintedWeightsIgnoreHistoryWhereColoursAgree) {
    // Slowly brightening flat image: corrected keeps 0.97 of the history, printed takes the current colour.
    const auto level = [](const char* text) {
        RunningMethod m = running(text, 8, 8, true);
        for (int n = 0; n < 2; n++)
            m.resolve(
                temporalFrame(
                    n, 8, 8, [&](int x, int y, int) { return 0.5f + (n ? 0.01f : 0.0f) + 0.05f * float((x + y) % 2); }),
                {}, {});
        return m.out.c[0].at(4, 4);
    };
    const float corrected = level("raptor:sharpen=0,lumaDiffWeights=off,currentFilter=none,constraint=none");
    const float printed =
        level("raptor:sharpen=0,lumaDiffWeights=off,currentFilter=none,constraint=none,lumaDiff=printed");
    EXPECT_NEAR(corrected, 0.5 + 0.01 * 0.0318, 2e-4);  // 1 - k, k close to 0.97
    EXPECT_NEAR(printed, 0.51, 5e-4);
}
TEST(Raptor, PrintedMitchellIsTheCentrePixel) {
    RunningMethod printed = running(
                      "raptor:sharpen=0,filterDomain=printed,lumaDiff=off,temporalFiltering=off,inverseLuminance=off,"
                      "constraint=clamp",
                      16, 16),
                  none = running(
                      "raptor:sharpen=0,currentFilter=none,lumaDiff=off,temporalFiltering=off,inverseLuminance=off,"
                      "constraint=clamp",
                      16, 16);
    for (int n = 0; n < 3; n++) {
        const Frame f = temporalFrame(n, 16, 16, noisePicture(unsigned(n)));
        printed.resolve(f, {}, {});
        none.resolve(f, {}, {});
    }
    EXPECT_TRUE(printed.out.samePixels(none.out));
}
TEST(Raptor, LuminanceSharpening) {
    RunningMethod m = running("raptor", 9, 9);
    m.resolve(
        temporalFrame(0, 9, 9, [](int x, int y, int c) { return x == 4 && y == 4 ? (c == 0 ? 0.9f : 0.3f) : 0.3f; }),
        {}, {});
    const double L = 0.2126 * 0.9 + 0.7874 * 0.3, mean = (L + 8 * 0.3) / 9, scale = (L + (L - mean)) / L;
    EXPECT_NEAR(m.out.c[0].at(4, 4), 0.9 * scale, 1e-6);
    EXPECT_NEAR(m.out.c[1].at(4, 4), 0.3 * scale, 1e-6);
    EXPECT_NEAR(m.out.c[1].at(0, 0), 0.3, 1e-7);
}

TEST(Inside, UnjitteringShiftsTheColourBack) {
    // A ramp sampled at centre + jitter; un-jittered it is the ramp at the centre.
    RunningMethod m = running("inside:kmin=0,kmax=0", 20, 8);
    for (int n = 0; n < 2; n++) {
        Frame f = temporalFrame(n, 20, 8, [](int, int, int) { return 0.0f; });
        f.jitterPx = {0.25, -0.375};
        for (auto& p : f.colorEncoded.c) {
            for (int y = 0; y < 8; y++)
                for (int x = 0; x < 20; x++) p.at(x, y) = float(0.02 * (x + 0.25) + 0.05 * (y - 0.375));
            p.fillBorder();
        }
        m.resolve(f, {}, {});
        EXPECT_NEAR(m.out.c[0].at(10, 4), 0.02 * 10 + 0.05 * 4, 1e-6) << n;  // after a reset, too
    }
}

}  // namespace
}  // namespace aa
