#include "methods/temporal/accum_reject.h"

#include <gtest/gtest.h>

#include "methods/method.h"
#include "methods/temporal/temporal_test_frames.h"

namespace aa {
namespace {
using namespace testing;

TEST(AccumReject, AfterWholePeriodsItIsTheMeanOfThePhases) {
    const int period = 16;
    RunningMethod m = running("accumReject", 24, 10, true);
    std::vector<Frame> phases;
    for (int n = 0; n < period; n++) {
        phases.push_back(temporalFrame(n + 1, 24, 10, noisePicture(unsigned(n))));
        // A silhouette that the jitter moves: depth and id of column 12 alternate, and no sample may be lost.
        for (int y = 0; y < 10; y++)
            for (int x = 12 + n % 2; x < 24; x++)
                phases.back().depthView.at(x, y) = 2, phases.back().objectId.at(x, y) = 2;
        phases.back().depthView.fillBorder(), phases.back().objectId.fillBorder();
    }
    phases[0].reset = true;
    for (int n = 0; n < 3 * period; n++) {
        Frame f = phases[size_t(n % period)];
        f.reset = n == 0;
        m.resolve(f, {}, {});
        if ((n + 1) % period) continue;
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < 10; y++)
                for (int x = 0; x < 24; x++) {
                    double mean = 0;
                    for (const auto& p : phases) mean += double(p.colorLinear.c[c].at(x, y)) / period;
                    ASSERT_NEAR(m.out.c[c].at(x, y), mean, 1e-6) << x << "," << y << " after " << n + 1;
                }
    }
    // The printed test compares one depth, and loses the history of the silhouette every other frame.
    RunningMethod point = running("accumReject:depthTest=point,objectIds=off", 24, 10, true);
    for (int n = 0; n < period; n++) {
        Frame f = phases[size_t(n)];
        f.reset = n == 0;
        point.resolve(f, {}, {});
    }
    double mean = 0;
    for (const auto& p : phases) mean += double(p.colorLinear.c[0].at(12, 5)) / period;
    EXPECT_GT(std::fabs(point.out.c[0].at(12, 5) - mean), 1e-3);
}

TEST(AccumReject, HundredThousandFramesDoNotDrift) {
    RunningMethod m = running("accumReject:depthTest=off,objectIds=off", 3, 2, true);
    std::vector<Frame> frames;
    for (int n = 0; n < 3; n++)
        frames.push_back(temporalFrame(n, 3, 2, [&](int x, int, int) {
            return x == 0 ? float(n % 2) : x == 1 ? 0.1f : 1e4f + float(n % 2);
        }));
    m.resolve(frames[0], {}, {.parallel = false});
    for (int n = 1; n < 100000; n++) m.resolve(frames[size_t(n % 2 ? 1 : 2)], {}, {.parallel = false});
    EXPECT_NEAR(m.out.c[0].at(0, 0), 0.5, 1e-5);
    EXPECT_FLOAT_EQ(m.out.c[0].at(1, 0), 0.1f);
    EXPECT_NEAR(m.out.c[0].at(2, 0), 1e4 + 0.5, 1e-3);
}

// A near object leaves; what it covered must be taken afresh, by depth alone and by id alone.
TEST(AccumReject, UncoveredSurfacesStartAfresh) {
    for (const char* text :
         {"accumReject:objectIds=off", "accumReject:depthTest=off", "accumReject:depthTest=point,objectIds=off"}) {
        RunningMethod m = running(text, 30, 8);
        m.method->keepRejection = true;
        for (int n = 0; n < 4; n++) {
            const auto covered = [&](int x) { return x >= 4 + 6 * n && x < 10 + 6 * n; };
            Frame f = temporalFrame(n, 30, 8, [&](int x, int, int) { return covered(x) ? 1.0f : 0.25f; });
            for (int y = 0; y < 8; y++)
                for (int x = 0; x < 30; x++)
                    if (covered(x)) f.depthView.at(x, y) = 2, f.objectId.at(x, y) = 2, f.motionXPx.at(x, y) = 6;
            f.depthView.fillBorder(), f.objectId.fillBorder(), f.motionXPx.fillBorder();
            m.resolve(f, {}, {});
            if (n == 0) continue;
            const int left =
                4 + 6 * (n - 1);  // uncovered in this frame: left .. left + 5; the rim is in the window's reach
            for (int x = left + 1; x < left + 5; x++) {
                EXPECT_EQ(m.out.c[0].at(x, 4), 0.25f) << text << " frame " << n << " x " << x;
                EXPECT_GT(m.method->rejection()->at(x, 4), 1.0f) << text;
            }
            EXPECT_EQ(m.out.c[0].at(left + 8, 4), 1.0f) << "the object keeps its own history";
        }
    }
    // Switched off, the ghost must be there.
    RunningMethod off = running("accumReject:depthTest=off,objectIds=off", 30, 8);
    for (int n = 0; n < 2; n++)
        off.resolve(temporalFrame(n, 30, 8, [&](int x, int, int) { return n == 0 && x < 10 ? 1.0f : 0.25f; }), {}, {});
    EXPECT_GT(off.out.c[0].at(5, 4), 0.5f);
}

TEST(AccumReject, ExpectedDepthFollowsTheCamera) {
    // The camera backs off by 3: a wall at 10 was at 7. Without the cameras 10 against 7 looks uncovered.
    Frame f = temporalFrame(1, 20, 12, noisePicture(2));
    Camera now;
    now.projection = glm::dmat4(0.0);
    now.projection[0][0] = 1, now.projection[1][1] = 20.0 / 12, now.projection[2][2] = -1.002,
    now.projection[2][3] = -1, now.projection[3][2] = -0.2002;
    Camera before = now;
    before.view[3][2] = 3;  // world z is 3 nearer: the camera stood 3 further forward
    f.camera = now, f.previousCamera = before;
    f.depthView = PlaneF(20, 12, 10.0f);
    for (const bool cameras : {true, false}) {
        RunningMethod m = running("accumReject:objectIds=off", 20, 12);
        m.method->keepRejection = true;
        Frame first = temporalFrame(0, 20, 12, noisePicture(1));
        first.depthView = PlaneF(20, 12, 7.0f);
        m.resolve(first, {}, {});
        Frame second = f;
        if (!cameras) second.previousCamera.reset();
        m.resolve(second, {}, {});
        EXPECT_EQ(m.method->rejection()->at(10, 6), cameras ? 0.0f : 2.0f);
    }
}

}  // namespace
}  // namespace aa
