#include "shot/jitter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "image/error.h"
#include "shot/patterns.h"

namespace aa {
namespace {
void expectPoints(std::string_view sequence, int period, const std::vector<glm::dvec2>& expected,
                  double tolerance = 1e-12) {
    for (size_t n = 0; n < expected.size(); n++) {
        const glm::dvec2 j = jitterPx({.sequence = sequence, .period = period}, n);
        EXPECT_NEAR(j.x, expected[n].x, tolerance) << sequence << " " << n;
        EXPECT_NEAR(j.y, expected[n].y, tolerance) << sequence << " " << n;
    }
}
glm::dvec2 mean(const JitterSpec& spec) {
    glm::dvec2 sum(0);
    for (int n = 0; n < spec.period; n++) sum += jitterPx(spec, uint64_t(n));
    return sum / double(spec.period);
}

// Vectors of conventions 6.
TEST(Jitter, HaltonsFirstEight) {
    expectPoints("halton23", 16,
                 {{0, -1 / 6.},
                  {-.25, 1 / 6.},
                  {.25, -7 / 18.},
                  {-.375, -1 / 18.},
                  {.125, 5 / 18.},
                  {-.125, -5 / 18.},
                  {.375, 1 / 18.},
                  {-7 / 16., 7 / 18.}});
}
TEST(Jitter, ThesisSetIsReverseRadix) {
    const double u[8][2] = {{0, 0},         {.5, 2 / 3.},   {.25, 1 / 3.},  {.75, 2 / 9.},
                            {.125, 8 / 9.}, {.625, 5 / 9.}, {.375, 1 / 9.}, {.875, 7 / 9.}};
    std::vector<glm::dvec2> expected;
    for (auto& p : u) expected.emplace_back(p[0] - .5, p[1] - .5);
    expectPoints("thesis", 16, expected);
}
TEST(Jitter, BlockMeansAreThePublishedBiases) {
    const auto near = [](glm::dvec2 m, double x, double y) {
        EXPECT_NEAR(m.x, x, 6e-5);
        EXPECT_NEAR(m.y, y, 6e-5);
    };
    near(mean({.sequence = "halton23", .period = 16}), -0.0293, -0.0370);
    near(mean({.sequence = "halton23zero", .period = 16}), -0.0313, -0.0741);
    near(mean({.sequence = "halton23", .start = 0, .period = 16}), -0.0313, -0.0741);
    near(mean({.sequence = "halton23", .period = 128}), -0.0039, -0.0077);
    for (const auto& s : jitterSequences()) {
        const glm::dvec2 m = mean({.sequence = s.name, .period = 24, .centred = true});
        EXPECT_NEAR(m.x, 0, 1e-15) << s.name;
        EXPECT_NEAR(m.y, 0, 1e-15) << s.name;
    }
}
TEST(Jitter, HammersleyR2AndGradientNoise) {
    expectPoints("hammersley", 4, {{-.5, -.5}, {-.25, 0}, {0, -.25}, {.25, .25}});
    expectPoints("r2", 64, {{0, 0}, {-.2451223337533073, -.4301597090019468}, {-.4902446675066146, .1396805819961064}});
    // n = 0, u: frac(52.9829189 * (0.06711056 + 0.00583715)); v with 2 * 0.00583715.
    expectPoints("ign", 64, {{52.9829189 * 0.07294771 - 3 - .5, 52.9829189 * 0.07878486 - 4 - .5}}, 1e-9);
}
TEST(Jitter, ListsKeepTheirOrderAndSign) {
    expectPoints("quadrant", 16, {{-.25, -.25}, {-.25, .25}, {.25, -.25}, {.25, .25}, {-.25, -.25}});
    // Published with y up: Helix (-.25,-.25) first, so +.25 here.
    expectPoints("insideUniform4", 16, {{-.25, .25}, {.25, -.25}, {.25, .25}, {-.25, -.25}});
    expectPoints("insideRotated4", 16, {{-.125, .375}, {.375, .125}, {.125, -.375}, {-.375, -.125}});
    expectPoints("smaaT2x", 2, {{.25, .25}, {-.25, -.25}, {.25, .25}});
    // [Stejmar n.d.] moves the geometry by (-d, d) and (d, -d), y down; the samples go the other way.
    expectPoints("t2msaa", 2, {{.25, -.25}, {-.25, .25}, {.25, -.25}});
    expectPoints("t2msaa1875", 2, {{.1875, -.1875}, {-.1875, .1875}, {.1875, -.1875}});
    expectPoints("t2msaa125", 2, {{.125, -.125}, {-.125, .125}, {.125, -.125}});
    expectPoints("msaa8", 8, {{1 / 16., -3 / 16.}, {-1 / 16., 3 / 16.}, {5 / 16., 1 / 16.}});
    expectPoints("none", 1, {{0, 0}, {0, 0}});
}
TEST(Jitter, GaussianHasItsSpreadAndStaysInThePixel) {
    double square = 0;
    for (uint64_t n = 0; n < 4000; n++) {
        const glm::dvec2 j = jitterPx({.sequence = "gaussian", .period = 4000}, n);
        EXPECT_LE(std::abs(j.x), 0.5);
        square += j.x * j.x + j.y * j.y;
    }
    EXPECT_NEAR(std::sqrt(square / 8000), 0.2455, 0.004);  // sigma 0.2575, clipped at 1.94 sigma
    EXPECT_EQ(jitterPx({.sequence = "gaussian"}, 3), jitterPx({.sequence = "gaussian"}, 3));
    EXPECT_NE(jitterPx({.sequence = "gaussian"}, 3), jitterPx({.sequence = "gaussian"}, 4));
}
// [Stejmar n.d.] multiplies the same normal numbers by sigma squared: quarter points with hardly any spread.
TEST(Jitter, TheListedVarianceIsALabelledVariant) {
    double square = 0;
    int unclipped = 0;
    for (uint64_t n = 0; n < 4000; n++) {
        const glm::dvec2 quadrant = jitterPx({.sequence = "quadrant"}, n % 4);
        const glm::dvec2 g = jitterPx({.sequence = "gaussian", .period = 4000}, n),
                         v = jitterPx({.sequence = "quadrantGaussianVariance", .period = 4000}, n) - quadrant;
        square += v.x * v.x + v.y * v.y;
        if (std::abs(g.x) == 0.5 || std::abs(g.y) == 0.5) continue;
        unclipped++;
        EXPECT_NEAR(v.x, 0.2575 * g.x, 1e-12);
        EXPECT_NEAR(v.y, 0.2575 * g.y, 1e-12);
    }
    EXPECT_GT(unclipped, 3000);
    EXPECT_NEAR(std::sqrt(square / 8000), 0.0663, 0.001);
    EXPECT_EQ(jitterSequence("quadrantGaussianVariance").meaning.substr(0, 16), "labelled variant");
}
TEST(Jitter, EverySequenceStaysInThePixelAndRepeats) {
    for (const auto& s : jitterSequences())
        for (uint64_t n = 0; n < 300; n++) {
            const JitterSpec spec{.sequence = s.name, .period = 128};
            const glm::dvec2 j = jitterPx(spec, n);
            EXPECT_TRUE(std::abs(j.x) <= 0.5 && std::abs(j.y) <= 0.5) << s.name << " " << n;
            EXPECT_EQ(j, jitterPx(spec, n + 128)) << s.name;
        }
}
TEST(Jitter, WrongNamesAndStartsAreUsageErrors) {
    EXPECT_THROW(jitterPx({.sequence = "halton"}, 0), UsageError);
    EXPECT_THROW(jitterPx({.sequence = "r2", .start = 1}, 0), UsageError);
    EXPECT_THROW(jitterPx({.sequence = "r2", .period = 0}, 0), UsageError);
}
TEST(Patterns, Counts) {
    EXPECT_EQ(patternPositionsPx("d3d8").size(), 8u);
    EXPECT_EQ(patternPositionsPx("d3d8")[3], glm::dvec2(-3 / 16., -5 / 16.));
    EXPECT_EQ(patternPositionsPx("d3d16")[15], glm::dvec2(-7 / 16., -8 / 16.));
    EXPECT_EQ(patternPositionsPx("grid4").size(), 16u);
    EXPECT_EQ(patternPositionsPx("grid2")[1], glm::dvec2(0.25, -0.25));
    for (const char* bad : {"d3d3", "grid0", "grid9", "grid", "grid44", ""})
        EXPECT_THROW(patternPositionsPx(bad), UsageError) << bad;
}
}  // namespace
}  // namespace aa
