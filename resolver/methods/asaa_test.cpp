#include "methods/asaa.h"

#include <gtest/gtest.h>

#include "methods/temporal_test_frames.h"

namespace aa {
namespace {
using namespace testing;

const glm::dvec2 kQuadrants[4] = {{-.25, -.25}, {-.25, .25}, {.25, -.25}, {.25, .25}};

// Encoded values are linear in position, so that every filter centred on the pixel gives the value at its centre.
Frame rampFrame(int n, glm::dvec2 cameraPx = {0, 0}, glm::dvec2 motionPx = {0, 0}) {
    Frame f = temporalFrame(
        n, 30, 20, [](int, int, int) { return 0.0f; }, motionPx);
    f.jitterPx = kQuadrants[n % 4];
    for (auto& p : f.colorEncoded.c) {
        for (int y = 0; y < 20; y++)
            for (int x = 0; x < 30; x++)
                p.at(x, y) =
                    float(0.3 + 0.01 * (x + f.jitterPx.x - cameraPx.x) + 0.008 * (y + f.jitterPx.y - cameraPx.y));
        p.fillBorder();
    }
    return f;
}

TEST(Asaa, JitterSignsAgreeWithTheBuffers) {
    // After a full round the four quadrants cancel: the ramp at the pixel centre. A flipped sign would leave 0.0025.
    RunningMethod m = running("asaa", 30, 20, true);
    for (int n = 0; n < 40; n++) m.resolve(rampFrame(n), {}, {});
    for (int x = 5; x < 25; x++) EXPECT_NEAR(m.out.c[0].at(x, 10), 0.3 + 0.01 * x + 0.008 * 10, 2e-4) << x;
}
TEST(Asaa, BuffersFollowTheMotion) {
    RunningMethod m = running("asaa", 30, 20);
    const glm::dvec2 v(0.4, -0.3);
    for (int n = 0; n < 24; n++) m.resolve(rampFrame(n, v * double(n), v), {}, {});
    // alpha = 1/5 of the current sample, a quarter of it in the frame: its jitter error is 0.05 * 0.0045 at most. The
    // normalised tent weights are not exact for a ramp; together they stay below a tenth of a pixel of its slope.
    for (int x = 14; x < 22; x++)  // farther left the history entered through the border
        EXPECT_NEAR(m.out.c[0].at(x, 10), 0.3 + 0.01 * (x - 0.4 * 23) + 0.008 * (10 + 0.3 * 23), 1e-3) << x;
    RunningMethod flipped = running("asaa", 30, 20);
    for (int n = 0; n < 24; n++) flipped.resolve(rampFrame(n, v * double(n), -v), {}, {});
    EXPECT_GT(std::fabs(flipped.out.c[0].at(15, 10) - m.out.c[0].at(15, 10)), 5e-3f);
}
// Static, one quadrant per frame: the weights of methods/06 s.6.8, (.75, .25) squared, of every buffer alike.
TEST(Asaa, OutputIsATentOfOnePixelRadius) {
    RunningMethod m = running("asaa", 30, 20, true);
    Frame f;
    for (int n = 0; n < 400; n++) {
        f = temporalFrame(n, 30, 20, [](int, int, int) { return 0.0f; });
        f.jitterPx = kQuadrants[n % 4];
        if (n % 4 == 3)
            for (auto& p : f.colorEncoded.c) p.at(15, 10) = 1, p.fillBorder();  // one sample, at (15.75, 10.75)
        m.resolve(f, {}, {});
    }
    EXPECT_NEAR(m.out.c[0].at(15, 10), 0.5625 / 4, 2e-3);
    EXPECT_NEAR(m.out.c[0].at(16, 10), 0.1875 / 4, 2e-3);
    EXPECT_NEAR(m.out.c[0].at(16, 11), 0.0625 / 4, 2e-3);
    EXPECT_NEAR(m.out.c[0].at(14, 10), 0, 2e-3);
}

// methods/06 s.6.15: N = 1, c = 1, h = 0. At rest a = 1/2 -> 1/3. With a motion of (0.01, 0) in UV the limit is
// 0.25 + 0.0099 / 2 = 0.25495, below a = 1/2. At N = 3 the mean's weight 1/4 is under the limit: it holds instead.
TEST(T2msaa, WeightVectors) {
    const auto frame = [](int n, float value, double motionPx) {
        Frame f = temporalFrame(n, 100, 4, [value](int, int, int) { return value; }, {motionPx, 0});
        f.subSamplePositionsPx = {{0.25, 0.25}, {-0.25, -0.25}};
        f.subSamples.assign(2, {f.depthView, Rgb(100, 4), f.objectId, f.colorLinear});
        return f;
    };
    for (const double motionPx : {0.0, 1.0}) {  // 1 px of 100: 0.01
        RunningMethod m = running("t2msaa:space=linear", 100, 4);
        m.resolve(frame(0, 0, 0), {}, {});
        m.resolve(frame(1, 1, motionPx), {}, {});
        EXPECT_NEAR(m.out.c[0].at(50, 2), 1.0 / 3, 1e-6) << motionPx;
    }
    RunningMethod m = running("t2msaa:space=linear", 100, 4);
    for (int n = 0; n < 3; n++) m.resolve(frame(n, 0, 0), {}, {});  // N = 3
    m.resolve(frame(3, 1, 1.0), {}, {});
    const double mean = 0.25, limit = 0.25 + 3 * 0.0099 / 2, wc = limit / 2, wh = 1 - limit;
    ASSERT_GT(limit, mean);
    EXPECT_NEAR(m.out.c[0].at(50, 2), wc / (wc + wh), 1e-6);
}
TEST(T2msaa, StaticMeanOfBothFrames) {
    // Two sub-samples a frame; luma weights off by equal brightness: after the second frame the mean of all four.
    RunningMethod m = running("t2msaa:space=linear", 12, 8, true);
    for (int n = 0; n < 2; n++) {
        Frame f = temporalFrame(n, 12, 8, [](int, int, int) { return 0.0f; });
        f.subSamplePositionsPx = {{0.25, 0.25}, {-0.25, -0.25}};
        f.subSamples.resize(2);
        for (size_t k = 0; k < 2; k++) {
            f.subSamples[k].depthView = f.depthView;
            f.subSamples[k].colorLinear = Rgb(12, 8);
            // Same luma601 0.3, different hues.
            f.subSamples[k].colorLinear.c[n == 0 ? 0 : 1] = PlaneF(12, 8, n == 0 ? 0.3f / 0.299f : 0.3f / 0.587f);
        }
        m.resolve(f, {}, {});
    }
    EXPECT_NEAR(m.out.c[0].at(5, 4), 0.5 * 0.3 / 0.299, 1e-6);
    EXPECT_NEAR(m.out.c[1].at(5, 4), 0.5 * 0.3 / 0.587, 1e-6);
}
// Of more than two sub-samples the frame shows the two that lie, jitter and position together, where the thesis
// samples.
TEST(T2msaa, ChoosesSamplesByJitterAndPosition) {
    const std::vector<glm::dvec2> positions = {{0.0625, -0.1875}, {0.25, 0.25}, {-0.25, -0.25}, {-0.5, 0.0}};
    for (const double jitter : {0.0, 0.25}) {
        RunningMethod m(parseMethod("t2msaa:space=linear"),
                        {.width = 12, .height = 8, .frameCount = 1, .subSamplePositionsPx = positions});
        Frame f = temporalFrame(0, 12, 8, [](int, int, int) { return 0.0f; });
        f.jitterPx = {jitter, -jitter};
        f.subSamplePositionsPx = positions;
        f.subSamples.resize(4);
        for (size_t k = 0; k < 4; k++) {
            f.subSamples[k].depthView = f.depthView;
            f.subSamples[k].colorLinear = Rgb(12, 8, float(1 << k));
        }
        m.resolve(f, {}, {});
        // The thesis samples frame 0 at (.5, 0) and (0, -.5).
        EXPECT_EQ(m.out.c[0].at(5, 4), jitter == 0 ? (2 + 1) / 2.0f : (2 + 4) / 2.0f);
    }
}

}  // namespace
}  // namespace aa
