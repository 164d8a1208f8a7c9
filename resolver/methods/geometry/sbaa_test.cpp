#include "methods/geometry/sbaa.h"

#include <gtest/gtest.h>

#include "methods/geometry/geometry_test_frames.h"
#include "methods/method.h"

namespace aa {
namespace {
using namespace testing;

TEST(Sbaa, GainOnHalfPlanesIsThatOfCoverage) {
    EXPECT_NEAR(halfPlaneGainDb("sbaa", d3dPattern(4)), 8.6, 0.5);
    EXPECT_NEAR(halfPlaneGainDb("sbaa", d3dPattern(8)), 12.7, 0.5);
    EXPECT_NEAR(halfPlaneGainDb("sbaa", d3dPattern(16)), 15.0, 0.5);
}
// Four surfaces in one pixel: 3 and 2 sub-samples on two near planes, 2 and 1 on a far one and on the background.
Frame fourSurfaces() {
    const TestScene scene{{{{0, 0, 1}, -4, glm::vec3(1.0f), 1},
                           {{std::sqrt(0.5), 0, std::sqrt(0.5)}, -3, glm::vec3(8.0f), 1},
                           {{0, 0, 1}, -9, glm::vec3(64.0f), 2}},
                          [](double x, double y) {
                              return y < 0.3 && x > 0.9 ? -1 : x < 0.4 ? 0 : x < 0.6 ? 1 : 2;
                          },
                          glm::vec3(512.0f)};
    return renderPlanes(scene, 1, 1, d3dPattern(8));
}
TEST(Sbaa, KeepsAsManySurfacesAsAsked) {
    const Frame f = fourSurfaces();
    // Samples 3 4 5; 0 1; 2 6; 7.
    EXPECT_FLOAT_EQ(resolved("sbaa:surfaces=4", f).c[0].at(0, 0), (3 * 1 + 2 * 8 + 2 * 64 + 512) / 8.0f);
    std::vector<DebugLayer> layers;
    for (const int k : {1, 2, 3, 4}) {
        resolved("sbaa:surfaces=" + std::to_string(k), f, {}, &layers);
        EXPECT_EQ(layer(layers, "clusters").at(0, 0), 4.0f);
        EXPECT_EQ(layer(layers, "surfaces").at(0, 0), float(k));
        if (k == 4) {
            EXPECT_EQ(layer(layers, "largest").at(0, 0), float(1 << 3 | 1 << 4 | 1 << 5));
        }
    }
    // Alone, everything has the colour of the sub-sample nearest to the centroid (0.5, 1)/16, which is 0.
    EXPECT_FLOAT_EQ(resolved("sbaa:surfaces=1", f).c[0].at(0, 0), 8.0f);
}
TEST(Sbaa, AsManySurfacesAsSamplesIsMsaa) {
    for (const glm::dvec2 jitterPx : {glm::dvec2(0), glm::dvec2(0.3, -0.2)}) {
        const Frame f = renderPlanes(parallelPlanes(kLine), 48, 31, d3dPattern(8), jitterPx);
        const Rgb a = resolved("sbaa:surfaces=8", f), b = resolved("msaa", f);
        for (int y = 0; y < 31; y++)
            for (int x = 0; x < 48; x++) ASSERT_NEAR(a.c[0].at(x, y), b.c[0].at(x, y), 1e-6);
    }
}
// Pieces of one plane are one surface. Two objects are two, unless geometry alone decides: then a decal is not
// anti-aliased.
TEST(Sbaa, CoplanarPiecesMerge) {
    const TestScene decal{{{{0, 0, 1}, -4, glm::vec3(1.0f), 1}, {{0, 0, 1}, -4, glm::vec3(0.0f), 2}}, kLine.visible()};
    const Frame f = renderPlanes(decal, 48, 31, d3dPattern(8));
    EXPECT_TRUE(resolved("sbaa:ids=off", f).samePixels(f.colorLinear));
    const Rgb a = resolved("sbaa", f), b = resolved("msaa", f);
    for (int y = 0; y < 31; y++)
        for (int x = 0; x < 48; x++) ASSERT_NEAR(a.c[0].at(x, y), b.c[0].at(x, y), 1e-6);
    EXPECT_FALSE(a.samePixels(f.colorLinear));
    // Far away a relief is shallower than the plane's tolerance, which is relative to the depth.
    TestScene relief = decal;
    relief.surfaces[0].distance = -46, relief.surfaces[1].distance = -46.3;
    const Frame far = renderPlanes(relief, 48, 31, d3dPattern(8));
    EXPECT_TRUE(resolved("sbaa:ids=off", far).samePixels(far.colorLinear));
    EXPECT_FALSE(resolved("sbaa", far).samePixels(far.colorLinear));
}
// Which member lies nearest to a cluster's centroid is often a tie; float and double must break it alike. Every way in
// which eight sub-samples can fall on two objects, each sub-sample with a colour of its own.
TEST(Sbaa, EveryPrecisionShadesTheSameMember) {
    const TestScene one{{{{0, 0, 1}, -4, glm::vec3(1.0f), 1}}, [](double, double) { return 0; }};
    Frame f = renderPlanes(one, 256, 1, d3dPattern(8));
    for (int x = 0; x < 256; x++)
        for (size_t k = 0; k < 8; k++) {
            f.subSamples[k].objectId.at(x, 0) = x >> k & 1 ? 2 : 1;
            f.subSamples[k].colorLinear.c[0].at(x, 0) = float(1 << k);
        }
    const Rgb fast = resolved("sbaa", f, {bestIsa(), Precision::fast}),
              oracle = resolved("sbaa", f, {bestIsa(), Precision::oracle});
    for (int x = 0; x < 256; x++) EXPECT_FLOAT_EQ(fast.c[0].at(x, 0), oracle.c[0].at(x, 0)) << x;
}
TEST(Sbaa, EmptyAndBrokenGeometry) {
    const TestScene empty{{}, [](double, double) { return -1; }, glm::vec3(0.3f)};
    const Frame sky = renderPlanes(empty, 9, 5, d3dPattern(8));
    EXPECT_TRUE(resolved("sbaa", sky).samePixels(sky.colorLinear));
    Frame f = fourSurfaces();
    for (auto& s : f.subSamples) s.normalWorld = Rgb(1, 1, NAN);
    f.normalWorld = Rgb(1, 1, 0.0f);
    f.subSamples[7].colorLinear.c[0].at(0, 0) = NAN;
    EXPECT_TRUE(std::isfinite(resolved("sbaa", f).c[0].at(0, 0)));
    for (auto& s : f.subSamples) s.colorLinear = Rgb(1, 1, NAN);
    EXPECT_EQ(resolved("sbaa", f).c[0].at(0, 0), 0.0f);
}

}  // namespace
}  // namespace aa
