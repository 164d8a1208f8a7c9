#include "methods/temporal/uncharted.h"

#include <gtest/gtest.h>

#include "methods/method.h"
#include "methods/temporal/temporal_test_frames.h"

namespace aa {
namespace {
using namespace testing;

// A bright pixel appears in a static dark image. By hand, encoded: rounded box lo = 0.2, hi = 0.8; history 0.2 is
// inside; d = (0.8 - 0.2) / 0.8 = 0.75; k = 0.925 + 0.054 / 16 = 0.928375.
TEST(Uncharted, OnePixelByHand) {
    Rgb linear;
    RunningMethod m = running("unchartedNoSharpen", 9, 9);
    auto frame = [&](int n, float bright) {
        Frame f = temporalFrame(n, 9, 9, [](int, int, int) { return 0.0f; });
        for (auto& p : f.colorEncoded.c) {
            for (int y = 0; y < 9; y++)
                for (int x = 0; x < 9; x++) p.at(x, y) = 0.2f;
            p.at(4, 4) = bright;
            p.fillBorder();
        }
        return f;
    };
    m.resolve(frame(0, 0.2f), {}, {});
    m.resolve(frame(1, 0.8f), {}, {});
    EXPECT_NEAR(m.out.c[0].at(4, 4), 0.2 + 0.6 * (1 - 0.928375), 1e-6);
    EXPECT_NEAR(m.out.c[0].at(0, 0), 0.2, 1e-7);
    // It vanishes: the box around it is 0.2 only, so the history may keep nothing of it.
    m.resolve(frame(2, 0.2f), {}, {});
    EXPECT_NEAR(m.out.c[0].at(4, 4), 0.2, 1e-6);
}

TEST(Uncharted, SharpeningIsTheStatedKernelAndIsNotFedBack) {
    const int w = 24, h = 16;
    RunningMethod plain = running("unchartedNoSharpen", w, h), xu = running("uncharted", w, h),
                  norm = running("unchartedNorm", w, h);
    for (int n = 0; n < 5; n++) {
        const Frame f = temporalFrame(n, w, h, noisePicture(unsigned(n)), {0.25, 0.5});
        for (auto* m : {&plain, &xu, &norm}) m->resolve(f, {}, {});
        for (int y = 1; y < h - 1; y++)
            for (int x = 1; x < w - 1; x++) {
                const auto& p = plain.out.c[1];
                const float around = p.at(x - 1, y) + p.at(x + 1, y) + p.at(x, y - 1) + p.at(x, y + 1);
                EXPECT_NEAR(xu.out.c[1].at(x, y), std::clamp(5 * p.at(x, y) - around, 0.0f, 1.0f), 2e-6);
                EXPECT_NEAR(norm.out.c[1].at(x, y), std::clamp(2 * p.at(x, y) - around / 4, 0.0f, 1.0f), 2e-6);
            }
    }
}

TEST(Uncharted, AGhostOutsideTheBoxIsClippedAway) {
    const int w = 48, h = 16;
    // A bright bar crosses a dark field by 6 px a frame; the field is at rest. Without the clip its trail would stay.
    const auto ghost = [&](const std::string& text) {
        RunningMethod m = running(text, w, h);
        for (int n = 0; n < 5; n++) {
            Frame f = temporalFrame(n, w, h, [&](int x, int, int) { return x / 4 == n * 2 ? 0.9f : 0.05f; });
            m.resolve(f, {}, {});
        }
        return m.shown().c[0].at(25, 8) - m.shown().c[0].at(45, 8);  // the bar's place two frames ago
    };
    EXPECT_LT(std::fabs(ghost("unchartedNoSharpen")), 1e-5f);
    EXPECT_GT(ghost("taaSimplest"), 0.05f);
}

}  // namespace
}  // namespace aa
