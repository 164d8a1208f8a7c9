// Analytic gates of the temporal family: what theory says about weights, blur and shifts must come out of the methods.
#include "methods/temporal/temporal.h"

#include <gtest/gtest.h>

#include "image/error.h"
#include "methods/temporal/temporal_test_frames.h"
#include "metrics/temporal.h"
#include "shot/patterns.h"
#include "shot/synth/synth.h"

namespace aa {
namespace {
using namespace testing;

// Variance of white noise through an exponential history of current weight a: a / (2 - a) = 1 / N_eff.
TEST(Temporal, EffectiveSampleCountOfExponentialHistory) {
    for (const double alpha : {0.05, 0.1, 0.2}) {
        RunningMethod m = running("taaSimplest:k=" + std::to_string(1 - alpha), 64, 64, true);
        std::mt19937 random(7);
        std::uniform_real_distribution<float> uniform(0, 1);
        double sum = 0, squares = 0, count = 0;
        for (int n = 0; n < 400; n++) {
            m.resolve(temporalFrame(n, 64, 64, [&](int, int, int) { return uniform(random); }), {}, {});
            if (n < 200 || n % 40) continue;  // settled, and 40 frames apart: independent at these feedbacks
            for (const auto& plane : m.out.c)
                for (int y = 0; y < 64; y++)
                    for (int x = 0; x < 64; x++) {
                        const double v = double(plane.at(x, y));
                        sum += v, squares += v * v, count++;
                    }
        }
        const double variance = squares / count - sum / count * sum / count;
        const double nEff = (1.0 / 12) / variance;
        EXPECT_NEAR(nEff, (2 - alpha) / alpha, 0.03 * (2 - alpha) / alpha) << alpha;
    }
}

TEST(Temporal, AlternatingInputSettlesToItsTwoCycle) {
    RunningMethod m = running("taaSimplest", 4, 4, true);
    float last = 0, peakToPeak = 0;
    for (int n = 0; n < 400; n++) {
        m.resolve(temporalFrame(n, 4, 4, [&](int, int, int) { return float(n % 2); }), {}, {});
        peakToPeak = std::fabs(m.out.c[0].at(1, 1) - last), last = m.out.c[0].at(1, 1);
    }
    EXPECT_NEAR(peakToPeak, 0.1 / 1.9, 1e-6);  // (1 - k) / (1 + k)
}

// Each bilinear read at fraction f adds variance f (1 - f); the exponential history sums them to f (1 - f) k / (1 - k).
double blurVariancePx2(const std::string& method, double f) {
    const int w = 256, h = 3;
    RunningMethod m = running(method, w, h);
    const auto blob = [&](double x) { return 0.2 + 0.5 * std::exp(-(x * x) / (2 * 4.0 * 4.0)); };
    double centre = 60;
    for (int n = 0; n < 120; n++, centre += f)
        m.resolve(temporalFrame(n, w, h, [&](int x, int, int) { return float(blob(x - centre)); }, {f, 0}), {}, {});
    centre -= f;
    double mass = 0, first = 0, second = 0;
    for (int x = 30; x < w - 30; x++) {
        const double v = double(m.out.c[0].at(x, 1)) - 0.2, d = x - centre;
        mass += v, first += v * d, second += v * d * d;
    }
    EXPECT_NEAR(first / mass, 0, 1e-3) << "the history must follow the surface";
    return second / mass - 16.0;
}
TEST(Temporal, RepeatedBilinearReprojectionBlursByTheory) {
    for (const double f : {0.25, 0.5, 0.75}) EXPECT_NEAR(blurVariancePx2("taaSimplest", f), f * (1 - f) * 9, 0.01) << f;
    EXPECT_NEAR(blurVariancePx2("taaSimplest:k=0.8", 0.5), 0.25 * 4, 0.01);
    EXPECT_LT(blurVariancePx2("taaSimplest:history=catmullRom", 0.5), 0.05);
}

const char* const kUnconstrained[] = {"taaSimplest", "taaSimplest:history=catmullRom",
                                      "taaSimplest:history=catmullRom5"};
const char* const kEveryClip[] = {"unchartedNoSharpen",
                                  "unchartedNoSharpen:history=catmullRom",
                                  "unchartedNoSharpen:clipTarget=mean",
                                  "unchartedNoSharpen:clipTarget=clamp",
                                  "inside:unjitterColor=off",
                                  "master:sharpen=none",
                                  "karis:filter=none,ycocg=off",
                                  "accumReject"};

TEST(Temporal, WholePixelMotionDoesNotBlur) {
    std::vector<std::string> methods(std::begin(kUnconstrained), std::end(kUnconstrained));
    methods.insert(methods.end(), std::begin(kEveryClip), std::end(kEveryClip));
    for (const auto& text : methods) {
        RunningMethod m = running(text, 64, 40);
        const Picture still = noisePicture(3);
        for (int n = 0; n < 12; n++) {
            const Frame f =
                temporalFrame(n, 64, 40, [&](int x, int y, int c) { return still(x - 3 * n, y + 2 * n, c); }, {3, -2});
            m.resolve(f, {}, {});
            const Rgb& input = m.spec.method->input == Space::encoded ? f.colorEncoded : f.colorLinear;
            EXPECT_TRUE(m.out.samePixels(input)) << text << " frame " << n;
        }
    }
}
// Nobody knows where such a surface was: not at the border either.
TEST(Temporal, UnknownMotionRejectsAClampedHistory) {
    for (const char* text : {"taaSimplest:outside=clamp", "inside:outside=clamp"})
        for (const glm::dvec2 unknown : {glm::dvec2(1e6, 1e6), {0, -1e6}, {65, 0}, {0, 41}, {NAN, 0}}) {
            RunningMethod m = running(text, 32, 20);
            m.resolve(temporalFrame(0, 32, 20, noisePicture(1)), {}, {});
            const Frame f = temporalFrame(1, 32, 20, noisePicture(2), unknown);
            m.resolve(f, {}, {});
            EXPECT_TRUE(m.out.samePixels(m.spec.method->input == Space::encoded ? f.colorEncoded : f.colorLinear))
                << text << " " << unknown.x << " " << unknown.y;
        }
}
// Beyond the border every tap is held to the picture (conventions 1), wherever q lies.
TEST(Temporal, ClampedHistoryIsReadThroughHeldTaps) {
    const int w = 32, h = 20;
    const auto weights = [](double t) {
        return std::array{-t / 2 + t * t - t * t * t / 2, 1 - 2.5 * t * t + 1.5 * t * t * t,
                          t / 2 + 2 * t * t - 1.5 * t * t * t, -t * t / 2 + t * t * t / 2};
    };
    const Frame first = temporalFrame(0, w, h, noisePicture(1));
    for (const glm::dvec2 v : {glm::dvec2(0.3, -0.4), {1.25, 0.75}, {-1.7, 2.2}, {-5.5, 5.125}, {20.25, -33.5}}) {
        RunningMethod m = running("taaSimplest:outside=clamp,k=1,history=catmullRom,historyClamp=off", w, h);
        m.resolve(first, {}, {});
        m.resolve(temporalFrame(1, w, h, noisePicture(2), v), {}, {});
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) {
                const int ax = int(std::floor(x - v.x)), ay = int(std::floor(y - v.y));
                const auto wx = weights(x - v.x - ax), wy = weights(y - v.y - ay);
                double expected = 0;
                for (int j = 0; j < 4; j++)
                    for (int i = 0; i < 4; i++)
                        expected += wx[size_t(i)] * wy[size_t(j)] *
                                    double(first.colorLinear.c[0].clamped(ax + i - 1, ay + j - 1));
                ASSERT_NEAR(m.out.c[0].at(x, y), expected, 2e-6) << v.x << " " << v.y << ": " << x << "," << y;
            }
    }
}
// The trail of an exponential history is k^age of what was there: the metric must read its half-life, ln 2 / -ln k.
TEST(Temporal, GhostHalfLifeOfAnExponentialTrail) {
    for (const double k : {0.5, 0.7, 0.9}) {
        const int w = 96, h = 24;
        RunningMethod m = running("taaSimplest:k=" + std::to_string(k), w, h);
        TemporalScene scene(false);
        TemporalJudge judge(0);
        std::vector<Rgb> truths(20);
        for (int n = 0; n < 20; n++) {
            const auto covered = [&](int x) { return x >= 4 * n && x < 12 + 4 * n; };
            Frame f =
                temporalFrame(n, w, h, [&](int x, int, int c) { return covered(x) ? 0.8f : 0.1f + 0.1f * float(c); });
            for (int y = 0; y < h; y++)
                for (int x = 0; x < w; x++)
                    if (covered(x)) f.depthView.at(x, y) = 2, f.objectId.at(x, y) = 2, f.motionXPx.at(x, y) = 4;
            f.depthView.fillBorder(), f.objectId.fillBorder(), f.motionXPx.fillBorder();
            m.resolve(f, {}, {});
            // Judged in the space of the blend, where the trail is exponential.
            truths[size_t(n)] = f.colorLinear;
            scene.advance(f, &truths[size_t(n)], {});
            m.out.fillBorder();
            judge.add(scene, m.out, {});
        }
        const TemporalMetrics t = judge.result();
        ASSERT_GE(t.ghostFraction.size(), 10u);
        for (size_t a = 0; a < 10; a++)
            EXPECT_NEAR(t.ghostFraction[a], std::pow(k, double(a) + 1), 1e-4) << k << " " << a;
        EXPECT_NEAR(*t.ghostHalfLife, std::log(2.0) / -std::log(k), 1e-3) << k;
    }
}
// On a synthetic shot only the trail's inside is one flat colour over another; at its rims the truth is anti-aliased.
TEST(Temporal, GhostHalfLifeOnAnAnalyticShot) {
    SynthOptions options;
    options.scene = "moving", options.width = 160, options.height = 120, options.frames = 24, options.jitter = "none";
    const SynthShot shot(options);
    RunningMethod m = running("taaSimplest:k=0.8", 160, 120);
    TemporalScene scene(false);
    TemporalJudge judge(4);
    std::array<Rgb, 2> truths;
    for (size_t n = 0; n < 24; n++) {
        const Frame f = shot.frame(n);
        m.resolve(f, {}, {});
        Rgb& truth = truths[n % 2];  // the scene looks at the truth of the frame before, too
        truth = shot.truth(n).a;
        truth.fillBorder();
        m.out.fillBorder();
        scene.advance(f, &truth, {});
        judge.add(scene, m.out, {});
    }
    const TemporalMetrics t = judge.result();
    ASSERT_TRUE(t.ghostHalfLife);
    EXPECT_NEAR(*t.ghostHalfLife, std::log(2.0) / -std::log(0.8), 0.6);
}

TEST(Temporal, FlippedMotionSignIsSeen) {
    RunningMethod m = running("taaSimplest", 64, 40);
    const Picture still = noisePicture(3);
    Frame f;
    for (int n = 0; n < 12; n++) {
        f = temporalFrame(n, 64, 40, [&](int x, int y, int c) { return still(x - 3 * n, y, c); }, {-3, 0});
        m.resolve(f, {}, {});
    }
    EXPECT_FALSE(m.out.samePixels(f.colorLinear));
}

TEST(Temporal, FeedbackZeroAndOneAreExact) {
    for (const char* text : {"taaSimplest:k=0", "unchartedNoSharpen:kmin=0,kmax=0"}) {
        RunningMethod m = running(text, 20, 20);
        for (int n = 0; n < 4; n++) {
            const Frame f = temporalFrame(n, 20, 20, noisePicture(unsigned(n)), {0.3, 0.1});
            m.resolve(f, {}, {});
            EXPECT_TRUE(m.out.samePixels(m.spec.method->input == Space::encoded ? f.colorEncoded : f.colorLinear));
        }
    }
    RunningMethod keep = running("taaSimplest:k=1", 20, 20);
    const Frame first = temporalFrame(0, 20, 20, noisePicture(1));
    keep.resolve(first, {}, {});
    for (int n = 1; n < 4; n++) {
        keep.resolve(temporalFrame(n, 20, 20, noisePicture(unsigned(n + 1))), {}, {});
        EXPECT_TRUE(keep.out.samePixels(first.colorLinear));
    }
}

TEST(Temporal, HistoryOutsideTheImageIsTheCurrentColour) {
    for (const char* text : {"taaSimplest", "unchartedNoSharpen"})
        for (const glm::dvec2 motion : {glm::dvec2(25, 0), {0, -1e30}, {std::nan(""), 0}}) {
            RunningMethod m = running(text, 20, 20);
            m.resolve(temporalFrame(0, 20, 20, noisePicture(1)), {}, {});
            const Frame f = temporalFrame(1, 20, 20, noisePicture(2), motion);
            m.resolve(f, {}, {});
            EXPECT_TRUE(m.out.samePixels(m.spec.method->input == Space::encoded ? f.colorEncoded : f.colorLinear))
                << text;
        }
}

TEST(Temporal, RampWarmupIsARunningMean) {
    RunningMethod m = running("taaSimplest:warmup=ramp,k=0.999", 8, 8, true);
    double mean = 0;
    for (int n = 0; n < 16; n++) {
        const float v = float((n * 37) % 16) / 16;
        m.resolve(temporalFrame(n, 8, 8, [&](int, int, int) { return v; }), {}, {});
        mean += double(v);
        EXPECT_NEAR(m.out.c[1].at(4, 4), mean / (n + 1), 1e-6);
    }
}

TEST(Temporal, SizeChangeWithoutResetIsAnError) {
    RunningMethod m = running("uncharted", 20, 20);
    m.resolve(temporalFrame(0, 20, 20, noisePicture(1)), {}, {});
    EXPECT_THROW(m.resolve(temporalFrame(1, 24, 20, noisePicture(1)), {}, {}), InputError);
    Frame cut = temporalFrame(2, 24, 20, noisePicture(1));
    cut.reset = true;
    EXPECT_NO_THROW(m.resolve(cut, {}, {}));
}

TEST(Temporal, KMinAboveKMaxIsAUsageError) { EXPECT_THROW(running("uncharted:kmin=0.9,kmax=0.5", 8, 8), UsageError); }

TEST(Temporal, NothingDivergesOverTenThousandFrames) {
    for (const auto& method : methodsUnderTest()) {
        if (method.family != "temporal") continue;
        const int w = 19, h = 11;
        const auto positionsPx = patternPositionsPx(method.id == "smaa4x" ? "d3d4" : "d3d2");
        RunningMethod m(specUnderTest(method.id), {.width = w,
                                                   .height = h,
                                                   .jitterPeriod = 16,
                                                   .isStatic = false,
                                                   .frameCount = 16,
                                                   .subSamplePositionsPx = positionsPx});
        std::vector<Frame> frames;
        for (int n = 0; n < 8; n++) {
            frames.push_back(temporalFrame(n, w, h, noisePicture(unsigned(n)), {0.37 * (n % 3), -0.21 * (n % 5)}));
            Frame& f = frames.back();
            f.subSamplePositionsPx = positionsPx;
            f.subSamples.assign(positionsPx.size(), {f.depthView, Rgb(w, h), f.objectId, f.colorLinear});
        }
        for (int n = 0; n < 10000; n++) m.resolve(frames[size_t(n ? 1 + n % 7 : 0)], {}, {.parallel = false});
        // Sharpening of linear light is not clamped to the display's range: its overshoot is bounded, not cut.
        const float most = method.output == Space::linear ? 2.0f : 1.0f + 1e-6f;
        for (const auto& plane : m.out.c)
            for (int y = 0; y < h; y++)
                for (int x = 0; x < w; x++) {
                    ASSERT_GE(plane.at(x, y), -1e-6f) << method.id;
                    ASSERT_LE(plane.at(x, y), most) << method.id;
                }
    }
}

}  // namespace
}  // namespace aa
