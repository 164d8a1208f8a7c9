// The torture set of conventions 12 for every temporal method: extremes that no scene has and every method must bear.
#include <gtest/gtest.h>

#include "methods/temporal/temporal_test_frames.h"
#include "shot/patterns.h"

namespace aa {
namespace {
using namespace testing;

constexpr int kTortureWidth = 21, kTortureHeight = 13;

class Torture : public ::testing::TestWithParam<std::string> {
  protected:
    std::vector<glm::dvec2> positionsPx = patternPositionsPx(GetParam() == "smaa4x" ? "d3d4" : "d3d2");

    RunningMethod method(const std::string& options = "") const {
        return RunningMethod(specUnderTest(GetParam() + options), {.width = kTortureWidth,
                                                                   .height = kTortureHeight,
                                                                   .jitterPeriod = 16,
                                                                   .isStatic = false,
                                                                   .frameCount = 16,
                                                                   .subSamplePositionsPx = positionsPx});
    }
    Frame frame(int n, const Picture& picture, glm::dvec2 motionPx = {0, 0}) const {
        Frame f = temporalFrame(n, kTortureWidth, kTortureHeight, picture, motionPx);
        f.subSamplePositionsPx = positionsPx;
        f.subSamples.assign(positionsPx.size(),
                            {f.depthView, Rgb(kTortureWidth, kTortureHeight), f.objectId, f.colorLinear});
        return f;
    }
    bool encoded() const { return specUnderTest(GetParam()).outputSpace() == Space::encoded; }
};

bool allFinite(const Rgb& image) {
    for (const auto& p : image.c)
        for (int y = 0; y < kTortureHeight; y++)
            for (int x = 0; x < kTortureWidth; x++)
                if (!std::isfinite(p.at(x, y))) return false;
    return true;
}
double meanOf(const Rgb& image) {
    double sum = 0;
    for (const auto& p : image.c)
        for (int y = 0; y < kTortureHeight; y++)
            for (int x = 0; x < kTortureWidth; x++) sum += double(p.at(x, y));
    return sum / (3 * kTortureWidth * kTortureHeight);
}

TEST_P(Torture, ConstantsStayConstant) {  // T1 to T3
    // PQ ends at 10000, and half floats at 65504.
    for (const float v : {0.0f, 0.5f, GetParam() == "donut" ? 1e4f : GetParam() == "fsr2n" ? 6e4f : 1e6f}) {
        RunningMethod m = method();
        for (int n = 0; n < 12; n++) m.resolve(frame(n, [&](int, int, int) { return v; }, {0.3, -0.4}), {}, {});
        Rgb expected;
        encode(Rgb(kTortureWidth, kTortureHeight, v), {}, {}, expected);
        const float want = encoded() ? expected.c[0].at(0, 0) : v;
        // PQ loses a few units more than a blend (kernels/pq.h).
        const float tolerance = (GetParam() == "donut" ? 2e-5f : 2e-6f) * std::max(want, 0.01f);
        for (const auto& p : m.out.c)
            for (int y = 0; y < kTortureHeight; y++)
                for (int x = 0; x < kTortureWidth; x++)
                    ASSERT_NEAR(p.at(x, y), want, tolerance) << v << " " << x << "," << y;
    }
}

TEST_P(Torture, ExtremeColoursStayFinite) {  // T4, T5, T7, T8
    const Picture pictures[] = {
        [](int x, int y, int) { return float((x + y) % 2); },
        [](int x, int y, int) { return x == 9 && y == 6 ? 1e6f : 0.0f; },
        [](int x, int y, int c) { return 1e-42f * float(x + 30 * y + c); },
        [](int x, int y, int c) {
            return float(std::pow(10.0, 12 * double(noisePicture(5)(x, y, c)) - 6));  // 1e-6 .. 1e6
        },
    };
    for (const auto& picture : pictures) {
        RunningMethod m = method();
        for (int n = 0; n < 10; n++) {
            m.resolve(frame(n, picture, {0.7 * (n % 2), -0.45}), {}, {});
            ASSERT_TRUE(allFinite(m.out)) << n;
        }
        // It leaves no trace for ever: without constraint a firefly of 1e6 falls below 1 in 140 frames of k = 0.9.
        for (int n = 0; n < 400; n++) m.resolve(frame(n + 10, [](int, int, int) { return 0.25f; }), {}, {});
        Rgb flat;
        encode(Rgb(kTortureWidth, kTortureHeight, 0.25f), {}, {}, flat);
        // A running mean keeps the share 1/N of what it saw.
        if (GetParam() == "accumReject" || GetParam() == "asaa" || GetParam() == "t2msaa") continue;
        ASSERT_NEAR(m.out.c[0].at(9, 6), encoded() ? flat.c[0].at(0, 0) : 0.25f, 1e-3);
    }
}

TEST_P(Torture, ExtremeDepthAndMotionStayFinite) {  // T9 to T11
    for (int kind = 0; kind < 5; kind++) {
        RunningMethod m = method();
        for (int n = 0; n < 8; n++) {
            const glm::dvec2 motion = kind == 2   ? glm::dvec2(double(NAN), 0)
                                      : kind == 3 ? glm::dvec2(n % 2 ? 1e30 : -1e30, 1e30)
                                      : kind == 4 ? glm::dvec2(kTortureWidth, -kTortureHeight)
                                                  : glm::dvec2(0.4, 0.4);
            Frame f = frame(n, noisePicture(unsigned(n)), motion);
            for (int y = 0; y < kTortureHeight; y++)
                for (int x = 0; x < kTortureWidth; x++) {
                    const float z = kind == 0 ? kBackgroundDepth : (x + y + n) % 2 ? 5.0f : kBackgroundDepth;
                    f.depthView.at(x, y) = z;
                    f.objectId.at(x, y) = z < 1e9f;
                }
            f.depthView.fillBorder(), f.objectId.fillBorder();
            for (auto& s : f.subSamples) s.depthView = f.depthView, s.objectId = f.objectId;
            m.resolve(f, {}, {});
            ASSERT_TRUE(allFinite(m.out)) << "kind " << kind << " frame " << n;
        }
    }
}

// T14: a static jittered picture may repeat with its period; it may not drift.
TEST_P(Torture, ThousandStaticFramesDoNotDrift) {
    const auto halton = [](int i, int base) {
        double f = 1, r = 0;
        for (; i > 0; i /= base) f /= base, r += f * (i % base);
        return r - 0.5;
    };
    RunningMethod m = method();
    std::vector<Frame> phases;
    for (int t = 0; t < 16; t++) {
        const glm::dvec2 j(halton(t + 1, 2), halton(t + 1, 3));
        Frame f = frame(
            1, [&](int x, int y, int c) { return 0.2f + 0.6f * float(0.8 * (x + j.x) + 0.55 * (y + j.y) > 12 + c); });
        f.jitterPx = j;
        phases.push_back(std::move(f));
    }
    double settled = 0, last = 0;
    // Falcor's anti-flicker lets history near the end of its box settle slowly: the first thousand frames are for that.
    for (int n = 0; n < 2048; n++) {
        Frame f = phases[size_t(n % 16)];
        f.reset = n == 0;
        m.resolve(f, {}, {.parallel = false});
        if (n >= 1008 && n < 1024) settled += meanOf(m.out) / 16;
        if (n >= 2032) last += meanOf(m.out) / 16;
    }
    EXPECT_NEAR(settled, last, 1e-4);
}

std::vector<std::string> temporalMethods() {
    std::vector<std::string> ids;
    for (const auto& m : methodsUnderTest())
        if (m.family == "temporal") ids.emplace_back(m.id);
    return ids;
}
INSTANTIATE_TEST_SUITE_P(Temporal, Torture, ::testing::ValuesIn(temporalMethods()),
                         [](const auto& info) { return info.param; });

// T16: history alone and current colour alone, bit by bit, of the methods that let one ask for it.
TEST(Torture, FeedbackZeroAndOne) {
    for (const char* text :
         {"taaSimplest:k=0", "unchartedNoSharpen:kmin=0,kmax=0", "inside:kmin=0,kmax=0,unjitterColor=off",
          "master:kmin=0,kmax=0,sharpen=none", "karis:alpha=1,filter=none,antiFlicker=none,ycocg=off",
          "falcor:alpha=1,antiFlicker=none,ycocg=off"}) {
        RunningMethod m = running(text, 20, 14);
        for (int n = 0; n < 4; n++) {
            const Frame f = temporalFrame(n, 20, 14, noisePicture(unsigned(n)), {0.3, 0.1});
            m.resolve(f, {}, {});
            EXPECT_TRUE(m.out.samePixels(m.spec.method->input == Space::encoded ? f.colorEncoded : f.colorLinear))
                << text << " frame " << n;
        }
    }
}

}  // namespace
}  // namespace aa
