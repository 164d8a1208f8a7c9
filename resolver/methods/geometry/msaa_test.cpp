#include "methods/geometry/msaa.h"

#include <gtest/gtest.h>

#include "image/error.h"
#include "methods/driver.h"
#include "methods/geometry/geometry_test_frames.h"
#include "methods/method.h"
#include "shot/patterns.h"

namespace aa {
namespace {
using namespace testing;

// conventions 14: coverage of ideal samples gains 8.6 / 12.7 / 15.0 dB on half-planes.
TEST(Msaa, GainOnHalfPlanesIsThatOfCoverage) {
    EXPECT_NEAR(halfPlaneGainDb("msaa", d3dPattern(4)), 8.6, 0.5);
    EXPECT_NEAR(halfPlaneGainDb("msaa", d3dPattern(8)), 12.7, 0.5);
    EXPECT_NEAR(halfPlaneGainDb("msaa", d3dPattern(16)), 15.0, 0.5);
    EXPECT_NEAR(halfPlaneGainDb("msaa:key=object", d3dPattern(2)), 3.4, 0.5);
}
// Shaded once per surface of one colour, so it is the mean of the sub-samples: supersampling.
TEST(Msaa, EqualsSsaaWhereSurfacesHaveOneColour) {
    for (const char* method : {"msaa", "msaa:key=object", "msaa:shadingPosition=centroid", "csaa:slots=8"}) {
        const Frame f = renderPlanes(parallelPlanes(kLine), 48, 31, d3dPattern(8));
        const Rgb a = resolved(method, f), b = resolved("ssaa", f);
        for (int y = 0; y < 31; y++)
            for (int x = 0; x < 48; x++) ASSERT_NEAR(a.c[0].at(x, y), b.c[0].at(x, y), 1e-6) << method;
    }
}
// Two faces of one object: a triangle id would split them, and so does their geometry; the object id does not.
TEST(Msaa, SurfacesOfOneObjectAreSplitByGeometry) {
    TestScene scene = parallelPlanes(kLine);
    for (auto& s : scene.surfaces) s.objectId = 7;
    const Frame f = renderPlanes(scene, 48, 31, d3dPattern(8));
    EXPECT_FALSE(resolved("msaa", f).samePixels(f.colorLinear));
    EXPECT_TRUE(resolved("msaa:key=object", f).samePixels(f.colorLinear));
}
// A texture aliases as without anti-aliasing: the sub-samples' own colours are not looked at.
TEST(Msaa, ShadingAliasingIsNotTouched) {
    const TestScene wall{{{{0, 0, 1}, -4, glm::vec3(1.0f), 1}}, [](double, double) { return 0; }};
    Frame f = renderPlanes(wall, 20, 9, d3dPattern(8));
    for (int x = 0; x < 20; x++) f.colorLinear.c[1].at(x, 4) = float(x % 2);
    EXPECT_TRUE(resolved("msaa", f).samePixels(f.colorLinear));
    EXPECT_TRUE(resolved("csaa", f).samePixels(f.colorLinear));
}
TEST(Msaa, OneSampleAtTheCentreIsNoaa) {
    const Frame f = renderPlanes(parallelPlanes(kLine), 48, 31, {{0, 0}});
    EXPECT_TRUE(resolved("msaa", f).samePixels(f.colorLinear));
}
// One pixel: the left half is surface 0, the right half surface 1, with colours that differ at every sub-sample.
Frame halves() {
    Frame f = renderPlanes({{{{0, 0, 1}, -4, glm::vec3(0.0f), 1}, {{0, 0, 1}, -9, glm::vec3(0.0f), 2}},
                            [](double x, double) { return x < 0.6 ? 0 : 1; }},
                           1, 1, d3dPattern(8));
    f.colorLinear.c[0].at(0, 0) = 100;
    for (size_t k = 0; k < 8; k++) f.subSamples[k].colorLinear.c[0].at(0, 0) = float(k + 1);
    return f;
}
// Display-space resolve (conventions 4): every colour goes through the chain before the mean is taken.
TEST(Msaa, EncodedSpaceAveragesDisplayedValues) {
    Frame f = renderPlanes(parallelPlanes(kLine), 48, 31, d3dPattern(8));
    std::vector<Rgb*> colours = {&f.colorLinear};
    for (auto& s : f.subSamples) colours.push_back(&s.colorLinear);
    for (Rgb* colour : colours)
        for (auto& channel : colour->c)
            for (int y = 0; y < 31; y++)
                for (int x = 0; x < 48; x++) channel.at(x, y) = 0.1f + 0.4f * channel.at(x, y);
    for (const DisplayChain chain : {DisplayChain{}, DisplayChain{1.0f, ToneMap::reinhard}}) {
        encodeFrame(f, chain, {});
        Frame shown = f;
        for (auto& s : shown.subSamples) encode(s.colorLinear, chain, {}, s.colorLinear);
        shown.colorLinear = f.colorEncoded;
        for (const char* method : {"msaa", "csaa:slots=4", "ssaa", "msaa:filter=tent"}) {
            const std::string space = std::string(method).find(':') == std::string::npos ? ":space=" : ",space=";
            const Rgb a = resolved(method + space + "encoded", f), b = resolved(method + space + "linear", shown);
            EXPECT_FALSE(resolved(method + space + "linear", f).samePixels(a))
                << method << ": the test must be able to fail";
            for (int y = 0; y < 31; y++)
                for (int x = 0; x < 48; x++) ASSERT_NEAR(a.c[0].at(x, y), b.c[0].at(x, y), 1e-6) << method;
        }
    }
    const Rgb ringing = resolved("msaa:filter=lanczos,space=encoded", f);
    for (int y = 0; y < 31; y++)
        for (int x = 0; x < 48; x++) {
            EXPECT_GE(ringing.c[0].at(x, y), 0.0f);
            EXPECT_LE(ringing.c[0].at(x, y), 1.0f);
        }
}
TEST(Msaa, ShadesAtTheCentreOrAtTheNearestCoveredSample) {
    const Frame f = halves();
    // Samples 2, 6 and 7 (x = 5, 3, 7 sixteenths) lie right of 0.6; the nearest to the centre is 2, of colour 3.
    EXPECT_FLOAT_EQ(resolved("msaa", f).c[0].at(0, 0), (5 * 100 + 3 * 3) / 8.0f);
    // Of the five on the left, samples 0 and 1 are nearest; the first wins the tie.
    EXPECT_FLOAT_EQ(resolved("msaa:shadingPosition=centroid", f).c[0].at(0, 0), (5 * 1 + 3 * 3) / 8.0f);
    const double w0 = 5 / (1 + 0.2126 * 100), w1 = 3 / (1 + 0.2126 * 3);
    EXPECT_NEAR(resolved("msaa:resolve=inverseLuminance", f).c[0].at(0, 0), (w0 * 100 + w1 * 3) / (w0 + w1), 1e-4);
}
// Filters weigh the sub-samples of the neighbourhood, each in its surface's one colour: on surfaces of one colour that
// is `resolve` on supersampled colours.
TEST(Msaa, FiltersWeighTheSurfacesColours) {
    const Frame f = renderPlanes(parallelPlanes(kLine), 48, 31, d3dPattern(8));
    Frame shaded = f;
    for (auto& s : shaded.subSamples) s.colorLinear.fillBorder();
    for (const char* filter : {"filter=tent", "filter=mitchell,diameter=4", "filter=lanczos", "filter=gaussian"}) {
        const std::string options = std::string(":") + filter;
        for (const char* method : {"msaa", "csaa"}) {
            const Rgb a = resolved(method + options + (method[0] == 'c' ? ",slots=8" : ""), f);
            const Rgb b = resolved("resolve" + options, shaded);
            for (int y = 0; y < 31; y++)
                for (int x = 0; x < 48; x++)
                    ASSERT_NEAR(a.c[0].at(x, y), b.c[0].at(x, y), 1e-5) << method << options << x << "," << y;
        }
    }
    // A pixel of one surface shows what it was shaded with, a firefly in a sub-sample's own colour counts for nothing.
    const TestScene wall{{{{0, 0, 1}, -4, glm::vec3(0.25f), 1}}, [](double, double) { return 0; }};
    Frame flat = renderPlanes(wall, 20, 9, d3dPattern(4));
    for (auto& s : flat.subSamples) s.colorLinear = Rgb(20, 9, 1e6f);
    EXPECT_TRUE(resolved("msaa:filter=tent", flat).samePixels(flat.colorLinear));
    // A surface that is not finite is left out of its own pixel and reaches no other.
    Frame broken = f;
    for (auto& s : broken.subSamples) s.colorLinear.c[0].at(20, 15) = NAN;
    const Rgb out = resolved("msaa:filter=tent", broken);
    for (int x = 15; x < 26; x++) EXPECT_TRUE(std::isfinite(out.c[0].at(x, 15))) << x;
}
// Half of the centre sample and an eighth of the four corners, which are shared with three neighbours.
TEST(Msaa, QuincunxSharesTheCorners) {
    const auto positionsPx = patternPositionsPx("quincunx");
    const TestScene scene{{{{0, 0, 1}, -4, glm::vec3(1.0f), 1}, {{0, 0, 1}, -9, glm::vec3(0.0f), 2}},
                          [](double x, double) { return x < 2.2 ? 0 : 1; }};
    const Frame f = renderPlanes(scene, 5, 4, positionsPx);
    const Rgb out = resolved("msaa:filter=quincunx", f);
    // Pixel 2 shows the dark surface; its left corners, at x = 2, are bright. Pixel 1 is bright, its right corners too.
    EXPECT_EQ(f.colorLinear.c[0].at(2, 1), 0.0f);
    EXPECT_FLOAT_EQ(out.c[0].at(2, 1), 0.25f);
    EXPECT_EQ(out.c[0].at(1, 1), 1.0f);
    EXPECT_EQ(out.c[0].at(3, 1), 0.0f);
    Frame shaded = f;
    for (auto& s : shaded.subSamples) s.colorLinear.fillBorder();
    EXPECT_FLOAT_EQ(resolved("resolve:filter=quincunx", shaded).c[0].at(2, 1), 0.25f);
    EXPECT_THROW(resolved("msaa:filter=quincunx", renderPlanes(scene, 5, 4, d3dPattern(2))), InputError);
    EXPECT_THROW(resolved("resolve:filter=quincunx", renderPlanes(scene, 5, 4, d3dPattern(4))), InputError);
    EXPECT_THROW(parseMethod("msaa:filter=quincunx,diameter=3"), UsageError);
    EXPECT_THROW(parseMethod("msaa:filter=tent,resolve=inverseLuminance"), UsageError);
    // Two samples per pixel that count as five. The corner alone (d3d2 has two inside) says less of the coverage.
    EXPECT_NEAR(halfPlaneGainDb("msaa:filter=quincunx", positionsPx), 3.5, 3.5);
}
TEST(Csaa, CoverageSamplesCountForStoredSurfacesOnly) {
    const Frame f = halves();
    // Slots 0..3: 0, 1, 3 left and 2 right; coverage samples 4, 5 left and 6, 7 right find their surface.
    EXPECT_TRUE(resolved("csaa:slots=4", f).samePixels(resolved("msaa", f)));
    EXPECT_TRUE(resolved("csaa:slots=8", f).samePixels(resolved("msaa", f)));
    // Slots 0 and 1 know the left surface only: everything counts for it.
    EXPECT_FLOAT_EQ(resolved("csaa:slots=2", f).c[0].at(0, 0), 100);
    EXPECT_THROW(resolved("csaa:slots=9", f), UsageError);
    // The first four positions of the D3D patterns are near the centre: an edge that passes them all falls back.
    EXPECT_NEAR(halfPlaneGainDb("csaa", d3dPattern(8)), 7.6, 0.5);
    EXPECT_NEAR(halfPlaneGainDb("csaa", d3dPattern(16)), 5.8, 0.5);
    EXPECT_NEAR(halfPlaneGainDb("csaa:slotPositions=spread", d3dPattern(8)), 11.0, 0.5);
    EXPECT_NEAR(halfPlaneGainDb("csaa:slotPositions=spread", d3dPattern(16)), 14.8, 0.5);
}
// An unresolved sample counts for the slot nearest in position, not for the first one.
TEST(Csaa, UnresolvedSamplesCountForTheNearestSlot) {
    // Slots 0..3 see three vertical bands; sample 6 at (3, 7)/16 sees a fourth surface, and the slot nearest to it
    // is 1.
    const TestScene scene{{{{0, 0, 1}, -4, glm::vec3(1.0f), 1},
                           {{0, 0, 1}, -5, glm::vec3(2.0f), 2},
                           {{0, 0, 1}, -6, glm::vec3(4.0f), 3},
                           {{0, 0, 1}, -7, glm::vec3(64.0f), 4}},
                          [](double x, double y) {
                              return y > 0.9 ? 3 : x < 0.45 ? 0 : x < 0.6 ? 1 : 2;
                          }};
    const Frame f = renderPlanes(scene, 1, 1, d3dPattern(8));
    EXPECT_FLOAT_EQ(resolved("csaa:slots=4", f).c[0].at(0, 0), (5 * 1 + 2 + 2 * 4) / 8.0f);
    EXPECT_FLOAT_EQ(resolved("msaa", f).c[0].at(0, 0), (4 * 1 + 2 + 2 * 4 + 64) / 8.0f);
}
TEST(Msaa, ExtremeColoursAndEmptyPixels) {
    Frame f = halves();
    f.subSamples[2].colorLinear.c[0].at(0, 0) = NAN;  // the right surface's colour
    EXPECT_FLOAT_EQ(resolved("msaa", f).c[0].at(0, 0), 100);
    f.colorLinear.c[0].at(0, 0) = INFINITY;
    EXPECT_EQ(resolved("msaa", f).c[0].at(0, 0), 0.0f);
    const TestScene empty{{}, [](double, double) { return -1; }, glm::vec3(0.3f)};
    const Frame sky = renderPlanes(empty, 9, 5, d3dPattern(8));
    EXPECT_TRUE(resolved("msaa", sky).samePixels(sky.colorLinear));
}
// conventions 11: the weights sum to 1 however many surfaces share the pixel, and nothing is clamped.
TEST(Msaa, WeightsSumToOneAndFirefliesCountInFull) {
    const TestScene crowd{{{{0, 0, 1}, -4, glm::vec3(0.1f), 1},
                           {{0, 0, 1}, -5, glm::vec3(0.1f), 2},
                           {{0, 0, 1}, -6, glm::vec3(0.1f), 3},
                           {{0, 0, 1}, -7, glm::vec3(0.1f), 4}},
                          [](double x, double y) { return int(std::floor(x * 7.3) + std::floor(y * 5.7)) & 3; }};
    Frame f = renderPlanes(crowd, 12, 9, d3dPattern(16));
    for (const char* method : {"msaa", "csaa", "sbaa", "sbaa:surfaces=4", "msaa:filter=tent", "msaa:key=object"})
        EXPECT_TRUE(resolved(method, f).samePixels(f.colorLinear)) << method;
    Frame bright = renderPlanes(parallelPlanes({1, 0, 2.9}), 5, 3, d3dPattern(16));
    EXPECT_EQ(bright.colorLinear.c[0].at(2, 1), 0.0f);
    for (auto& s : bright.subSamples) s.colorLinear.c[0].at(2, 1) = 1e6f;
    EXPECT_FLOAT_EQ(resolved("msaa", bright).c[0].at(2, 1), 62500.0f);  // one of 16 samples, 7 sixteenths right
}
TEST(Msaa, LayersShowSurfacesAndCoverage) {
    std::vector<DebugLayer> layers;
    const Frame f = halves();
    resolved("msaa", f, {}, &layers);
    EXPECT_EQ(layer(layers, "surfaces").at(0, 0), 2.0f);
    EXPECT_EQ(layer(layers, "centreCoverage").at(0, 0), 0.625f);
}

}  // namespace
}  // namespace aa
