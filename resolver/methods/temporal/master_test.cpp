// Terms of aliasedValue against the matrices of [Oliveros 2018, 4.3] and the values of conventions 15.
#include "methods/temporal/master.h"

#include <gtest/gtest.h>

#include "methods/method.h"

#define AA_ARCH block_test
#define AA_LANES 4
#include "methods/temporal/master_terms.kernel.h"
#undef AA_ARCH

#include "methods/temporal/temporal_test_frames.h"

namespace aa {
namespace {
using namespace block_test;
using namespace testing;
using Matrix = std::array<double, 9>;  // row-major, centre at 4

auto entry(const Matrix& m) {
    return [&m](int i, int j) { return m[size_t((j + 1) * 3 + i + 1)]; };
}
double sobelOf(const Matrix& m) { return sobelMagnitude<double>(entry(m)); }
PseudoVariances<double> variancesOf(const Matrix& m, double past) {
    return pseudoVariances(depthWindow<double>(entry(m)), past - m[4], 0.002);
}
double modelOf(const Matrix& ids) {
    return modelAverage<double>([&](int i, int j) { return entry(ids)(i, j) != ids[4]; });
}

TEST(Master, SobelVectors) {
    EXPECT_NEAR(sobelOf({0, 0, 1, 0, 0, 1, 0, 0, 1}), 4, 1e-12);                // vertical unit step, left of it
    EXPECT_NEAR(sobelOf({0, 1, 1, 0, 1, 1, 0, 1, 1}), 4, 1e-12);                // and right of it
    EXPECT_NEAR(sobelOf({0, 1, 1, 0, 0, 1, 0, 0, 0}), std::sqrt(18.0), 1e-12);  // 45 degrees: 3 and 3
    EXPECT_NEAR(sobelOf({0, 0, 0, 0, 1, 0, 0, 0, 0}), 0, 1e-12);  // a single pixel: 0, 2 beside it, sqrt 2 diagonally
    EXPECT_NEAR(sobelOf({0, 0, 0, 1, 0, 0, 0, 0, 0}), 2, 1e-12);
    EXPECT_NEAR(sobelOf({1, 0, 0, 0, 0, 0, 0, 0, 0}), std::sqrt(2.0), 1e-12);
}
TEST(Master, SobelCurve) {
    EXPECT_NEAR(sobelCurve(0.5), 0.70711, 1e-5);
    EXPECT_EQ(sobelCurve(1.0), 1);
    EXPECT_EQ(sobelCurve(7.0), 1);
    EXPECT_NEAR(sobelCurve(0.1), 0.16733, 1e-5);
    EXPECT_EQ(sobelCurve(-1.0), 0);
    EXPECT_EQ(sobelCurve(std::nan("")), 1);
}
TEST(Master, ModelAverage) {
    EXPECT_NEAR(modelOf({3, 3, 3, 3, 3, 3, 1, 2, 2}), 3.0 / 9, 1e-12);  // matrix 4.2
    EXPECT_NEAR(modelOf({1, 1, 2, 2, 5, 2, 5, 4, 4}), 7.0 / 9, 1e-12);  // matrix 4.3
    EXPECT_EQ(modelOf({6, 6, 6, 6, 6, 6, 6, 6, 6}), 0);
}
TEST(Master, PseudoVariancesOfTheThesisMatrices) {
    // Matrices with the mean and D of 4.7 and 4.8.
    const auto small = variancesOf({9, 8.7, 9, 9, 9, 9.3, 9, 8.9, 9}, 4.0);
    EXPECT_NEAR(small.depth, 0.00148, 1e-5);
    EXPECT_NEAR(small.depthTemporal, 8.9e4, 0.05e4);
    EXPECT_NEAR(variancesOf({9, 9, 9, 9, 4, 9.3, 9, 8.6, 9}, 4.0).depth, 26.17, 0.005);
    // One outlier of nine.
    EXPECT_NEAR(variancesOf({9, 9, 9, 9, 4, 9, 9, 9, 9}, 4.0).depth, 64, 1e-9);
    EXPECT_NEAR(variancesOf({4, 9, 9, 9, 9, 9, 9, 9, 9}, 9.0).depth, 1, 1e-9);
}
TEST(Master, TwoDepthLevelsAlwaysCountAsAliased) {
    for (int count = 1; count <= 8; count++)
        for (const bool nearCentre : {false, true}) {
            Matrix m;
            m.fill(9);
            for (int i = 0; i < count; i++) m[size_t(i < 4 ? i : i + 1)] = 4;
            m[4] = nearCentre ? 4 : 9;
            if (count == 8 && nearCentre) continue;  // one level only
            EXPECT_GE(variancesOf(m, m[4]).depth, 1 - 1e-9) << count << nearCentre;
        }
}
TEST(Master, SlopesAndFlatsAreNotAliased) {
    EXPECT_NEAR(variancesOf({1, 2, 3, 2, 3, 4, 3, 4, 5}, 3.0).depth, 0, 1e-12);
    const auto flat = variancesOf({7, 7, 7, 7, 7, 7, 7, 7.001, 7}, 1.0);  // D below the threshold
    EXPECT_EQ(flat.depth, 0);
    EXPECT_EQ(flat.depthTemporal, 0);
    EXPECT_LE(variancesOf({7, 7, 7, 7, 7, 7, 7, 7.1, 7}, 1e10).depthTemporal, 1.0001e12);  // the ratio is capped
}

// Without any term the box is the current colour alone, and nothing accumulates.
TEST(Master, NotAliasedMeansNoHistory) {
    RunningMethod m = running("master:sobel=off,sharpen=none", 24, 16),
                  open = running("master:minAlias=1,sharpen=none", 24, 16);
    for (int n = 0; n < 4; n++) {
        const Frame f = temporalFrame(n, 24, 16, noisePicture(unsigned(n)));
        m.resolve(f, {}, {});
        open.resolve(f, {}, {});
        double difference = 0;
        for (int y = 0; y < 16; y++)
            for (int x = 0; x < 24; x++) {
                EXPECT_NEAR(m.out.c[1].at(x, y), f.colorEncoded.c[1].at(x, y), 3e-6);
                difference += std::fabs(open.out.c[1].at(x, y) - f.colorEncoded.c[1].at(x, y));
            }
        if (n > 0) {
            EXPECT_GT(difference, 1.0);
        }
    }
}
// With everything aliased and its own sharpening off, master is the Uncharted baseline with a pure 3x3 box.
TEST(Master, FullyAliasedIsUncharted3x3) {
    RunningMethod a = running("master:minAlias=1,sharpen=none", 24, 16),
                  b = running("unchartedNoSharpen:neighbourhood=3x3", 24, 16);
    for (int n = 0; n < 6; n++) {
        const Frame f = temporalFrame(n, 24, 16, noisePicture(unsigned(n)), {0.4, -0.3});
        a.resolve(f, {}, {});
        b.resolve(f, {}, {});
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < 16; y++)
                for (int x = 0; x < 24; x++) ASSERT_NEAR(a.out.c[c].at(x, y), b.out.c[c].at(x, y), 2e-6);
    }
}
TEST(Master, DebugLayersShowTheFourTerms) {
    RunningMethod m = running("master", 24, 16);
    m.method->keepDebugLayers = true;
    for (int n = 0; n < 3; n++) m.resolve(temporalFrame(n, 24, 16, noisePicture(unsigned(n))), {}, {});
    std::vector<std::string> names;
    for (const auto& l : m.method->debugLayers()) names.push_back(l.name);
    for (const char* expected : {"rejection", "boxLow", "feedback", "aliasedValue", "sobelAverage", "modelAverage",
                                 "depthPseudoVariance", "depthTemporalPseudoVariance"})
        EXPECT_NE(std::find(names.begin(), names.end(), expected), names.end()) << expected;
}

}  // namespace
}  // namespace aa
