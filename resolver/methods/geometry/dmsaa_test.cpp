#include "methods/geometry/dmsaa.h"

#include <gtest/gtest.h>

#include "methods/geometry/geometry_test_frames.h"
#include "methods/method.h"

namespace aa {
namespace {
using namespace testing;

// conventions 14: perS 4.2 / 3.9 / 4.0 dB, perD 5.5 / 0.4 / -0.9, ideal 6.8 / 10.9 / 12.1.
TEST(Dmsaa, GainsOnHalfPlanesAreThoseOfTheThreeReadings) {
    const std::pair<const char*, std::array<double, 3>> expected[] = {{"dmsaa", {4.2, 3.9, 4.0}},
                                                                      {"dmsaa:vecMode=perD", {5.5, 0.4, -0.9}},
                                                                      {"dmsaa:vecMode=ideal", {6.8, 10.9, 12.1}}};
    for (const auto& [method, gains] : expected)
        for (size_t i = 0; i < 3; i++)
            EXPECT_NEAR(halfPlaneGainDb(method, d3dPattern(size_t(4) << i)), gains[i], 0.5)
                << method << " " << (4 << i);
}
TEST(Dmsaa, ShiftsTowardTheDifferingSamples) {
    // The right half of the pixel is behind; the neighbours on the right show it.
    const TestScene scene{{{{0, 0, 1}, -4, glm::vec3(1.0f), 1}, {{0, 0, 1}, -9, glm::vec3(0.0f), 1}},
                          [](double x, double) { return x < 2.6 ? 0 : 1; }};
    const Frame f = renderPlanes(scene, 5, 3, d3dPattern(8));
    std::vector<DebugLayer> layers;
    resolved("dmsaa", f, {}, &layers);  // samples (5, 1), (3, 7), (7, -7) sixteenths
    EXPECT_EQ(layer(layers, "differing").at(2, 1), 3.0f);
    EXPECT_FLOAT_EQ(layer(layers, "offsetXPx").at(2, 1), 15.0f / 16 / 8);
    EXPECT_FLOAT_EQ(layer(layers, "offsetYPx").at(2, 1), 1.0f / 16 / 8);
    resolved("dmsaa:vecMode=perD", f, {}, &layers);
    EXPECT_FLOAT_EQ(layer(layers, "offsetXPx").at(2, 1), 15.0f / 16 / 3);
    const Rgb ideal = resolved("dmsaa:vecMode=ideal", f, {}, &layers);
    EXPECT_NEAR(layer(layers, "offsetXPx").at(2, 1), 3.0 / 8, 1e-3);
    EXPECT_NEAR(ideal.c[0].at(2, 1), 1 - 3.0 / 8, 1e-3);
    resolved("dmsaa:vecMode=perD,gain=4", f, {}, &layers);
    EXPECT_EQ(layer(layers, "offsetXPx").at(2, 1), 1.0f);  // clamped
}
// Edge cases of conventions 11.
TEST(Dmsaa, EqualBackgroundsAndSymmetricSamplesKeepTheColour) {
    const TestScene empty{{}, [](double, double) { return -1; }, glm::vec3(0.3f)};
    const Frame sky = renderPlanes(empty, 9, 5, d3dPattern(8));
    EXPECT_TRUE(resolved("dmsaa", sky).samePixels(sky.colorLinear));
    // Both 2x samples differ: their sum is zero.
    const TestScene cross{{{{0, 0, 1}, -4, glm::vec3(1.0f), 1}, {{0, 0, 1}, -9, glm::vec3(0.0f), 1}},
                          [](double x, double y) { return std::abs(x + y - 5) < 0.2 ? 0 : 1; }};
    for (const char* method : {"dmsaa", "dmsaa:vecMode=perD", "dmsaa:vecMode=ideal"}) {
        const Frame f = renderPlanes(cross, 5, 5, {{0.25, 0.25}, {-0.25, -0.25}});
        EXPECT_EQ(f.colorLinear.c[0].at(2, 2), 1.0f);
        EXPECT_EQ(resolved(method, f).c[0].at(2, 2), 1.0f) << method;
    }
}

}  // namespace
}  // namespace aa
