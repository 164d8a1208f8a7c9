#include "methods/temporal/asaa.h"

#include <gtest/gtest.h>

#include <utility>

#include "image/error.h"
#include "methods/method.h"
#include "methods/temporal/temporal_kernels.h"
#include "methods/temporal/temporal_test_frames.h"

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
// The camera of frame n of a shot whose picture moves by v px a frame, surfaces at `depthView`.
Camera pannedCamera(int n, glm::dvec2 v, double depthView) {
    Camera c;
    c.projection = glm::dmat4(1.2, 0, 0, 0, 0, 1.8, 0, 0, 0, 0, -1.002, -1, 0, 0, -0.2002, 0);
    c.view[3] = {n * v.x * 2 / 30 * depthView / 1.2, -n * v.y * 2 / 20 * depthView / 1.8, 0, 1};
    return c;
}
// The same pictures and motion, moved by the camera or, without one, by the object: the same place in every buffer. A
// camera's displacement not counted from the sample, at p + jitter, would be off by (1 - age) jitter.
TEST(Asaa, CameraMotionAndObjectMotionAgree) {
    const glm::dvec2 v(0.3, -0.2);
    for (const char* text : {"asaa", "asaa:unjitter=on", "asaa:blurMode=eq331"}) {
        RunningMethod withCamera = running(text, 30, 20), without = running(text, 30, 20);
        std::optional<Camera> before;
        for (int n = 0; n < 12; n++) {
            Frame f = rampFrame(n, v * double(n), v);
            f.jitterPx += glm::dvec2(0.03 * (n % 3), -0.02 * (n % 5));
            for (auto& p : f.colorEncoded.c) {  // a pattern that shows a shift of a tenth of a pixel
                for (int y = 0; y < 20; y++)
                    for (int x = 0; x < 30; x++)
                        p.at(x, y) = float(0.5 + 0.4 * std::sin(2 * (x + f.jitterPx.x - v.x * n)) *
                                                     std::cos(1.5 * (y + f.jitterPx.y - v.y * n)));
                p.fillBorder();
            }
            without.resolve(f, {}, {});
            f.camera = pannedCamera(n, v, 5);
            f.previousCamera = std::exchange(before, f.camera);
            withCamera.resolve(f, {}, {});
            for (int y = 0; y < 20; y++)
                for (int x = 0; x < 30; x++)
                    ASSERT_NEAR(withCamera.out.c[0].at(x, y), without.out.c[0].at(x, y), 2e-5)
                        << text << " " << n << " " << x << " " << y;
        }
    }
}
// Static, one quadrant per frame: weights (.75, .25) squared, of every buffer alike.
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

