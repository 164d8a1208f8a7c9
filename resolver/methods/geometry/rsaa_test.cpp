#include "methods/geometry/rsaa.h"

#include <gtest/gtest.h>

#include "image/error.h"
#include "methods/geometry/geometry_test_frames.h"
#include "methods/geometry/rsaa_lut_data.h"
#include "methods/method.h"
#include "shot/synth/synth.h"

namespace aa {
namespace {
using namespace testing;

std::string geometryOnly(const std::string& more = "") { return "rsaa:ids=off" + (more.empty() ? "" : "," + more); }

// --- Quality --------------------------------------------------------------------------------------------------------

TEST(Rsaa, GainOnHalfPlanesWithIdealMasks) {
    EXPECT_GE(halfPlaneGainDb("rsaa:mask=pass,tuning=off", d3dPattern(4)), 9.5);
    EXPECT_GE(halfPlaneGainDb("rsaa:mask=pass,tuning=off", d3dPattern(8)), 13.0);
    EXPECT_GE(halfPlaneGainDb("rsaa:mask=pass,tuning=off", d3dPattern(16)), 17.0);
}
TEST(Rsaa, GainOnHalfPlanesWithSadpMasks) {
    EXPECT_GE(halfPlaneGainDb(geometryOnly(), d3dPattern(4)), 9.0);
    EXPECT_GE(halfPlaneGainDb(geometryOnly(), d3dPattern(8)), 12.0);
    EXPECT_GE(halfPlaneGainDb(geometryOnly(), d3dPattern(16)), 15.0);
}
// A pattern that is none of the shipped ones is learned when the method is made.
TEST(Rsaa, OtherPatternsAreLearned) {
    auto positionsPx = d3dPattern(8);
    for (auto& p : positionsPx) p = {p.y, p.x};
    EXPECT_GE(halfPlaneGainDb("rsaa:mask=pass,tuning=off", positionsPx), 13.0);
}
// Would the tests above see a wrong sign, axis or bit order?
TEST(Rsaa, WrongSignsAreSeen) {
    const auto gainWith = [](auto&& wrong) {
        return halfPlaneGainDb("rsaa:mask=pass,tuning=off", d3dPattern(8), [&](Frame& f, const Line& line) {
            auto positionsPx = f.subSamplePositionsPx;
            for (auto& p : positionsPx) p = wrong(p);
            f.subSampleMask = renderPlanes(parallelPlanes(line), f.width, f.height, positionsPx).subSampleMask;
        });
    };
    EXPECT_GE(gainWith([](glm::dvec2 p) { return p; }), 13.0);
    EXPECT_LT(gainWith([](glm::dvec2 p) { return glm::dvec2(p.x, -p.y); }), 9.0);
    EXPECT_LT(gainWith([](glm::dvec2 p) { return glm::dvec2(-p.x, p.y); }), 9.0);
    EXPECT_LT(gainWith([](glm::dvec2 p) { return glm::dvec2(p.y, p.x); }), 9.0);
    const auto reversed = [](Frame& f, const Line&) {
        for (int y = 0; y < f.height; y++)
            for (int x = 0; x < f.width; x++) {
                uint32_t &m = f.subSampleMask.at(x, y), r = 0;
                for (int k = 0; k < 8; k++) r |= (m >> k & 1u) << (7 - k);
                m = r;
            }
    };
    EXPECT_LT(halfPlaneGainDb("rsaa:mask=pass,tuning=off", d3dPattern(8), reversed), 9.0);
}

// --- Dissimilarity and masks ----------------------------------------------------------------------------------------

// Two walls that meet at a right angle, their common edge along the line's direction x = const.
TestScene corner(double edgeX, int w, int h) {
    const Camera c = testCamera(w, h);
    const double ndc = (2 * edgeX / w - 1) / c.projection[0][0];
    const glm::dvec3 edge = 6.0 * glm::dvec3(ndc, 0, -1);  // a point of the edge; the edge runs along view y
    const glm::dvec3 left(std::sqrt(0.5), 0, std::sqrt(0.5)), right(-std::sqrt(0.5), 0, std::sqrt(0.5));
    return {{{left, glm::dot(left, edge), glm::vec3(1.0f), 1}, {right, glm::dot(right, edge), glm::vec3(0.0f), 1}},
            [edgeX](double x, double) { return x < edgeX ? 0 : 1; }};
}
const PlaneF& dissimilarityOf(const std::string& method, const Frame& f, std::vector<DebugLayer>& layers) {
    resolved(method, f, {}, &layers);
    return layer(layers, "dissimilarity");
}

TEST(Rsaa, SadpOfPlanesCornersAndOccluders) {
    std::vector<DebugLayer> layers;
    const Frame crease = renderPlanes(corner(16.3, 33, 21), 33, 21, d3dPattern(8));
    const PlaneF d = dissimilarityOf(geometryOnly(), crease, layers);
    EXPECT_NEAR(d.at(16, 10), 1.414, 0.25);  // some chord directions lean toward one of the walls
    EXPECT_EQ(d.at(10, 10), 0.0f);           // within a wall
    const Frame steps = renderPlanes(parallelPlanes(kLine), 33, 21, d3dPattern(8));
    const PlaneF s = dissimilarityOf(geometryOnly(), steps, layers);
    EXPECT_NEAR(*std::max_element(s.row(10), s.row(10) + 33), 2.0, 0.02);  // a little less off the picture's middle
}
// Depth cannot see a corner and normals cannot see one surface before another; SADP sees both.
TEST(Rsaa, EachMeasureFailsWhereTheTalkSaysItDoes) {
    const Frame crease = renderPlanes(corner(16.3, 33, 21), 33, 21, d3dPattern(8));
    const Frame steps = renderPlanes(parallelPlanes(kLine), 33, 21, d3dPattern(8));
    const auto changes = [](const std::string& measure, const Frame& f) {
        return !resolved(geometryOnly("measure=" + measure), f).samePixels(f.colorLinear);
    };
    EXPECT_TRUE(changes("sadp", crease));
    EXPECT_TRUE(changes("sadp", steps));
    EXPECT_FALSE(changes("depth", crease));
    EXPECT_TRUE(changes("depth", steps));
    EXPECT_TRUE(changes("normal", crease));
    EXPECT_FALSE(changes("normal", steps));
}
void expectSameMasks(const Frame& f, const std::string& method) {
    std::vector<DebugLayer> layers;
    resolved(method, f, {}, &layers);
    const PlaneF& mask = layer(layers, "mask");
    int different = 0;
    for (int y = 0; y < f.height; y++)
        for (int x = 0; x < f.width; x++) different += mask.at(x, y) != float(f.subSampleMask.at(x, y));
    EXPECT_EQ(different, 0) << method;
}
TEST(Rsaa, GeometryFindsTheMasksOfTheMaskPass) {
    for (const size_t samples : {4u, 8u, 16u}) {
        const Frame steps = renderPlanes(parallelPlanes(kLine), 48, 31, d3dPattern(samples));
        const Frame crease = renderPlanes(corner(16.3, 48, 31), 48, 31, d3dPattern(samples));
        for (const Frame* f : {&steps, &crease}) {
            expectSameMasks(*f, geometryOnly());
            expectSameMasks(*f, geometryOnly("clustering=threshold"));
            for (const char* tuning : {"on", "off", "adaptive"}) {
                const std::string t = std::string("tuning=") + tuning;
                EXPECT_TRUE(resolved("rsaa:mask=pass," + t, *f).samePixels(resolved("rsaa:mask=geometry," + t, *f)));
            }
        }
    }
}
// The mask pass of a shot, jittered or not, is what its geometry says: whole pictures, several surfaces in a pixel.
TEST(Rsaa, GeometryFindsTheMasksOfAnalyticShots) {
    for (const char* scene : {"half_planes", "two_planes", "moving", "thin_lines", "circles", "thin_motion"})
        for (const char* pattern : {"d3d4", "d3d8", "d3d16"}) {
            SynthOptions o;
            o.scene = scene, o.subsamples = pattern;
            o.width = 121, o.height = 77, o.frames = 3;
            const SynthShot shot(o);
            for (const Sampling sampling : {Sampling::centre, Sampling::jittered}) {
                const Frame f = shot.frame(2, sampling);
                expectSameMasks(f, "rsaa:mask=geometry");
                EXPECT_TRUE(resolved("rsaa:mask=pass", f).samePixels(resolved("rsaa:mask=geometry", f)))
                    << scene << pattern;
            }
        }
}
// The pass is read where it was made by the same parameters, and only there.
TEST(Rsaa, AutoMasksAreThePassOfTheDefaults) {
    Frame f = renderPlanes(parallelPlanes(kLine), 48, 31, d3dPattern(8));
    for (int y = 0; y < 31; y++)
        for (int x = 0; x < 48; x++) f.subSampleMask.at(x, y) ^= 1;  // nothing that geometry would give
    const auto same = [&](const std::string& a, const std::string& b) {
        return resolved("rsaa:" + a, f).samePixels(resolved("rsaa:" + b, f));
    };
    EXPECT_TRUE(same("tuning=off", "tuning=off,mask=pass"));
    EXPECT_TRUE(same("tuning=off,training=halfPlanes", "tuning=off,training=halfPlanes,mask=pass"));
    EXPECT_FALSE(same("tuning=off", "tuning=off,mask=geometry"));
    for (const char* other : {"measure=depth", "measure=normal", "ids=off", "clustering=threshold", "sadpFloor=0.3"}) {
        const std::string o = std::string("tuning=off,") + other;
        EXPECT_TRUE(same(o, o + ",mask=geometry")) << other;
    }
}
// A frame's samples are jittered together: the vectors between them are those of the pattern.
TEST(Rsaa, JitteredFramesGiveTheMasksOfTheirCentreSample) {
    for (const glm::dvec2 jitterPx : {glm::dvec2(0.375, -0.277), glm::dvec2(-0.4375, 0.389)}) {
        expectSameMasks(renderPlanes(parallelPlanes(kLine), 48, 31, d3dPattern(8), jitterPx), geometryOnly());
        // A plane seen at a grazing angle: wrong offsets would leave it.
        const glm::dvec3 n = glm::normalize(glm::dvec3(0.05, 1, 0.1));
        const TestScene floor{{{n, -1.5, glm::vec3(1.0f), 1}}, [](double, double y) { return y > 22 ? 0 : -1; }};
        Frame f = renderPlanes(floor, 48, 31, d3dPattern(8), jitterPx);
        expectSameMasks(f, geometryOnly());
        for (auto& p : f.subSamplePositionsPx) p -= jitterPx;  // as if the jitter had moved the centre sample alone
        std::vector<DebugLayer> layers;
        resolved(geometryOnly(), f, {}, &layers);
        bool seen = false;
        for (int x = 0; x < 48; x++) seen = seen || layer(layers, "dissimilarity").at(x, 28) > 0;
        EXPECT_TRUE(seen) << "wrong offsets must show";
    }
}
// Positions 1e5 times farther away than apart: float keeps the direction because depths are subtracted, not positions.
TEST(Rsaa, FarSurfacesKeepTheirMasks) {
    for (const double scale : {1e-3, 1.0, 1e4}) {
        TestScene scene = corner(16.3, 48, 31);
        for (auto& s : scene.surfaces) s.distance *= scale;
        const Frame f = renderPlanes(scene, 48, 31, d3dPattern(8));
        expectSameMasks(f, geometryOnly());
    }
}
TEST(Rsaa, ObjectsOnOnePlaneDifferByTheirIds) {
    const TestScene decal{{{{0, 0, 1}, -4, glm::vec3(1.0f), 1}, {{0, 0, 1}, -4, glm::vec3(0.0f), 2}}, kLine.visible()};
    const Frame f = renderPlanes(decal, 48, 31, d3dPattern(8));
    expectSameMasks(f, "rsaa:mask=geometry");
    EXPECT_TRUE(resolved(geometryOnly(), f).samePixels(f.colorLinear));  // the talk's measure cannot see it
}

// --- Clustering and tuning ------------------------------------------------------------------------------------------

// One k-means iteration: a bumpy surface (0.3) before a far one (2) counts as one surface; a fixed floor splits it.
TEST(Rsaa, AdaptiveClusteringFollowsTheSpread) {
    const double tilt = std::acos(1 - 0.3);
    const TestScene scene{{{{0, 0, 1}, -4, glm::vec3(1.0f), 1},
                           {{std::sin(tilt), 0, std::cos(tilt)}, -4 * std::cos(tilt), glm::vec3(0.8f), 1},
                           {{0, 0, 1}, -9, glm::vec3(0.0f), 2}},
                          [](double x, double y) { return x < 1.6    ? 0
                                                          : y < 1.75 ? 1
                                                                     : 2; }};
    const Frame f = renderPlanes(scene, 3, 3, d3dPattern(8));
    std::vector<DebugLayer> layers;
    const auto maskOf = [&](const std::string& method) {
        resolved(method, f, {}, &layers);
        return unsigned(layer(layers, "mask").at(1, 1));
    };
    unsigned nearHalf = 0, slanted = 0;
    for (size_t k = 0; k < 8; k++) {
        const glm::dvec2 p = f.subSamplePositionsPx[k];
        nearHalf |= unsigned(1.5 + p.x < 1.6) << k;
        slanted |= unsigned(1.5 + p.x >= 1.6 && 1.5 + p.y < 1.75) << k;
    }
    EXPECT_EQ(maskOf("rsaa:measure=normal,ids=on,clustering=adaptive"), nearHalf | slanted);
    EXPECT_EQ(maskOf("rsaa:measure=normal,ids=on,clustering=threshold"), nearHalf);
}

// A speck that no neighbouring pixel's centre shows: without tuning its colour is looked for where it is not.
TEST(Rsaa, TuningDropsWhatTheNeighboursDoNotShow) {
    const TestScene scene{{{{0, 0, 1}, -9, glm::vec3(0.25f), 1},
                           {{0, 0, 1}, -4, glm::vec3(1.0f), 2},
                           {{0, 0, 1}, -6, glm::vec3(0.0f), 3}},
                          [](double x, double y) {
                              // Pixel (2, 2) has a speck on its right; pixel (3, 2) is a third surface.
                              return x > 2.7 && x < 3 && y > 2 && y < 3 ? 1 : x >= 3 ? 2 : 0;
                          }};
    const Frame f = renderPlanes(scene, 6, 5, d3dPattern(8));
    std::vector<DebugLayer> layers;
    const Rgb tuned = resolved("rsaa", f, {}, &layers);
    EXPECT_NE(layer(layers, "mask").at(2, 2), 255.0f);
    EXPECT_EQ(layer(layers, "tunedMask").at(2, 2), 255.0f);
    EXPECT_EQ(tuned.c[0].at(2, 2), 0.25f);
    EXPECT_LT(resolved("rsaa:tuning=off", f).c[0].at(2, 2), 0.25f);  // mixed with the black third surface
    EXPECT_EQ(resolved("rsaa:neighbours=nearest", f).c[0].at(2, 2), 0.25f);
    // A surface that continues into the neighbour is kept.
    const Frame steps = renderPlanes(parallelPlanes(kLine), 48, 31, d3dPattern(8));
    resolved("rsaa", steps, {}, &layers);
    int kept = 0, all = 0;
    for (int y = 1; y < 30; y++)
        for (int x = 1; x < 47; x++) {
            const float m = layer(layers, "mask").at(x, y);
            if (m != 255.0f) all++, kept += layer(layers, "tunedMask").at(x, y) == m;
        }
    EXPECT_GT(all, 20);
    EXPECT_EQ(kept, all);
}
// The single nearest neighbour misses surfaces that continue across the pixel's other side: the reason for the default.
TEST(Rsaa, TuningCostsNothingOnIsolatedEdges) {
    const auto positionsPx = d3dPattern(8);
    const double untuned = halfPlaneGainDb(geometryOnly("tuning=off"), positionsPx);
    EXPECT_NEAR(halfPlaneGainDb(geometryOnly("tuning=on"), positionsPx), untuned, 0.05);
    EXPECT_NEAR(halfPlaneGainDb(geometryOnly("tuning=adaptive"), positionsPx), untuned, 0.05);
    EXPECT_LT(halfPlaneGainDb(geometryOnly("neighbours=nearest"), positionsPx), untuned - 1);
}

// --- Degenerate cases (conventions 11) ------------------------------------------------------------------------------

TEST(Rsaa, DegenerateGeometryKeepsTheColour) {
    const TestScene empty{{}, [](double, double) { return -1; }, glm::vec3(0.3f, 0.2f, 0.1f)};
    const TestScene wall{{{{0, 0, 1}, -4, glm::vec3(0.3f), 1}}, [](double, double) { return 0; }};
    for (const char* measure : {"sadp", "depth", "normal"}) {
        const std::string method = geometryOnly(std::string("measure=") + measure);
        Frame f = renderPlanes(empty, 9, 5, d3dPattern(8));  // depth 1e10 against 1e10
        EXPECT_TRUE(resolved(method, f).samePixels(f.colorLinear)) << measure;
        f = renderPlanes(wall, 9, 5, d3dPattern(8));
        std::vector<glm::dvec2> same(8, glm::dvec2(0));  // every sub-sample coincides with the centre
        f = renderPlanes(wall, 9, 5, same);
        EXPECT_TRUE(resolved(method, f).samePixels(f.colorLinear)) << measure;
    }
}
// Their masks are all ones, and no offset of any table leaves the neighbouring pixels (conventions 11).
TEST(Rsaa, DegenerateMasksAreAllOnesAndOffsetsStayWithinAPixel) {
    const TestScene empty{{}, [](double, double) { return -1; }, glm::vec3(0.3f)};
    const TestScene wall{{{{0, 0, 1}, -4, glm::vec3(0.3f), 1}}, [](double, double) { return 0; }};
    std::vector<DebugLayer> layers;
    for (const Frame& f : {renderPlanes(empty, 9, 5, d3dPattern(8)),
                           renderPlanes(wall, 9, 5, std::vector<glm::dvec2>(8, glm::dvec2(0)))}) {
        resolved("rsaa:mask=geometry", f, {}, &layers);
        for (int y = 0; y < 5; y++)
            for (int x = 0; x < 9; x++) EXPECT_EQ(layer(layers, "mask").at(x, y), 255.0f);
    }
    for (const size_t samples : {4u, 8u, 16u})
        for (const float v : rsaaTable(samples, shippedRsaaEntries(samples))) ASSERT_LE(std::abs(v), 1.0f) << samples;
}
TEST(Rsaa, NanAndZeroNormalsStayInTheirPixel) {
    for (const float bad : {0.0f, NAN}) {
        Frame f = renderPlanes(parallelPlanes(kLine), 48, 31, d3dPattern(8));
        for (auto& p : f.subSamples[3].normalWorld.c) p.at(5, 5) = bad;
        for (auto& p : f.normalWorld.c) p.at(9, 20) = bad;
        const Rgb good = resolved("rsaa:mask=geometry", renderPlanes(parallelPlanes(kLine), 48, 31, d3dPattern(8)));
        const Rgb out = resolved("rsaa:mask=geometry", f);
        for (int y = 0; y < 31; y++)
            for (int x = 0; x < 48; x++) {
                ASSERT_TRUE(std::isfinite(out.c[0].at(x, y)));
                const bool near = std::max(std::abs(x - 9), std::abs(y - 20)) <= 1 || (x == 5 && y == 5);
                ASSERT_TRUE(near || out.c[0].at(x, y) == good.c[0].at(x, y)) << x << "," << y;
            }
        // One wall before and behind: nothing to blend with, whatever the mask says.
        EXPECT_EQ(out.c[0].at(5, 5), f.colorLinear.c[0].at(5, 5));
    }
}
TEST(Rsaa, ANeighbourOfWeightZeroMayBeNan) {
    Frame f = renderPlanes(parallelPlanes(kLine), 48, 31, d3dPattern(8));
    f.colorLinear.c[0].at(3, 3) = NAN;
    const Rgb out = resolved("rsaa", f);
    for (int y = 0; y < 31; y++)
        for (int x = 0; x < 48; x++)
            ASSERT_TRUE((x == 3 && y == 3) || std::isfinite(out.c[0].at(x, y))) << x << "," << y;
}

TEST(Rsaa, BadInputIsNamed) {
    ShotInfo none, many;
    many.subSamplePositionsPx.resize(17);
    EXPECT_THROW(parseMethod("rsaa").create(none), InputError);
    EXPECT_THROW(parseMethod("rsaa").create(many), InputError);
    EXPECT_THROW(parseMethod("rsaa:depthFloor=0.1"), UsageError);
    EXPECT_THROW(parseMethod("rsaa:mask=pass,clustering=threshold"), UsageError);
    Frame f = renderPlanes(parallelPlanes(kLine), 8, 8, d3dPattern(4));
    f.number = 12, f.camera.reset();
    try {
        resolved("rsaa", f);
        FAIL() << "a frame without camera must be refused";
    } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("frame 12"), std::string::npos) << e.what();
    }
    EXPECT_NO_THROW(resolved("rsaa:measure=depth", f));
    EXPECT_NO_THROW(resolved("rsaa:mask=pass,tuning=off", f));
}
TEST(Rsaa, AsksForWhatItReads) {
    const auto passes = [](const char* text) { return parseMethod(text).passes(); };
    const PassSet base = Pass::color, mask = Pass::subsampleMask, depth = Pass::depth | Pass::subsampleDepth,
                  rest = Pass::normal | Pass::object | Pass::subsampleNormal | Pass::subsampleObject;
    EXPECT_EQ(passes("rsaa:mask=geometry"), base | depth | rest);
    EXPECT_EQ(passes("rsaa:ids=off,measure=depth"), base | depth);
    EXPECT_EQ(passes("rsaa:mask=pass,tuning=off"), base | mask);
    EXPECT_EQ(passes("rsaa:tuning=off"), base | mask) << "auto: the mask is the pass's";
    EXPECT_EQ(passes("rsaa:mask=geometry,tuning=off"), base | depth | rest);
    EXPECT_EQ(passes("rsaa:mask=pass"), base | mask | depth | rest);
}
// conventions 14: the full picture of a scene of two planes, masks by SADP, 8 samples: 8 dB or more.
TEST(Rsaa, GainOnTheTwoPlanesScene) {
    SynthOptions o;
    o.scene = "two_planes", o.subsamples = "d3d8", o.jitter = "none";
    o.width = 240, o.height = 135, o.frames = 1;
    const SynthShot shot(o);
    const Frame f = shot.frame(0);
    const Rgb truth = shot.truth(0).a;
    const auto mse = [&](const Rgb& image) {
        double sum = 0;
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < f.height; y++)
                for (int x = 0; x < f.width; x++)
                    sum += std::pow(double(image.c[c].at(x, y)) - double(truth.c[c].at(x, y)), 2);
        return sum;
    };
    const double plain = mse(f.colorLinear);
    EXPECT_GE(10 * std::log10(plain / mse(resolved(geometryOnly("mask=geometry"), f))), 8.0);
    EXPECT_GE(10 * std::log10(plain / mse(resolved("rsaa", f))), 8.0);
}

}  // namespace
}  // namespace aa
