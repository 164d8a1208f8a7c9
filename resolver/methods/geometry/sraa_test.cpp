#include "methods/geometry/sraa.h"

#include <gtest/gtest.h>

#include "methods/geometry/geometry_test_frames.h"
#include "methods/method.h"

namespace aa {
namespace {
using namespace testing;

// With telling geometry and constant colours it is coverage MSAA (conventions 14): 8.6 / 12.7 / 15.0 dB.
TEST(Sraa, GainOnHalfPlanesIsThatOfCoverage) {
    for (const char* method :
         {"sraa", "sraa:metric=max", "sraa:radius=2", "sraa:distance=depth", "sraa:ids=depth", "sraa:ids=always"}) {
        EXPECT_NEAR(halfPlaneGainDb(method, d3dPattern(4)), 8.6, 0.5) << method;
        EXPECT_NEAR(halfPlaneGainDb(method, d3dPattern(8)), 12.7, 0.5) << method;
    }
    EXPECT_NEAR(halfPlaneGainDb("sraa", d3dPattern(16)), 15.0, 0.5);
}
// The weights of one sub-sample at known places on one plane are the Gaussians of their distances.
TEST(Sraa, WeightsOnOnePlaneAreSpatialGaussians) {
    const TestScene wall{{{{0, 0, 1}, -4, glm::vec3(0.0f), 1}}, [](double, double) { return 0; }};
    Frame f = renderPlanes(wall, 5, 5, {{0.25, -0.125}});
    f.colorLinear.c[0].at(3, 1) = 1;  // upper right of the middle pixel: toward the sub-sample
    double sum = 0, own = 0;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++) {
            const double w = std::exp(-(std::pow(dx - 0.25, 2) + std::pow(dy + 0.125, 2)) / (2 * 0.25));
            sum += w;
            if (dx == 1 && dy == -1) own = w;
        }
    EXPECT_NEAR(resolved("sraa", f).c[0].at(2, 2), own / sum, 1e-5);
    Frame mirrored = renderPlanes(wall, 5, 5, {{-0.25, 0.125}});
    mirrored.colorLinear = f.colorLinear;
    EXPECT_GT(std::abs(resolved("sraa", mirrored).c[0].at(2, 2) - own / sum), 0.02);  // a wrong sign shows
}
// A floor seen at a grazing angle is one plane, though depths differ by much more than sigmaZ from row to row.
TEST(Sraa, TangentPlanesForgiveSlopes) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.02, 1, 0.05));
    const TestScene floor{{{n, -1.5, glm::vec3(1.0f), 1}}, [](double, double) { return 0; }};
    const auto ownShare = [&](const char* method, glm::dvec2 jitterPx) {
        std::vector<DebugLayer> layers;
        Frame f = renderPlanes({floor.surfaces, [](double, double y) { return y > 18 ? 0 : -1; }}, 33, 31,
                               d3dPattern(4), jitterPx);
        resolved(method, f, {}, &layers);
        return layer(layers, "ownShare").at(16, 22);
    };
    for (const glm::dvec2 jitterPx : {glm::dvec2(0), glm::dvec2(0.25, -0.4)}) {
        const float spatialOnly = ownShare("sraa:sigmaZ=10", jitterPx);
        EXPECT_NEAR(ownShare("sraa", jitterPx), spatialOnly, 0.02);
    }
    EXPECT_GT(ownShare("sraa:distance=depth", {0, 0}), ownShare("sraa", {0, 0}) + 0.1);
}
// Letters on a wall, seen from afar: only the ids tell them apart, and with them it is coverage again.
TEST(Sraa, ObjectsOfOnePlaneAreToldApartByTheirIds) {
    const auto flat = [](Frame& f, const Line& line) {
        TestScene scene = parallelPlanes(line);
        for (auto& s : scene.surfaces) s.distance = -4;
        f = renderPlanes(scene, f.width, f.height, f.subSamplePositionsPx);
    };
    EXPECT_NEAR(halfPlaneGainDb("sraa:ids=always", d3dPattern(8), flat), 12.7, 0.5);
    EXPECT_LT(halfPlaneGainDb("sraa:ids=depth", d3dPattern(8), flat), 9.0);
    EXPECT_LT(halfPlaneGainDb("sraa", d3dPattern(8), flat), 9.0);
}
// Lanes give pixels of one plane the weights of that plane and compute the others on a list; one lane computes them
// all. Floors bent by every amount around the limit, noise of colours everywhere, a silhouette, sky, lost normals.
TEST(Sraa, PixelsOfOnePlaneAreNoSpecialCase) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.02, 1, 0.05));
    const TestScene scene{{{n, -1.5, glm::vec3(1.0f), 1}, {{0, 0, 1}, -9, glm::vec3(0.5f), 2}}, [](double x, double y) {
                              return y > 22 + 0.2 * x ? 0 : y > 9 ? 1 : -1;
                          }};
    for (const char* method : {"sraa", "sraa:radius=2", "sraa:distance=depth", "sraa:ids=always", "sraa:sigmaX=4",
                               "sraa:sigmaZ=0.5,sigmaN=2"})
        for (const double bend : {0.0, 1e-7, 1e-6, 1e-5, 1e-3}) {
            Frame f = renderPlanes(scene, 77, 43, d3dPattern(8), {0.2, -0.3});
            uint32_t state = 1;
            const auto noise = [&] {
                state = state * 1664525u + 1013904223u;
                return float(state >> 8) / 16777216.0f;
            };
            const auto bent = [&](PlaneF& depth, Rgb& normal, int x, int y) {
                depth.at(x, y) *= float(1 + bend * (noise() - 0.5f));
                normal.c[0].at(x, y) += float(bend * 40 * (noise() - 0.5f));
            };
            for (int y = 0; y < 43; y++)
                for (int x = 0; x < 77; x++) {
                    bent(f.depthView, f.normalWorld, x, y);
                    for (auto& s : f.subSamples) bent(s.depthView, s.normalWorld, x, y);
                    for (auto& c : f.colorLinear.c) c.at(x, y) = noise();
                }
            f.normalWorld.c[1].at(40, 38) = NAN, f.subSamples[3].depthView.at(60, 40) = NAN;
            f.depthView.fillBorder(), f.normalWorld.fillBorder(), f.colorLinear.fillBorder();
            for (auto& s : f.subSamples) s.depthView.fillBorder(), s.normalWorld.fillBorder();
            std::vector<DebugLayer> lanes, single;
            Exec one;
            one.precision = Precision::scalar;
            const Rgb a = resolved(method, f, {}, &lanes), b = resolved(method, f, one, &single);
            EXPECT_TRUE(a.samePixels(b)) << method << " " << bend;
            EXPECT_TRUE(layer(lanes, "ownShare").samePixels(layer(single, "ownShare"))) << method << " " << bend;
        }
}
// conventions 11: all weights may underflow; the nearest match is then taken, never 0/0.
TEST(Sraa, UnlikeNeighboursAndLoneSamplesStayFinite) {
    Frame f = renderPlanes(parallelPlanes(kLine), 33, 21, d3dPattern(4));
    for (const char* method : {"sraa:sigmaZ=0.0001,sigmaN=0.001", "sraa:metric=max,sharpness=10000", "sraa"}) {
        for (auto& p : f.subSamples[2].normalWorld.c) p.at(7, 7) = NAN;
        f.subSamples[1].depthView.at(9, 9) = 2.0f;   // seen by no pixel
        f.subSamples[1].depthView.at(5, 3) = 1e10f;  // background that no pixel shows: own colour
        const Rgb out = resolved(method, f);
        for (int y = 0; y < 21; y++)
            for (int x = 0; x < 33; x++) {
                ASSERT_GE(out.c[0].at(x, y), -1e-6f) << method << x << "," << y;
                ASSERT_LE(out.c[0].at(x, y), 1 + 1e-6f) << method << x << "," << y;
            }
    }
    const TestScene empty{{}, [](double, double) { return -1; }, glm::vec3(0.3f)};
    const Frame sky = renderPlanes(empty, 9, 5, d3dPattern(8));
    EXPECT_TRUE(resolved("sraa", sky).samePixels(sky.colorLinear));
}

}  // namespace
}  // namespace aa
