#include <gtest/gtest.h>

#include <cmath>

#include "image/error.h"
#include "methods/spatial/smaa.h"
#include "methods/spatial/smaa_areas.h"
#include "methods/spatial/spatial_testing.h"

namespace aa {
namespace {
using namespace aa::testing;

// A shallow edge y = y0 + slope x (or its transpose), black below, sampled at `samplePx` from the pixel centres.
constexpr int kSmaaWidth = 96, kSmaaHeight = 40;
Rgb shallowEdge(double y0, double slope, bool vertical, glm::dvec2 samplePx) {
    const int w = vertical ? kSmaaHeight : kSmaaWidth, h = vertical ? kSmaaWidth : kSmaaHeight;
    Rgb image(w, h);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            const double u = x + 0.5 + samplePx.x, v = y + 0.5 + samplePx.y;
            const bool below = vertical ? u > y0 + slope * v : v > y0 + slope * u;
            for (auto& p : image.c) p.at(x, y) = below ? 0.0f : 1.0f;
        }
    image.fillBorder();
    return image;
}
Rgb coverage(double y0, double slope, bool vertical) {
    const int w = vertical ? kSmaaHeight : kSmaaWidth, h = vertical ? kSmaaWidth : kSmaaHeight;
    Rgb sum(w, h);
    for (int i = 0; i < 16; i++)
        for (int j = 0; j < 16; j++) {
            const Rgb s = shallowEdge(y0, slope, vertical, {(i + .5) / 16 - .5, (j + .5) / 16 - .5});
            for (size_t c = 0; c < 3; c++)
                for (int y = 0; y < h; y++)
                    for (int x = 0; x < w; x++) sum.c[c].at(x, y) += s.c[c].at(x, y) / 256;
        }
    return sum;
}
double squaredError(const Rgb& a, const Rgb& b) {  // border of 20 px left out: searches end there
    double sum = 0;
    for (int y = 0; y < a.height(); y++)
        for (int x = 0; x < a.width(); x++) {
            if (std::min({x, y, a.width() - 1 - x, a.height() - 1 - y}) < 10) continue;
            sum += std::pow(double(a.c[0].at(x, y)) - b.c[0].at(x, y), 2);
        }
    return sum;
}
Frame jitteredFrame(const Rgb& image, int number, glm::dvec2 jitterPx, glm::dvec2 motionPx = {0, 0}) {
    Frame f = frameOf(image);
    f.number = number;
    f.reset = number == 0;
    f.jitterPx = jitterPx;
    f.motionXPx = PlaneF(f.width, f.height, float(motionPx.x));
    f.motionYPx = PlaneF(f.width, f.height, float(motionPx.y));
    return f;
}

// The first frame is the jittered frame alone: its edges must come back to the un-jittered place.
TEST(SmaaT2x, MovesJitteredEdgesBack) {
    double back[2] = {}, unmoved[2] = {}, wrong[2] = {};
    for (const bool vertical : {false, true})
        for (int k = 0; k < 12; k++) {
            const double y0 = 14.13 + 0.37 * k, slope = 0.03 + 0.011 * k;
            const Rgb truth = coverage(y0, slope, vertical);
            const Rgb image = shallowEdge(y0, slope, vertical, {0.25, 0.25});
            auto error = [&](glm::dvec2 declared) {
                return squaredError(
                    resolveOnce("smaaT2x:blendSpace=encoded,preset=ULTRA", jitteredFrame(image, 0, declared)), truth);
            };
            back[vertical] += error({0.25, 0.25});
            unmoved[vertical] += error({0, 0});
            wrong[vertical] += error({-0.25, -0.25});
        }
    for (size_t v = 0; v < 2; v++) {  // decisions 40: 1.8 / 14.8 / 43.3 on such edges
        EXPECT_LT(back[v], 0.25 * unmoved[v]) << v;
        EXPECT_LT(unmoved[v], 0.6 * wrong[v]) << v;
    }
}
TEST(SmaaT2x, StaticSceneAveragesBothFrames) {
    const Frame even = jitteredFrame(shallowEdge(17.3, 0.07, false, {.25, .25}), 0, {.25, .25});
    const Frame odd = jitteredFrame(shallowEdge(17.3, 0.07, false, {-.25, -.25}), 1, {-.25, -.25});
    const auto method = parseMethod("smaaT2x").create({.width = kSmaaWidth, .height = kSmaaHeight});
    Rgb first(kSmaaWidth, kSmaaHeight), second(kSmaaWidth, kSmaaHeight), third(kSmaaWidth, kSmaaHeight);
    method->resolve(even, {}, first);
    method->resolve(odd, {}, second);
    Frame again = even;
    again.number = 2;
    again.reset = false;
    method->resolve(again, {}, third);
    const Rgb oddAlone = resolveOnce("smaaT2x", [&] {
        Frame f = odd;
        f.reset = true;
        return f;
    }());
    for (int y = 0; y < kSmaaHeight; y++)
        for (int x = 0; x < kSmaaWidth; x++) {
            EXPECT_NEAR(second.c[0].at(x, y), 0.5f * (first.c[0].at(x, y) + oddAlone.c[0].at(x, y)), 1e-6f);
            EXPECT_NEAR(third.c[0].at(x, y), second.c[0].at(x, y), 1e-6f);  // the mean is symmetric: stable
        }
}
TEST(SmaaT2x, VelocityWeight) {
    // K = 30 on |v| in UV: equal speed 1/2, a difference of 1/3600 gives 1/4, 1/900 and more gives 0.
    for (const auto& [uv, weight] : {std::pair{0.0, 0.5}, {1.0 / 3600, 0.25}, {1.0 / 900, 0.0}, {1.0 / 100, 0.0}}) {
        Rgb white(kSmaaWidth, kSmaaHeight, 1.0f), black(kSmaaWidth, kSmaaHeight, 0.0f);
        const auto method = parseMethod("smaaT2x").create({.width = kSmaaWidth, .height = kSmaaHeight});
        Rgb out(kSmaaWidth, kSmaaHeight);
        method->resolve(jitteredFrame(white, 0, {0, 0}, {0, 0}), {}, out);
        method->resolve(jitteredFrame(black, 1, {0, 0}, {uv * kSmaaWidth, 0}), {}, out);
        EXPECT_NEAR(out.c[0].at(kSmaaWidth / 2, kSmaaHeight / 2), weight, 2e-3) << uv;
        // In units of 1080 px, whatever the resolution.
        const auto pixels =
            parseMethod("smaaT2x:velocityUnit=px1080").create({.width = kSmaaWidth, .height = kSmaaHeight});
        pixels->resolve(jitteredFrame(white, 0, {0, 0}, {0, 0}), {}, out);
        pixels->resolve(jitteredFrame(black, 1, {0, 0}, {0, uv * 1080}), {}, out);
        EXPECT_NEAR(out.c[0].at(kSmaaWidth / 2, kSmaaHeight / 2), weight, 2e-3) << uv;
    }
}
TEST(SmaaT2x, TakesNothingFromOutsideThePreviousFrame) {
    const auto method = parseMethod("smaaT2x").create({.width = kSmaaWidth, .height = kSmaaHeight});
    Rgb out(kSmaaWidth, kSmaaHeight);
    method->resolve(jitteredFrame(Rgb(kSmaaWidth, kSmaaHeight, 1.0f), 0, {0, 0}, {8, 0}), {}, out);
    method->resolve(jitteredFrame(Rgb(kSmaaWidth, kSmaaHeight, 0.0f), 1, {0, 0}, {8, 0}), {}, out);
    EXPECT_EQ(out.c[0].at(4, 5), 0.0f);   // came from x = -4
    EXPECT_EQ(out.c[0].at(20, 5), 0.5f);  // current - previous: came from x = 12
}

// The root of a difference of nearly equal speeds would show what float loses in it. Without edges, so that the
// velocities themselves are the same in both precisions.
TEST(SmaaT2x, NearlyEqualSpeedsLoseNothing) {
    const auto frame = [](int number, float grey, float spread) {
        Frame f = jitteredFrame(Rgb(kSmaaWidth, kSmaaHeight, grey), number, {0, 0}, {3, -2});
        for (int y = 0; y < kSmaaHeight; y++)
            for (int x = 0; x < kSmaaWidth; x++) f.motionXPx.at(x, y) += spread * float((x * 7 + y * 13) % 11);
        return f;
    };
    Rgb results[2] = {Rgb(kSmaaWidth, kSmaaHeight), Rgb(kSmaaWidth, kSmaaHeight)};
    for (size_t i = 0; i < 2; i++) {
        Exec exec;
        exec.precision = i == 0 ? Precision::fast : Precision::oracle;
        const auto method = parseMethod("smaaT2x").create({.width = kSmaaWidth, .height = kSmaaHeight});
        method->resolve(frame(0, 1, 0), exec, results[i]);
        method->resolve(frame(1, 0, 1e-6f), exec, results[i]);
    }
    for (int y = 0; y < kSmaaHeight; y++)
        for (int x = 0; x < kSmaaWidth; x++)
            EXPECT_NEAR(results[0].c[0].at(x, y), results[1].c[0].at(x, y), 5e-7) << x << " " << y;
}

Frame withSubSamples(double y0, double slope, const std::vector<glm::dvec2>& positionsPx, int number) {
    Frame f = jitteredFrame(shallowEdge(y0, slope, false, {0, 0}), number, {0, 0});
    f.subSamplePositionsPx = positionsPx;
    for (const auto& p : positionsPx) {
        f.subSamples.emplace_back();
        f.subSamples.back().colorLinear = shallowEdge(y0, slope, false, p);
    }
    return f;
}
// Straight edges are what SMAA 1x revectorises exactly, so the gain is measured against the mean of the samples alone.
TEST(SmaaMulti, ComeNearerToTheCoverageThanTheirSamples) {
    const std::vector<glm::dvec2> p2 = {{.25, .25}, {-.25, -.25}},
                                  p4 = {{-.125, -.375}, {.375, -.125}, {-.375, .125}, {.125, .375}};
    double box = 0, two = 0, four = 0;
    for (int k = 0; k < 12; k++) {
        const double y0 = 14.13 + 0.37 * k, slope = 0.08 + 0.021 * k;
        const Rgb truth = coverage(y0, slope, false);
        Rgb out(kSmaaWidth, kSmaaHeight);
        parseMethod("ssaa")
            .create({.width = kSmaaWidth, .height = kSmaaHeight, .subSamplePositionsPx = p2})
            ->resolve(withSubSamples(y0, slope, p2, 0), {}, out);
        box += squaredError(out, truth);
        parseMethod("smaaS2x:blendSpace=encoded")
            .create({.width = kSmaaWidth, .height = kSmaaHeight, .subSamplePositionsPx = p2})
            ->resolve(withSubSamples(y0, slope, p2, 0), {}, out);
        two += squaredError(out, truth);
        const auto method = parseMethod("smaa4x:blendSpace=encoded")
                                .create({.width = kSmaaWidth, .height = kSmaaHeight, .subSamplePositionsPx = p4});
        for (int n = 0; n < 2; n++) method->resolve(withSubSamples(y0, slope, p4, n), {}, out);
        four += squaredError(out, truth);
    }
    EXPECT_LT(two, 0.25 * box);
    EXPECT_LT(four, 0.7 * two);
}
// Four samples are four samples, whether the frame's jitter or the pattern moves them: smaa4x of jittered 2x frames, as
// published, and of the 4x pattern without jitter come equally near to the coverage; with the jitter unsaid it does
// not.
TEST(SmaaMulti, JitterAndPositionsAddUp) {
    const std::vector<glm::dvec2> p2 = {{.25, .25}, {-.25, -.25}},
                                  p4 = {{-.125, -.375}, {.375, -.125}, {-.375, .125}, {.125, .375}};
    double pattern = 0, jittered = 0, unsaid = 0;
    for (int k = 0; k < 12; k++) {
        const double y0 = 14.13 + 0.37 * k, slope = 0.08 + 0.021 * k;
        const Rgb truth = coverage(y0, slope, false);
        auto error = [&](const std::vector<glm::dvec2>& positions, bool jitter, bool say) {
            const auto method =
                parseMethod("smaa4x:blendSpace=encoded")
                    .create({.width = kSmaaWidth, .height = kSmaaHeight, .subSamplePositionsPx = positions});
            Rgb out(kSmaaWidth, kSmaaHeight);
            for (int n = 0; n < 2; n++) {
                const double d = !jitter ? 0 : n == 0 ? 0.125 : -0.125;
                Frame f = withSubSamples(y0, slope, positions, n);
                f.jitterPx = say ? glm::dvec2(d, -d) : glm::dvec2(0);
                for (size_t i = 0; i < positions.size(); i++)
                    f.subSamples[i].colorLinear = shallowEdge(y0, slope, false, glm::dvec2(d, -d) + positions[i]);
                method->resolve(f, {}, out);
            }
            return squaredError(out, truth);
        };
        pattern += error(p4, false, true), jittered += error(p2, true, true), unsaid += error(p2, true, false);
    }
    EXPECT_LT(jittered, 1.3 * pattern);
    EXPECT_GT(unsaid, 1.3 * jittered);
}
TEST(SmaaMulti, OtherPatternsAreInputErrors) {
    EXPECT_THROW(parseMethod("smaaS2x").create({.width = 8, .height = 8}), InputError);
    EXPECT_THROW(
        parseMethod("smaa4x").create({.width = 8, .height = 8, .subSamplePositionsPx = {{.25, .25}, {-.25, .25}}}),
        InputError);
}
// [Jimenez 2012]: the tiles of the published table for the four net positions, orthogonal ones as their offsets across
// vertical and horizontal edges. y is down here, up there.
TEST(SmaaMulti, TilesAreThoseOfThePublishedIndices) {
    const double tiles[] = {0, -.25, .25, -.125, .125, -.375, .375};
    struct Sample {
        glm::dvec2 positionPx;
        int vertical, horizontal;
    };
    for (const Sample& s : {Sample{{.375, .125}, 5, 3},
                            {{-.125, -.375}, 4, 6},
                            {{.125, .375}, 3, 5},
                            {{-.375, -.125}, 6, 4},
                            {{.25, .25}, 1, 1},  // T2x
                            {{-.25, -.25}, 2, 2}})
        for (const bool vertical : {false, true}) {
            Rgb image(vertical ? 9 : 64, vertical ? 64 : 9);
            const Rgb step = stepImage();
            for (size_t c = 0; c < 3; c++)
                for (int y = 0; y < 9; y++)
                    for (int x = 0; x < 64; x++) image.c[c].at(vertical ? y : x, vertical ? x : y) = step.c[c].at(x, y);
            Frame f = jitteredFrame(image, 0, s.positionPx);
            const auto method =
                parseMethod("smaaT2x:preset=MEDIUM").create({.width = image.width(), .height = image.height()});
            Rgb out(image.width(), image.height());
            method->keepDebugLayers = true;
            method->resolve(f, {}, out);
            const auto layers = method->debugLayers();
            const std::string wanted = vertical ? "weights.left" : "weights.top";
            const auto layer = std::find_if(layers.begin(), layers.end(),
                                            [&](const auto& l) { return l.name.find(wanted) != std::string::npos; });
            ASSERT_NE(layer, layers.end());
            // 7 px before the step, which crosses on the pixel's own side; nothing within 15 px on the other hand.
            const SmaaAreas a = orthogonalArea(0, 3, 15, 7, tiles[vertical ? s.vertical : s.horizontal]);
            const int x = vertical ? 4 : 24, y = vertical ? 24 : 4;
            EXPECT_GT(a.own + a.opposite, 0.01);
            EXPECT_NEAR(layer->planes[0].at(x, y), a.own, 1e-6) << s.positionPx.x << vertical;
            EXPECT_NEAR(layer->planes[1].at(x, y), a.opposite, 1e-6) << s.positionPx.x << vertical;
        }
}
// The diagonal tiles: half of the displacement across a diagonal in x, half in y, of opposite signs for the two kinds.
TEST(SmaaMulti, JitteredDiagonalsComeBack) {
    for (const double direction : {1.0, -1.0}) {
        double back = 0, unmoved = 0, wrong = 0;
        for (int k = 0; k < 12; k++) {
            const double slope = direction * (0.94 + 0.01 * k), y0 = (direction > 0 ? -19.3 : 58.1) + 0.29 * k;
            const Rgb truth = coverage(y0, slope, false);
            const auto error = [&](glm::dvec2 rendered, glm::dvec2 declared) {
                const Rgb image = shallowEdge(y0, slope, false, rendered);
                return squaredError(
                    resolveOnce("smaaT2x:blendSpace=encoded,preset=ULTRA", jitteredFrame(image, 0, declared)), truth);
            };
            const glm::dvec2 across(0.25, -0.25 * direction);
            back += error(across, across), unmoved += error(across, {0, 0}), wrong += error(across, -across);
        }
        EXPECT_LT(back, 0.7 * unmoved) << direction;
        EXPECT_LT(unmoved, 0.8 * wrong) << direction;
    }
}

}  // namespace
}  // namespace aa
