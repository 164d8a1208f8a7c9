// What a method shows of its inside: every intermediate, finite, and in agreement with what it did.
#include <gtest/gtest.h>

#include <map>

#include "methods/temporal/temporal_test_frames.h"
#include "shot/patterns.h"

namespace aa {
namespace {
using namespace testing;

constexpr int kDebugWidth = 32, kDebugHeight = 18;
const std::vector<glm::dvec2> kPair = patternPositionsPx("d3d2");

Frame movingFrame(int n) {
    Frame f = temporalFrame(n, kDebugWidth, kDebugHeight, noisePicture(unsigned(n)), {3, 0});
    for (int y = 0; y < kDebugHeight; y++)
        for (int x = 0; x < kDebugWidth; x++)
            if (x > 10 && x < 16) f.depthView.at(x, y) = 2, f.objectId.at(x, y) = 2, f.motionXPx.at(x, y) = 5;
    f.depthView.fillBorder(), f.objectId.fillBorder(), f.motionXPx.fillBorder();
    f.subSamplePositionsPx = kPair;
    f.subSamples.assign(2, {f.depthView, Rgb(kDebugWidth, kDebugHeight), f.objectId, f.colorLinear});
    return f;
}
std::map<std::string, DebugLayer> layersOf(RunningMethod& m, int frames) {
    m.method->keepDebugLayers = true;
    for (int n = 0; n < frames; n++) m.resolve(movingFrame(n), {}, {});
    std::map<std::string, DebugLayer> byName;
    for (auto& layer : m.method->debugLayers()) byName[layer.name] = layer;
    return byName;
}

TEST(TemporalDebug, EveryMethodShowsItsIntermediates) {
    int seen = 0;
    for (const auto& d : methodsUnderTest()) {
        if (d.family != "temporal" || d.id.starts_with("smaa")) continue;  // those keep no constrained history
        RunningMethod m = running(std::string(d.id), kDebugWidth, kDebugHeight);
        const auto layers = layersOf(m, 3);
        std::vector<std::string> wanted = {"motionDilatedX", "motionDilatedY", "rejection", "boxLow",
                                           "boxHigh",        "clipAmount",     "feedback"};
        if (d.id == "accumReject" || d.id == "asaa" || d.id == "t2msaa") wanted.emplace_back("sampleCount");
        if (d.id == "master")
            for (const char* term :
                 {"aliasedValue", "sobelAverage", "modelAverage", "depthPseudoVariance", "depthTemporalPseudoVariance"})
                wanted.emplace_back(term);
        if (d.id == "fsr2n") wanted.emplace_back("depthClip"), wanted.emplace_back("lock");
        for (const auto& name : wanted) {
            ASSERT_TRUE(layers.contains(name)) << d.id << " " << name;
            for (const auto& plane : layers.at(name).planes) {
                ASSERT_EQ(plane.width(), kDebugWidth) << d.id;
                for (int y = 0; y < kDebugHeight; y++)
                    for (int x = 0; x < kDebugWidth; x++)
                        ASSERT_TRUE(std::isfinite(plane.at(x, y))) << d.id << " " << name;
            }
        }
        // Left of x = 3 the surface came from outside: history was not used, and the layer says why.
        for (int x = 0; x < 2; x++) {
            EXPECT_EQ(layers.at("rejection").planes[0].at(x, 9), 1.0f) << d.id;
            EXPECT_EQ(layers.at("feedback").planes[0].at(x, 9), 0.0f) << d.id;
        }
        EXPECT_EQ(layers.at("motionDilatedX").planes[0].at(25, 9), 3.0f) << d.id;
        seen++;
    }
    EXPECT_GE(seen, 14);
}
// The warm-up gives each of the first frames after a reset the same weight at most, in every method that offers it.
TEST(TemporalDebug, RampHoldsTheFeedbackOfEveryMethod) {
    int seen = 0;
    for (const auto& d : methodsUnderTest()) {
        const bool offered =
            std::any_of(d.params.begin(), d.params.end(), [](const auto& p) { return p.name == "warmup"; });
        if (!offered) continue;
        RunningMethod m = running(std::string(d.id) + ":warmup=ramp", kDebugWidth, kDebugHeight);
        m.method->keepDebugLayers = true;
        for (int n = 0; n < 6; n++) {
            m.resolve(temporalFrame(n, kDebugWidth, kDebugHeight, [](int, int, int) { return 0.5f; }), {}, {});
            if (n == 0) continue;
            for (const auto& layer : m.method->debugLayers()) {
                if (layer.name != "feedback") continue;
                EXPECT_LE(layer.planes[0].at(16, 9), 1 - 1.0f / float(n + 1) + 1e-6f) << d.id << " " << n;
            }
        }
        seen++;
    }
    EXPECT_GE(seen, 11);
}

}  // namespace
}  // namespace aa