// The sample count that `text` keeps at pixel (15, 10) after each frame.
std::vector<double> countsOf(const std::string& text, const std::vector<Frame>& frames, int x = 15, int y = 10) {
    RunningMethod m = running(text, frames[0].width, frames[0].height);
    m.method->keepDebugLayers = true;
    std::vector<double> counts;
    for (const Frame& f : frames) {
        m.resolve(f, {}, {});
        for (const DebugLayer& layer : m.method->debugLayers())
            if (layer.name == "sampleCount") counts.push_back(double(layer.planes[0].at(x, y)));
    }
    return counts;
}
Frame flatFrame(int n, float depthView, glm::dvec2 motionPx = {0, 0}) {
    Frame f = temporalFrame(
        n, 30, 20, [](int, int, int) { return 0.5f; }, motionPx);
    f.jitterPx = kQuadrants[n % 4];
    f.depthView = PlaneF(30, 20, depthView);
    f.subSamplePositionsPx = {{0.25, 0.25}, {-0.25, -0.25}};
    f.subSamples.assign(2, {f.depthView, Rgb(30, 20), f.objectId, f.colorLinear});
    return f;
}
// [Stejmar n.d., 4.4.1]: 0 where all is rejected, so that the next frame, too, has alpha = 1; else one more.
TEST(Asaa, SampleCountIsZeroAfterARejection) {
    std::vector<Frame> frames;
    for (int n = 0; n < 9; n++) frames.push_back(flatFrame(n, n < 5 ? 5.0f : 50.0f));
    EXPECT_EQ(countsOf("asaa", frames), (std::vector<double>{1, 2, 3, 4, 5, 0, 1, 2, 3}));
    EXPECT_EQ(countsOf("asaa:blurMode=eq331", frames).at(5), 1);  // eq 3.29 with alpha = 1
    EXPECT_EQ(countsOf("asaa:depthTolerance=1", frames).back(), 9);
}
TEST(Asaa, SampleCountInMotion) {
    std::vector<Frame> frames;
    for (int n = 0; n < 8; n++) frames.push_back(flatFrame(n, 5, n ? glm::dvec2(0.4, 0.3) : glm::dvec2(0)));
    EXPECT_EQ(countsOf("asaa", frames), (std::vector<double>{1, 2, 3, 4, 5, 5, 5, 5}));
    EXPECT_EQ(countsOf("asaa:motionCount=four", frames), (std::vector<double>{1, 5, 5, 5, 5, 5, 5, 5}));
    const double V = 0.4 * 0.6 + 0.3 * 0.7, bound = V / (V + 0.24);
    const std::vector<double> found = countsOf("asaa:blurMode=eq331", frames);
    double N = 1;
    for (size_t n = 1; n < 8; n++) {
        const double alpha = std::max(1 / (N + 1), bound);
        N = 1 / (alpha * alpha + (1 - alpha) * (1 - alpha) / N);
        EXPECT_NEAR(found[n], N, 1e-5) << n;
    }
    for (Frame& f : frames) f.motionXPx = f.motionYPx = PlaneF(30, 20);
    double atRest = 0;
    for (const double count : countsOf("asaa:blurMode=eq331", frames)) EXPECT_NEAR(count, ++atRest, 1e-5);
}
// The thesis reads N where the pixel is, not where its surface was.
TEST(Rejection, SampleCountOfThePixelOrOfItsSurface) {
    std::vector<Frame> frames;
    for (int n = 0; n < 6; n++) {
        frames.push_back(flatFrame(n, 5, n == 5 ? glm::dvec2(2, 0) : glm::dvec2(0)));
        Frame& f = frames.back();
        for (int y = 0; y < 20; y++)
            for (int x = 14; x < 30; x++)
                if (n == 3 || n == 4) f.depthView.at(x, y) = 50;  // uncovered from x = 14 on in frame 3
        f.depthView.fillBorder();
        for (auto& s : f.subSamples) s.depthView = f.depthView;
    }
    // At x = 15 t2msaa restarts with 1, asaa with 0; in frame 5 the surface of x = 13 arrives, seen in every frame.
    EXPECT_EQ(countsOf("t2msaa", frames), (std::vector<double>{1, 2, 3, 1, 2, 3}));
    EXPECT_EQ(countsOf("t2msaa:countAt=reprojected", frames).back(), 5);  // a = the limit: no growth
    EXPECT_EQ(countsOf("asaa", frames), (std::vector<double>{1, 2, 3, 0, 1, 2}));
    EXPECT_EQ(countsOf("asaa:countAt=reprojected", frames).back(), 5);
}
// Methods that reject by geometry at their thresholds: reasons at the pixel in the second of two frames.
TEST(Rejection, ThresholdsAreParameters) {
    const auto reason = [](const std::string& text, float depthView, double slope) {
        RunningMethod m = running(text, 30, 20);
        m.method->keepRejection = true;
        m.resolve(flatFrame(0, 5), {}, {});
        Frame f = flatFrame(1, depthView);
        for (int y = 0; y < 20; y++)  // footprint 1 - slope in x; at x = 15 q lies 0.45 from a pixel's centre
            for (int x = 0; x < 30; x++) f.motionXPx.at(x, y) = slope != 0 ? float(slope * (x - 15) + 0.45) : 0.0f;
        f.motionXPx.fillBorder();
        m.resolve(f, {}, {});
        return Rejection(int(m.method->rejection()->at(15, 10)));
    };
    for (const std::string id : {"asaa", "t2msaa", "accumReject"}) {
        const std::string with = id + (id == "accumReject" ? ":depthTest=point,objectIds=off," : ":");
        // 6 behind 5: by a sixth of its depth.
        EXPECT_EQ(reason(with + "bothSides=off", 6, 0), Rejection::disoccluded) << id;
        EXPECT_EQ(reason(with + "depthTolerance=0.16", 6, 0), Rejection::disoccluded) << id;
        EXPECT_EQ(reason(with + "depthTolerance=0.17", 6, 0), Rejection::none) << id;
        EXPECT_EQ(reason(with + "depthTolerance=0.01", 5.02f, 0), Rejection::none) << id;
        EXPECT_EQ(reason(with + "depthTolerance=0.001", 5.02f, 0), Rejection::disoccluded) << id;
        EXPECT_EQ(reason(with + "depthTolerance=1", 1e10f, 0), Rejection::none) << id;
        // asaa has no reason of its own for magnification.
        const Rejection magnified = id == "asaa" ? Rejection::disoccluded : Rejection::magnified;
        EXPECT_EQ(reason(with + "magnification=1", 5, 0.6), magnified) << id;
        EXPECT_EQ(reason(with + "magnification=off", 5, 0.6), Rejection::none) << id;
        EXPECT_EQ(reason(with + "magnification=1", 5, 0.4), Rejection::none) << id;
        EXPECT_EQ(reason(with + "magnification=0.5", 5, 0.4), magnified) << id;
    }
}
// In the last column and row, beyond which the motion is repeated, the footprint is that of the pixel before.
TEST(Rejection, FootprintOfTheLastColumnAndRow) {
    for (const char* text :
         {"asaa", "t2msaa", "accumReject:depthTest=point,objectIds=off,magnification=1,dilation=none"})
        for (const bool column : {true, false})
            for (const double slope : {0.6, 0.4}) {
                RunningMethod m = running(text, 30, 20);
                m.method->keepRejection = true;
                m.resolve(flatFrame(0, 5), {}, {});
                Frame f = flatFrame(1, 5);
                for (int y = 0; y < 20; y++)
                    for (int x = 0; x < 30; x++)
                        (column ? f.motionXPx : f.motionYPx).at(x, y) =
                            float(slope * (column ? x - 29 : y - 19) + 0.45);
                f.motionXPx.fillBorder(), f.motionYPx.fillBorder();
                m.resolve(f, {}, {});
                EXPECT_EQ(m.method->rejection()->at(column ? 29 : 15, column ? 10 : 19) != 0, slope == 0.6)
                    << text << " " << column << " " << slope;
            }
}

// N = 1, c = 1, h = 0 (conventions 15). At rest a = 1/2 -> 1/3. With a motion of (0.01, 0) in UV the limit is
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

TEST(T2msaa, OffsetOfTwoSubSamplesIsRefused) {
    const ShotInfo two{.width = 8, .height = 8, .subSamplePositionsPx = {{0.25, 0.25}, {-0.25, -0.25}}};
    ShotInfo four = two;
    four.subSamplePositionsPx.insert(four.subSamplePositionsPx.end(), {{0.0, 0.4}, {0.4, 0.0}});
    for (const char* text : {"t2msaa:offset=0.125", "t2msaa:offset=0.25"}) {
        EXPECT_THROW(parseMethod(text).create(two), UsageError) << text;
        EXPECT_NO_THROW(parseMethod(text).create(four)) << text;
    }
    EXPECT_NO_THROW(parseMethod("t2msaa").create(two));
}

}  // namespace
}  // namespace aa
