#include "methods/fxaa.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "image/error.h"
#include "methods/fxaa_reference.h"
#include "methods/spatial_testing.h"

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

TEST(Fxaa311, StepVectorOfTheSpecification) {
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
    for (const Isa isa : {Isa::v2, Isa::v3, Isa::v4}) {
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

}  // namespace
}  // namespace aa
