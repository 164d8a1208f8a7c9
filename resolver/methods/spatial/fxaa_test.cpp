#include "methods/spatial/fxaa.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "image/error.h"
#include "methods/method.h"
#include "methods/spatial/fxaa_reference.h"
#include "methods/spatial/spatial_testing.h"
#include "methods/spec.h"

namespace aa {
namespace {
using namespace aa::testing;

const std::vector<double> kSteps10 = {1.5, 3, 12}, kSteps12 = {1, 1.5, 2, 4, 12},
                          kSteps29 = {1, 1.5, 2, 2, 2, 2, 2, 2, 2, 2, 4, 8},
                          kSteps39 = {1, 1, 1, 1, 1, 1.5, 2, 2, 2, 2, 4, 8};

struct Conformance {
    std::string spec;
    std::vector<double> stepsPx;
    double subpix = 0.75, thr = 0.166, thrMin = 0.0833;
};

TEST(Fxaa311, StepVector) {
    const Rgb p12 = resolveOnce("fxaa311:preset=12", stepImage()), p39 = resolveOnce("fxaa311:preset=39", stepImage());
    const int x12[] = {20, 24, 28, 30, 31, 32, 33, 35, 39, 44};
    const double row4[] = {.0504, .2069, .3200, .3913, .4535, .5465, .6087, .6800, .7931, .9496};
    const double row4at39[] = {.1795, .2571, .3689, .4298, .4636, .5364, .5702, .6311, .7429, .8205};
    for (size_t i = 0; i < 10; i++) {
        EXPECT_NEAR(p12.c[0].at(x12[i], 4), row4[i], 6e-5) << "x " << x12[i];
        EXPECT_NEAR(p39.c[1].at(x12[i], 4), row4at39[i], 6e-5) << "x " << x12[i];
    }
    EXPECT_NEAR(p12.c[2].at(24, 3), .9496, 6e-5);
    EXPECT_NEAR(p12.c[2].at(30, 3), .9496, 6e-5);
    EXPECT_NEAR(p12.c[2].at(31, 3), .9817, 6e-5);
}

TEST(Fxaa311, ConformsToTheReferenceControlFlow) {
    const Conformance cases[] = {
        {"fxaa311:preset=10", kSteps10},
        {"fxaa311:preset=12", kSteps12},
        {"fxaa311:preset=29,subpix=1,edgeThreshold=0.063,edgeThresholdMin=0.0312", kSteps29, 1, 0.063, 0.0312},
        {"fxaa311:preset=39,subpix=0", kSteps39, 0},
    };
    const Rgb images[] = {randomShapes(97, 61, 7), randomCodes(50, 40, 11), randomShapes(61, 97, 8)};
    for (const auto& test : cases)
        for (const Rgb& image : images)
            for (const auto precision : {Precision::fast, Precision::scalar, Precision::oracle}) {
                const Rgb out = resolveOnce(test.spec, image, execOf(precision));
                Reference311 reference(image, test.stepsPx, test.subpix, test.thr, test.thrMin);
                int edges = 0;
                double worst = 0;
                for (int y = 0; y < image.height(); y++)
                    for (int x = 0; x < image.width(); x++) {
                        const auto expected = reference.pixel(x, y);
                        edges += out.c[0].at(x, y) != image.c[0].at(x, y);
                        if (reference.lastWasNearTie()) continue;
                        for (size_t c = 0; c < 3; c++)
                            worst = std::max(worst, std::abs(out.c[c].at(x, y) - expected[c]));
                    }
                EXPECT_LT(worst, 3e-6) << test.spec;
                EXPECT_GT(edges, 100) << test.spec;
                EXPECT_LT(reference.nearTies, 0.02 * image.width() * image.height()) << test.spec;
            }
}

TEST(Fxaa311, PrecisionsAndInstructionSetsAgree) {
    const Frame frame = frameOf(randomShapes(133, 77, 3));
    const Rgb fast = resolveOnce("fxaa311:preset=39", frame);
    for (const Isa isa : kIsas) {
        if (!isaSupported(isa)) continue;
        EXPECT_TRUE(fast.samePixels(resolveOnce("fxaa311:preset=39", frame, execOf(Precision::fast, isa))));
        EXPECT_TRUE(fast.samePixels(resolveOnce("fxaa311:preset=39", frame, execOf(Precision::scalar, isa))));
    }
    EXPECT_LT(largestDifference(fast, resolveOnce("fxaa311:preset=39", frame, execOf(Precision::oracle))), 3e-5);
}

TEST(Fxaa311, LeavesFlatAndDistantPixelsAlone) {
    Rgb image(200, 5, 0.25f);
    for (auto& p : image.c)
        for (int y = 0; y < 5; y++)
            for (int x = 100; x < 200; x++) p.at(x, y) = 0.75f;
    const Rgb out = resolveOnce("fxaa311:preset=29", image);
    for (int y = 0; y < 5; y++)
        for (int x = 0; x < 200; x++)
            if (x < 98 || x > 101) {
                EXPECT_EQ(out.c[0].at(x, y), image.c[0].at(x, y));
            }
}

TEST(Fxaa311, BlendsInLinearLightOnRequest) {
    const Frame frame = frameOf(stepImage());
    EXPECT_EQ(parseMethod("fxaa311:blendSpace=linear").outputSpace(), Space::linear);
    EXPECT_EQ(parseMethod("fxaa311").outputSpace(), Space::encoded);
    // Black and white are the same numbers in both spaces, so are the shares.
    EXPECT_LT(largestDifference(resolveOnce("fxaa311", frame), resolveOnce("fxaa311:blendSpace=linear", frame)), 1e-6);
}

TEST(Fxaa311, RejectsParametersOutOfRange) {
    EXPECT_THROW(parseMethod("fxaa311:preset=16"), UsageError);
    EXPECT_THROW(parseMethod("fxaa311:subpix=1.5"), UsageError);
    EXPECT_THROW(parseMethod("fxaa311:edgeThreshold=-0.1"), UsageError);
}
// decisions 37: where both sums are the same by construction the span is horizontal, in every precision.
TEST(Fxaa311, StructuralTiesAreHorizontal) {
    Rgb image(24, 17, 0.13f);
    for (auto& p : image.c) {
        p.at(4, 4) = 0.87f, p.at(11, 12) = 0.61f;  // points, and a vertical line
        for (int y = 0; y < 17; y++) p.at(19, y) = 0.7f;
    }
    const Frame f = frameOf(image);
    for (const auto precision : {Precision::fast, Precision::scalar, Precision::oracle}) {
        const auto method = parseMethod("fxaa311:edgeThreshold=0.063").create({.width = 24, .height = 17});
        Rgb out(24, 17);
        method->keepDebugLayers = true;
        method->resolve(f, execOf(precision), out);
        const auto layers = method->debugLayers();
        ASSERT_EQ(layers[0].name, "edges");  // gold: horizontal; blue: vertical
        const auto horizontal = [&](int x, int y) {
            return layers[0].planes[0].at(x, y) > layers[0].planes[2].at(x, y);
        };
        const auto vertical = [&](int x, int y) { return layers[0].planes[0].at(x, y) < layers[0].planes[2].at(x, y); };
        // At a point and beside it the second differences sum up to the same along x and along y.
        for (const auto& [x, y] : {std::pair{4, 4}, {4, 3}, {3, 4}, {5, 4}, {11, 12}, {10, 12}})
            EXPECT_TRUE(horizontal(x, y)) << x << "," << y;
        EXPECT_TRUE(vertical(19, 9));
    }
}
// conventions 11: with both thresholds 0 a flat pixel still exits, before it divides by its range.
TEST(Fxaa311, ThresholdsOfZeroLeaveFlatPixelsAlone) {
    Rgb image(40, 12, 0.4f);
    for (auto& p : image.c) p.at(20, 6) = 0.400001f;
    for (const char* spec : {"fxaa311:edgeThreshold=0,edgeThresholdMin=0", "fxaa311:luma=green,edgeThresholdMin=0"}) {
        const Rgb out = resolveOnce(spec, image);
        for (int y = 0; y < 12; y++)
            for (int x = 0; x < 40; x++) {
                ASSERT_TRUE(std::isfinite(out.c[0].at(x, y))) << spec;
                if (std::abs(x - 20) > 1 || std::abs(y - 6) > 1) {
                    ASSERT_EQ(out.c[0].at(x, y), 0.4f) << spec;
                }
            }
    }
}
// What each luma sees: a red edge has no green; sqrtLin weighs linear light, where mid greys are darker.
TEST(Fxaa311, LumaOptionsDecideByTheirOwnPlane) {
    const auto step = [](float r, float g, float b) {
        Rgb image = stepImage();
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < 9; y++)
                for (int x = 0; x < 64; x++) image.c[c].at(x, y) *= c == 0 ? r : c == 1 ? g : b;
        return image;
    };
    const auto changed = [](const char* spec, const Rgb& image) { return !resolveOnce(spec, image).samePixels(image); };
    EXPECT_TRUE(changed("fxaa311", step(1, 0, 0)));
    EXPECT_TRUE(changed("fxaa311:luma=sqrtLin", step(1, 0, 0)));
    EXPECT_FALSE(changed("fxaa311:luma=green", step(1, 0, 1)));
    EXPECT_TRUE(changed("fxaa311:luma=green", step(0, 1, 0)));
    // Encoded red of 0.2: luma 0.06 of 601; sqrt(0.299 * 0.0331) = 0.0995 of linear light. The threshold is 0.0833.
    EXPECT_FALSE(changed("fxaa311", step(0.2f, 0, 0)));
    EXPECT_TRUE(changed("fxaa311:luma=sqrtLin", step(0.2f, 0, 0)));
}

}  // namespace
}  // namespace aa
