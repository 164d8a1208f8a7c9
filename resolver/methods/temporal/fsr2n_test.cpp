#include "methods/temporal/fsr2n.h"

#include <gtest/gtest.h>

#include "methods/method.h"
#include "methods/temporal/temporal_test_frames.h"

namespace aa {
namespace {
using namespace testing;

const DebugLayer& layer(const std::vector<DebugLayer>& layers, const std::string& name) {
    for (const auto& l : layers)
        if (l.name == name) return l;
    throw std::runtime_error("no layer " + name);
}

// A near square, 8 px wide, moves right by 4 px a frame before a wall at rest.
struct Square {
    static constexpr int kW = 48, kH = 24;
    int left(int n) const { return 6 + 4 * n; }
    bool covers(int x, int n) const { return x >= left(n) && x < left(n) + 8; }
    Frame frame(int n, float wallDepth = 10) const {
        Frame f = temporalFrame(n, kW, kH, [&](int x, int, int) { return covers(x, n) ? 0.9f : 0.1f; });
        f.depthView = PlaneF(kW, kH, wallDepth);
        for (int y = 0; y < kH; y++)
            for (int x = 0; x < kW; x++)
                if (covers(x, n)) f.depthView.at(x, y) = 2, f.motionXPx.at(x, y) = 4;
        f.depthView.fillBorder(), f.motionXPx.fillBorder();
        return f;
    }
};

TEST(Fsr2n, WhatWasHiddenIsDepthClippedAndTakenAfresh) {
    const Square square;
    RunningMethod m = running("fsr2n", Square::kW, Square::kH);
    m.method->keepDebugLayers = true;
    for (int n = 0; n < 4; n++) m.resolve(square.frame(n), {}, {});
    const auto layers = m.method->debugLayers();
    const PlaneF &clip = layer(layers, "depthClip").planes[0], &rejection = layer(layers, "rejection").planes[0];
    // In the last frame the square uncovered left(2) .. left(3) - 1; its rim takes the square's motion.
    for (int x = square.left(2) + 1; x < square.left(3) - 1; x++) {
        EXPECT_GT(clip.at(x, 12), 0.9f) << x;
        EXPECT_EQ(rejection.at(x, 12), 2.0f) << x;
        EXPECT_NEAR(m.out.c[0].at(x, 12), 0.1, 1e-3) << x;
    }
    EXPECT_EQ(clip.at(square.left(3) + 4, 12), 0.0f) << "the square itself was seen before";
    EXPECT_EQ(clip.at(40, 12), 0.0f) << "and so was the wall elsewhere";
}
// The separation that counts grows with depth: a step of one part in a thousand is less than depth can tell.
TEST(Fsr2n, DepthNoiseIsNotClipped) {
    RunningMethod m = running("fsr2n", 40, 24);
    m.method->keepDebugLayers = true;
    for (int n = 0; n < 3; n++) {
        Frame f = temporalFrame(n, 40, 24, noisePicture(1));
        for (int y = 0; y < 24; y++)
            for (int x = 0; x < 40; x++) f.depthView.at(x, y) = 50 * (1 + 1e-5f * float((x * 7 + y * 3) % 5));
        f.depthView.fillBorder();
        m.resolve(f, {}, {});
    }
    const PlaneF clip = layer(m.method->debugLayers(), "depthClip").planes[0];
    for (int y = 0; y < 24; y++)
        for (int x = 0; x < 40; x++) ASSERT_LT(clip.at(x, y), 0.05f) << x << "," << y;
}

// A thin line that the jitter hits every fourth frame only: locked, it shines steadily; the colour box alone lifts the
// history when the line is there and cuts it to the wall's colour in between.
TEST(Fsr2n, LocksKeepAThinLineThatIsSeldomSampled) {
    struct Level {
        double mean = 0, swing = 0;
    };
    const auto level = [](const char* text) {
        RunningMethod m = running(text, 32, 16, true);
        float low = 1, high = 0;
        Level r;
        for (int n = 0; n < 48; n++) {
            const auto line = [n](int x, int, int) { return x == 15 && n % 4 == 0 ? 0.5f : 0.4f; };
            m.resolve(temporalFrame(n, 32, 16, line), {}, {});
            if (n < 32) continue;
            const float v = m.out.c[1].at(15, 8);
            low = std::min(low, v), high = std::max(high, v), r.mean += double(v - 0.4f) / 16;
        }
        r.swing = double(high - low);
        return r;
    };
    const Level locked = level("fsr2n"), open = level("fsr2n:locks=off");
    EXPECT_LT(locked.swing, open.swing / 4);
    EXPECT_GE(locked.mean, open.mean);
}

// Encoded step between two flat fields with the mean of both tone-mapped: against the definition, in double.
TEST(Fsr2n, BlendIsTheToneMappedMean) {
    RunningMethod m = running("fsr2n:weight=1", 9, 9, true);
    const float first[3] = {0.2f, 3.0f, 0.05f}, second[3] = {0.25f, 2.0f, 0.06f};
    const auto flat = [](const float(&c)[3]) { return [&c](int, int, int k) { return c[k]; }; };
    m.resolve(temporalFrame(0, 9, 9, flat(first)), {}, {});
    m.resolve(temporalFrame(1, 9, 9, flat(second)), {}, {});
    // The box of a flat window is its colour: the history becomes `second`, whatever the weights.
    for (size_t c = 0; c < 3; c++) EXPECT_NEAR(m.out.c[c].at(4, 4), second[c], 1e-6);
    // A dot beside the pixel opens the box.
    RunningMethod open = running("fsr2n:weight=1,boxScale=20", 9, 9, true);
    open.resolve(temporalFrame(0, 9, 9, [](int, int, int) { return 1.0f; }), {}, {});
    open.resolve(temporalFrame(1, 9, 9, [](int x, int y, int) { return (x + y) % 2 ? 3.0f : 0.5f; }), {}, {});
    // weight 1 against 1: alpha = 1/2, of h = 1 (inside the box) and c = the Lanczos mean, which at jitter 0 is the
    // pixel.
    const double h = 1 / 2.0, c = 0.5 / 1.5, mean = (h + c) / 2;
    EXPECT_NEAR(open.out.c[0].at(4, 4), mean / (1 - mean), 1e-5);
}

TEST(Fsr2n, ScatterDoesNotDependOnThreads) {
    const Square square;
    std::vector<Rgb> outputs;
    for (const bool parallel : {false, true, true, true}) {
        RunningMethod m = running("fsr2n", Square::kW, Square::kH);
        for (int n = 0; n < 4; n++) m.resolve(square.frame(n), {}, {.parallel = parallel});
        outputs.push_back(m.out);
    }
    for (const auto& o : outputs) EXPECT_TRUE(o.samePixels(outputs[0]));
}

// The tone-mapped space ends at 1: float keeps to double up to the end of FSR 2's range, and beyond both stay there.
TEST(Fsr2n, LightEndsAtTheRangeOfHalfFloats) {
    for (const float scale : {1.0f, 6e4f, 1e6f, 1e12f, 1e17f}) {
        RunningMethod lanes = running("fsr2n", 24, 16), oracle = running("fsr2n", 24, 16);
        double worst = 0, most = 0;
        for (int n = 0; n < 4; n++) {
            const Picture noise = noisePicture(unsigned(n));
            const Frame f = temporalFrame(
                n, 24, 16, [&](int x, int y, int c) { return scale * (0.01f + noise(x, y, c)); }, {0.3, 0.2});
            lanes.resolve(f, {}, {}), oracle.resolve(f, {}, {.precision = Precision::oracle});
            for (size_t c = 0; c < 3; c++)
                for (int y = 0; y < 16; y++)
                    for (int x = 0; x < 24; x++) {
                        const double d = double(oracle.out.c[c].at(x, y));
                        worst = std::max(worst, std::abs(double(lanes.out.c[c].at(x, y)) - d));
                        most = std::max(most, d);
                    }
        }
        EXPECT_LT(worst / most, scale == 1 ? 1e-5 : 2e-2) << scale;
        EXPECT_LE(most, 65504 * 1.1) << scale;  // the mean in that space overshoots
    }
}

}  // namespace
}  // namespace aa
