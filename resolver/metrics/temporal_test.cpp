#include "metrics/temporal.h"

#include <gtest/gtest.h>

#include <cmath>

#include "metrics/metrics.h"

namespace aa {
namespace {

constexpr int kW = 32, kH = 12;

Frame sceneFrame(int n) {
    Frame f;
    f.number = n;
    f.width = kW, f.height = kH;
    f.reset = n == 0;
    f.depthView = PlaneF(kW, kH, 10.0f);
    f.objectId = PlaneU(kW, kH, 1);
    f.motionXPx = PlaneF(kW, kH, 0.0f), f.motionYPx = PlaneF(kW, kH, 0.0f);
    return f;
}
Rgb grey(float v) {
    Rgb image(kW, kH, v);
    return image;
}

// Null where (x, y) is not on the trail.
const TemporalScene::TrailPixel* trailPixel(const TemporalScene& scene, int x, int y) {
    for (const auto& pixel : scene.trail(y))
        if (pixel.x == x) return &pixel;
    return nullptr;
}

// A bar of object 2, 6 px wide, moves right by 3 px a frame before object 1 at rest.
struct Bar {
    int left(int n) const { return 2 + 3 * n; }
    bool covers(int x, int n) const { return x >= left(n) && x < left(n) + 6; }
    Frame frame(int n) const {
        Frame f = sceneFrame(n);
        for (int y = 0; y < kH; y++)
            for (int x = 0; x < kW; x++)
                if (covers(x, n)) f.objectId.at(x, y) = 2, f.depthView.at(x, y) = 5, f.motionXPx.at(x, y) = 3;
        f.depthView.fillBorder(), f.objectId.fillBorder(), f.motionXPx.fillBorder(), f.motionYPx.fillBorder();
        return f;
    }
    Rgb truth(int n) const {
        Rgb image(kW, kH, 0.2f);
        for (auto& p : image.c)
            for (int y = 0; y < kH; y++)
                for (int x = 0; x < kW; x++)
                    if (covers(x, n)) p.at(x, y) = 0.8f;
        image.fillBorder();
        return image;
    }
    std::vector<Rgb> truths(int count) const {
        std::vector<Rgb> all;
        for (int n = 0; n < count; n++) all.push_back(truth(n));
        return all;
    }
};

TEST(TemporalMetrics, StaticFlickerIsTheStandardDeviation) {
    TemporalScene scene(true);
    TemporalJudge judge(2);
    for (int n = 0; n < 10; n++) {
        scene.advance(sceneFrame(n), nullptr, {});
        judge.add(scene, grey(n < 2 ? 0.9f : n % 2 ? 0.4f : 0.5f), {});  // the warm-up does not count
    }
    const TemporalMetrics m = judge.result();
    EXPECT_EQ(m.frames, 8);
    EXPECT_NEAR(*m.flickerStatic, 255 * 0.05, 1e-3);
    EXPECT_NEAR(*m.flickerStep, 255 * 0.1, 1e-3);  // nor does the step out of it
    EXPECT_FALSE(m.flickerMoving);
    EXPECT_FALSE(m.ghostMse);
    EXPECT_FALSE(m.tPsnr);
}

TEST(TemporalMetrics, TheTruthItselfNeitherFlickersNorGhosts) {
    const Bar bar;
    TemporalScene scene(false);
    TemporalJudge judge(1);
    const std::vector<Rgb> truths = bar.truths(7);
    for (int n = 0; n < 7; n++) {
        scene.advance(bar.frame(n), &truths[size_t(n)], {});
        judge.add(scene, truths[size_t(n)], {});
    }
    const TemporalMetrics m = judge.result();
    EXPECT_EQ(*m.flickerMoving, 0);
    EXPECT_EQ(*m.ghostMse, 0);
    EXPECT_FALSE(m.ghostHalfLife);
    EXPECT_TRUE(std::isinf(*m.tPsnr));
    for (const double g : m.ghostFraction) EXPECT_EQ(g, 0);
}

TEST(TemporalMetrics, TheStepOutOfTheWarmUpDoesNotCount) {
    const Bar bar;
    TemporalScene scene(false);
    TemporalJudge judge(2);
    const std::vector<Rgb> truths = bar.truths(6);
    for (int n = 0; n < 6; n++) {
        scene.advance(bar.frame(n), &truths[size_t(n)], {});
        judge.add(scene, n < 2 ? grey(0.9f) : truths[size_t(n)], {});
    }
    EXPECT_EQ(*judge.result().flickerMoving, 0);
}

TEST(TemporalMetrics, TrailIsWhatTheBarUncovers) {
    const Bar bar;
    TemporalScene scene(false);
    for (int n = 0; n < 5; n++) {
        const Rgb truth = bar.truth(n);
        scene.advance(bar.frame(n), &truth, {});
        for (int x = 0; x < kW; x++) {
            // Uncovered since frame f <= n, when the bar's trailing edge had passed. One pixel at its rim was within
            // reach of the 3x3 window and counts as seen.
            uint32_t age = 0;
            for (int f = 1; f <= n; f++)
                if (x >= bar.left(f - 1) + 1 && x < bar.left(f)) age = uint32_t(n - f + 1);
            const auto* const pixel = trailPixel(scene, x, 5);
            EXPECT_EQ(pixel ? pixel->age : 0, age) << "frame " << n << " x " << x;
            if (pixel) {
                EXPECT_NEAR(pixel->stale[1], 0.8f, 1e-6);
            }
        }
    }
}

TEST(TemporalMetrics, ARegionHoldsItsOwnPixelsAlone) {
    const Bar bar;
    TemporalScene scene(false);
    const int half = kW / 2;
    TemporalJudge whole(1), left(1, Window{0, 0, half, kH}), right(1, Window{half, 0, kW - half, kH});
    const std::vector<Rgb> truths = bar.truths(7);
    for (int n = 0; n < 7; n++) {
        scene.advance(bar.frame(n), &truths[size_t(n)], {});
        Rgb image = truths[size_t(n)];
        for (auto& p : image.c)
            for (int y = 0; y < kH; y++)
                for (int x = half; x < kW; x++) p.at(x, y) += n % 2 ? 0.1f : 0.0f;
        image.fillBorder();
        for (TemporalJudge* judge : {&whole, &left, &right}) judge->add(scene, image, {});
    }
    const TemporalMetrics all = whole.result(), l = left.result(), r = right.result();
    EXPECT_TRUE(std::isinf(*l.tPsnr));
    EXPECT_EQ(l.ghostMse.value_or(0), 0);
    EXPECT_NEAR(*r.tPsnr, psnr(0.01 / 2), 0.01) << "half of the six frames that count";
    EXPECT_NEAR(*all.tPsnr, psnr(0.01 / 2 * (kW - half) / kW), 0.01);
    EXPECT_GT(*r.flickerMoving, *all.flickerMoving);
    EXPECT_GT(*all.flickerMoving, *l.flickerMoving);
}

TEST(TemporalMetrics, SameFiguresEverywhere) {
    std::vector<TemporalMetrics> moving, still;
    for (const Exec& exec : {Exec{Isa::v2, Precision::scalar, false}, Exec{Isa::v2}, Exec{Isa::v3}, Exec{Isa::v4}}) {
        if (!isaSupported(exec.isa)) continue;
        for (const bool isStatic : {false, true}) {
            const Bar bar;
            TemporalScene scene(isStatic);
            TemporalJudge judge(1);
            const std::vector<Rgb> truths = bar.truths(7);
            for (int n = 0; n < 7; n++) {
                Frame frame = bar.frame(n);
                for (int x = 0; x < kW; x++) frame.motionXPx.at(x, 3) += 0.3f, frame.motionYPx.at(x, 4) -= 0.6f;
                scene.advance(frame, &truths[size_t(n)], exec);
                Rgb image = truths[size_t(n)];
                for (int x = 0; x < kW; x++) image.c[0].at(x, 3) += 0.01f * float((x * 7 + n * 5) % 11);
                image.fillBorder();
                // Its luma is told, or not.
                judge.add(scene, image, exec, {}, exec.parallel ? pictureLuma(image, exec) : PlaneF());
            }
            (isStatic ? still : moving).push_back(judge.result());
        }
    }
    for (const auto& m : moving) {
        EXPECT_EQ(m.flickerMoving, moving[0].flickerMoving);
        EXPECT_GT(*m.flickerMoving, 0.1);
        EXPECT_EQ(m.ghostMse, moving[0].ghostMse);
        EXPECT_EQ(m.tPsnr, moving[0].tPsnr);
    }
    for (const auto& m : still) {
        EXPECT_EQ(m.flickerStatic, still[0].flickerStatic);
        EXPECT_EQ(m.flickerStep, still[0].flickerStep);
        EXPECT_GT(*m.flickerStep, 0.1);
    }
}
TEST(TemporalMetrics, TakesTheErrorThatIsKnown) {
    const Rgb truth = grey(0.5f);
    TemporalScene scene(true);
    TemporalJudge measured(0), told(0);
    scene.advance(sceneFrame(0), &truth, {});
    measured.add(scene, grey(0.6f), {});
    told.add(scene, grey(0.6f), {}, 0.25);
    EXPECT_NEAR(*measured.result().tPsnr, 20, 1e-4);
    EXPECT_NEAR(*told.result().tPsnr, 6.0206, 1e-4);
}

// An image that keeps g^age of the stale colour must be read as exactly that.
TEST(TemporalMetrics, GhostFractionAndHalfLife) {
    const Bar bar;
    const double g = 0.5;
    TemporalScene scene(false);
    TemporalJudge judge(0);
    const std::vector<Rgb> truths = bar.truths(7);
    for (int n = 0; n < 7; n++) {
        scene.advance(bar.frame(n), &truths[size_t(n)], {});
        Rgb image = truths[size_t(n)];
        for (auto& p : image.c)
            for (int y = 0; y < kH; y++)
                for (int x = 0; x < kW; x++)
                    if (const auto* pixel = n > 0 ? trailPixel(scene, x, y) : nullptr)
                        p.at(x, y) += 0.6f * float(std::pow(g, double(pixel->age) - 1) * 0.8);
        judge.add(scene, image, {});
    }
    const TemporalMetrics m = judge.result();
    ASSERT_EQ(m.ghostFraction.size(), 6u) << "seven frames: no pixel of the trail is older than six";
    for (size_t a = 0; a < 6; a++) EXPECT_NEAR(m.ghostFraction[a], 0.8 * std::pow(g, double(a)), 1e-5) << a;
    EXPECT_NEAR(*m.ghostHalfLife, 1.0, 1e-4);
    EXPECT_GT(*m.ghostMse, 0);
}
// A shot with truth on its last frame only: the stale colour is the sampled one, and the figure is there all the same.
TEST(TemporalMetrics, GhostsAreFoundWhereOnlySomeFramesHaveTruth) {
    const Bar bar;
    TemporalScene scene(false);
    TemporalJudge judge(0);
    for (int n = 0; n < 7; n++) {
        Frame f = bar.frame(n);
        f.colorLinear = Rgb(kW, kH);
        for (auto& p : f.colorLinear.c)
            for (int y = 0; y < kH; y++)
                for (int x = 0; x < kW; x++) p.at(x, y) = bar.covers(x, n) ? 0.60382734f : 0.03310477f;  // 0.8, 0.2
        f.colorLinear.fillBorder();
        const Rgb truth = bar.truth(n);
        scene.advance(f, n == 6 ? &truth : nullptr, {});
        Rgb image = truth;
        for (auto& p : image.c)
            for (int y = 0; y < kH; y++)
                for (int x = 0; x < kW; x++)
                    if (const auto* pixel = n > 0 ? trailPixel(scene, x, y) : nullptr)
                        p.at(x, y) += 0.6f * float(std::pow(0.7, double(pixel->age)));
        judge.add(scene, image, {});
    }
    const TemporalMetrics m = judge.result();
    ASSERT_EQ(m.ghostFraction.size(), 6u);
    EXPECT_NEAR(m.ghostFraction[0], 0.7, 1e-4);
    EXPECT_NEAR(*m.ghostHalfLife, -1 / std::log2(0.7), 1e-3);
}
// Without a stale colour there is no figure, not a figure of 0.
TEST(TemporalMetrics, NoHalfLifeWithoutAStaleColour) {
    const Bar bar;
    TemporalScene scene(false);
    TemporalJudge judge(0);
    for (int n = 0; n < 4; n++) {
        const Rgb truth = bar.truth(n);
        scene.advance(bar.frame(n), n == 3 ? &truth : nullptr, {});  // frames without colour
        judge.add(scene, truth, {});
    }
    EXPECT_TRUE(judge.result().ghostMse);
    EXPECT_TRUE(judge.result().ghostFraction.empty());
    EXPECT_FALSE(judge.result().ghostHalfLife);
}

TEST(TemporalMetrics, FlickerAlongTheMotionIgnoresTheMotionAndSeesTheFlicker) {
    const Bar bar;
    const auto flicker = [&](float amplitude, bool flipMotion) {
        TemporalScene scene(false);
        TemporalJudge judge(0);
        const std::vector<Rgb> truths = bar.truths(7);
        for (int n = 0; n < 7; n++) {
            Frame f = bar.frame(n);
            if (flipMotion)
                for (int y = 0; y < kH; y++)
                    for (int x = 0; x < kW; x++) f.motionXPx.at(x, y) = -f.motionXPx.at(x, y);
            scene.advance(f, &truths[size_t(n)], {});
            Rgb image = truths[size_t(n)];
            for (auto& p : image.c)
                for (int y = 0; y < kH; y++)
                    for (int x = 0; x < kW; x++)
                        if (bar.covers(x, n)) p.at(x, y) += n % 2 ? amplitude * float(x - bar.left(n)) / 6 : 0;
            image.fillBorder();
            judge.add(scene, image, {});
        }
        return *judge.result().flickerMoving;
    };
    EXPECT_EQ(flicker(0, false), 0);
    // On the bar |D| = amplitude i / 6 for i = 0..5, elsewhere 0: by hand over the valid pixels.
    EXPECT_GT(flicker(0.1f, false), 255 * 0.1 * 0.1);
    EXPECT_NE(flicker(0.1f, false), flicker(0.1f, true));
}

TEST(TemporalMetrics, ConvergenceIsTheFirstFrameFromWhichThePsnrStays) {
    TemporalScene scene(true);
    TemporalJudge judge(0);
    const Rgb truth = grey(0.5f);
    const float error[] = {0.2f, 0.1f, 0.011f, 0.05f, 0.0102f, 0.0101f, 0.01f};
    for (int n = 0; n < 7; n++) {
        scene.advance(sceneFrame(n), &truth, {});
        judge.add(scene, grey(0.5f + error[n]), {});
    }
    EXPECT_EQ(*judge.result().convergence, 4);
}

TEST(TemporalMetrics, SameFiguresForAnyNumberOfThreads) {
    const Bar bar;
    double first = 0;
    for (const bool parallel : {false, true}) {
        TemporalScene scene(false);
        TemporalJudge judge(0);
        Rgb truth;
        for (int n = 0; n < 5; n++) {
            truth = bar.truth(n);
            scene.advance(bar.frame(n), &truth, {.parallel = parallel});
            Rgb image = bar.truth(n > 0 ? n - 1 : 0);
            judge.add(scene, image, {.parallel = parallel});
        }
        if (parallel)
            EXPECT_EQ(*judge.result().ghostMse, first);
        else
            first = *judge.result().ghostMse;
    }
}

}  // namespace
}  // namespace aa
