#include "methods/spatial/smaa.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "image/error.h"
#include "methods/spatial/smaa_areas.h"
#include "methods/spatial/smaa_reference.h"
#include "methods/spatial/spatial_testing.h"
#include "methods/spec.h"

namespace aa {
namespace {
using namespace aa::testing;

TEST(SmaaAreas, CheckValues) {
    struct Case {
        int left, right, leftPx, rightPx;
        double own, opposite;
    };
    for (const auto& c : {Case{3, 0, 0, 3, .375, 0},
                          {3, 3, 0, 0, .492188, 0},
                          {3, 3, 1, 3, .298067, 0},
                          {1, 3, 0, 4, 0, .4},
                          {1, 3, 2, 2, .025, .025},
                          {4, 3, 1, 5, 0, .285714},
                          {1, 0, 0, 9, 0, .45}}) {
        const SmaaAreas a = orthogonalArea(c.left, c.right, c.leftPx, c.rightPx);
        EXPECT_NEAR(a.own, c.own, 1e-6) << c.left << c.right;
        EXPECT_NEAR(a.opposite, c.opposite, 1e-6) << c.left << c.right;
    }
}
// Revectorised height of the line at t, by the rules of [Jimenez 2012] for shapes without smoothing.
double height(int e1, int e2, double l, double r, double offset, double t) {
    const double d = l + r + 1, above = 0.5 + offset, below = -0.5 + offset;
    const double h1 = e1 == 1 ? above : e1 == 3 ? below : e2 == 1 ? below : above;
    const double h2 = e2 == 1 ? above : e2 == 3 ? below : e1 == 1 ? below : above;
    if (e2 == 0) return l <= r && t < d / 2 ? h1 * (1 - 2 * t / d) : 0;
    if (e1 == 0) return l >= r && t > d / 2 ? h2 * (2 * t / d - 1) : 0;
    return h1 + (h2 - h1) * t / d;
}
TEST(SmaaAreas, EqualTheIntegralOfTheDefinition) {
    for (const auto& [e1, e2] :
         {std::pair{1, 0}, {3, 0}, {0, 1}, {0, 3}, {1, 3}, {3, 1}, {4, 1}, {4, 3}, {1, 4}, {3, 4}})
        for (const double offset : {0.0, 0.25, -0.375}) {
            if (offset != 0 && (e1 == 1 || e1 == 3) && (e2 == 1 || e2 == 3)) continue;
            for (int l = 0; l < 7; l++)
                for (int r = 0; r < 7; r++) {
                    double own = 0, opposite = 0;
                    const int n = 4000;
                    for (int i = 0; i < n; i++) {
                        const double h = height(e1, e2, l, r, offset, l + (i + 0.5) / n);
                        (h < 0 ? own : opposite) += std::abs(h) / n;
                    }
                    const SmaaAreas a = orthogonalArea(e1, e2, l, r, offset);
                    EXPECT_NEAR(a.own, own, 1e-4) << e1 << e2 << " " << l << " " << r << " " << offset;
                    EXPECT_NEAR(a.opposite, opposite, 1e-4) << e1 << e2 << " " << l << " " << r << " " << offset;
                }
        }
}
TEST(SmaaAreas, TablesEqualTheirDefinitionToOneCode) {
    for (const double offset : {0.0, -0.25, 0.25, -0.125, 0.125, -0.375, 0.375}) {
        const auto table = orthogonalTable(offset);
        ASSERT_EQ(table.size(), 25u * 16 * 16 * 2);
        size_t k = 0;
        for (int e1 = 0; e1 < 5; e1++)
            for (int e2 = 0; e2 < 5; e2++)
                for (int u = 0; u < 16; u++)
                    for (int v = 0; v < 16; v++) {
                        const SmaaAreas a = orthogonalArea(e1, e2, u * u, v * v, offset);
                        EXPECT_NEAR(double(table[k++]), a.own, 1.0 / 255 + 1e-7);
                        EXPECT_NEAR(double(table[k++]), a.opposite, 1.0 / 255 + 1e-7);
                    }
    }
    const auto published = diagonalTable({0, 0}, true), exact = diagonalTable({0, 0}, false);
    ASSERT_EQ(published.size(), 16u * kDiagonals * kDiagonals * 2);
    for (size_t k = 0; k < published.size(); k++)  // the 30 x 30 rule is within 8 codes of the exact area
        EXPECT_LE(std::abs(std::floor(255 * exact[k]) - 255 * published[k]), 8.001) << k;
}
// The table finds the count with 60 comparisons; here all 900 are made.
TEST(SmaaAreas, PublishedDiagonalsAreTheCountOf900Points) {
    const auto side = [](std::array<double, 2> p, std::array<double, 2> q, std::array<double, 2> corner) {
        const double a = q[1] - p[1], b = p[0] - q[0], xm = (p[0] + q[0]) / 2, ym = (p[1] + q[1]) / 2;
        int inside = 0;
        for (int i = 0; i < 30; i++)
            for (int j = 0; j < 30; j++)
                inside += a * (corner[0] + i / 29.0 - xm) + b * (corner[1] + j / 29.0 - ym) > 0;
        return inside / 900.0;
    };
    struct Line {  // the crossing codes that give one line, and its ends' y in their pixels
        int code1, code2;
        double startY, endY;
    };
    for (const Line& line : {Line{2, 1, 1, 1}, {1, 1, 0, 1}, {1, 2, 0, 0}, {2, 2, 1, 0}})
        for (const std::array<double, 2> offset : {std::array{0.0, 0.0}, {0.25, -0.25}, {-0.11, 0.11}, {0.3, 0.2}})
            for (int d1 = 0; d1 < kDiagonals; d1++)
                for (int d2 = 0; d2 < kDiagonals; d2++) {
                    const double d = d1 + d2 + 1;
                    const std::array start{1 + offset[0], line.startY + offset[1]},
                        end{1 + offset[0] + d, line.endY + offset[1] + d};
                    const auto areas =
                        diagonalArea(line.code1, line.code2, d1, d2, offset, DiagonalIntegral::sampled30);
                    ASSERT_EQ(areas.own, 1 - side(start, end, {1.0 + d1, 0.0 + d1})) << d1 << " " << d2;
                    ASSERT_EQ(areas.opposite, side(start, end, {1.0 + d1, 1.0 + d1})) << d1 << " " << d2;
                }
}
// Kept tables are those that were made, at later calls, beside other threads and after more than are kept.
TEST(SmaaAreas, KeptTablesAreTheSame) {
    const auto published = diagonalTable({0.25, -0.25}, true), exact = diagonalTable({0.25, -0.25}, false);
    EXPECT_NE(published, exact);
    const auto orthogonal = exactTable(0.25, 8), other = exactTable(0.25, 9);
    EXPECT_NE(orthogonal.size(), other.size());
    tbb::parallel_for(0, 120, [&](int k) {
        const double offset = k % 40 / 100.0;
        diagonalTable({offset, -offset}, false);
        if (k % 3) return;
        EXPECT_EQ(diagonalTable({0.25, -0.25}, false), exact);
        EXPECT_EQ(exactTable(0.25, 8), orthogonal);
        EXPECT_EQ(exactTable(0.25, 9), other);
    });
    EXPECT_EQ(diagonalTable({0.25, -0.25}, true), published);
    EXPECT_EQ(diagonalTable({0.25, -0.25}, false), exact);
}
TEST(SmaaAreas, MirroredLinesGiveMirroredAreas) {
    for (int e1 : {0, 1, 3, 4})
        for (int e2 : {0, 1, 3, 4})
            for (int l = 0; l < 9; l++)
                for (int r = 0; r < 9; r++) {
                    const SmaaAreas a = orthogonalArea(e1, e2, l, r), b = orthogonalArea(e2, e1, r, l);
                    EXPECT_NEAR(a.own, b.own, 1e-12);
                    EXPECT_NEAR(a.opposite, b.opposite, 1e-12);
                }
}

TEST(Smaa1x, StepVector) {
    const int x[] = {12, 20, 24, 28, 30, 31, 32, 33, 35, 39, 44};
    const std::pair<std::string, std::array<double, 11>> rows[] = {
        {"LOW", {0, 0, .00833, .18182, .33333, .43750, .55556, .65000, .79167, .96875, 1}},
        {"MEDIUM", {0, .07407, .17391, .31579, .41176, .46875, .52941, .58333, .67500, .81250, .93103}},
        {"HIGH", {.11765, .23256, .30769, .40000, .45455, .48438, .51515, .54412, .59722, .68750, .77778}},
        {"ULTRA", {.26506, .34667, .39437, .44776, .47692, .49219, .50769, .52273, .55147, .60417, .66234}}};
    for (const auto& [preset, row] : rows) {
        const Rgb out = resolveOnce("smaa1x:blendSpace=encoded,preset=" + preset, stepImage());
        for (size_t i = 0; i < 11; i++) EXPECT_NEAR(out.c[1].at(x[i], 4), row[i], 6e-6) << preset << " x " << x[i];
        for (int u = 0; u < 64; u++) {
            EXPECT_EQ(out.c[0].at(u, 3), 1.0f) << preset << u;
            EXPECT_EQ(out.c[0].at(u, 5), 0.0f) << preset << u;
        }
    }
}

TEST(Smaa1x, ConformsToTheDefinitionPerPixel) {
    struct Case {
        std::string spec;
        double threshold;
        int steps, diagonal;
        double rounding;
        bool colour = false;
    };
    const Case cases[] = {{"preset=LOW", .15, 4, 0, -1},
                          {"preset=MEDIUM", .1, 8, 0, -1},
                          {"preset=HIGH", .1, 16, 8, .25},
                          {"preset=ULTRA", .05, 32, 16, .25},
                          {"preset=ULTRA,edges=colour", .05, 32, 16, .25, true}};
    const Rgb images[] = {randomShapes(97, 61, 7), randomCodes(40, 33, 11), randomShapes(61, 97, 21)};
    for (const auto& test : cases)
        for (const Rgb& image : images) {
            ReferenceSmaa reference(image, test.threshold, test.steps, test.diagonal, test.rounding, test.colour);
            EXPECT_GT(reference.edgePixels(), 300);
            if (reference.nearTies > 0) continue;  // a decision that rounding makes; counted below
            for (const auto precision : {Precision::fast, Precision::scalar, Precision::oracle}) {
                const Rgb out = resolveOnce("smaa1x:blendSpace=encoded," + test.spec, image, execOf(precision));
                double worst = 0;
                for (int y = 0; y < image.height(); y++)
                    for (int x = 0; x < image.width(); x++) {
                        const auto expected = reference.pixel(x, y);
                        for (size_t c = 0; c < 3; c++)
                            worst = std::max(worst, std::abs(out.c[c].at(x, y) - expected[c]));
                    }
                EXPECT_LT(worst, 3e-6) << test.spec << " " << image.width();
            }
        }
    int usable = 0;
    for (const Rgb& image : images) usable += ReferenceSmaa(image, .1, 4, 0, -1).nearTies == 0;
    EXPECT_GE(usable, 2);
}

TEST(Smaa1x, PrecisionsAndInstructionSetsAgree) {
    const Frame frame = frameOf(randomShapes(133, 77, 3));
    for (const std::string spec : {"smaa1x:preset=ULTRA", "smaa1x:preset=ULTRA,edges=colour,areas=table"}) {
        const Rgb fast = resolveOnce(spec, frame);
        for (const Isa isa : kIsas) {
            if (!isaSupported(isa)) continue;
            EXPECT_TRUE(fast.samePixels(resolveOnce(spec, frame, execOf(Precision::fast, isa))));
            EXPECT_TRUE(fast.samePixels(resolveOnce(spec, frame, execOf(Precision::scalar, isa))));
        }
        EXPECT_LT(largestDifference(fast, resolveOnce(spec, frame, execOf(Precision::oracle))), 3e-5);
    }
}

TEST(Smaa1x, TableAndRoundedWeightsStayWithinTheirQuantum) {
    const Frame frame = frameOf(randomShapes(120, 90, 5));
    const Rgb exact = resolveOnce("smaa1x:blendSpace=encoded,preset=ULTRA", frame);
    const Rgb rounded = resolveOnce("smaa1x:blendSpace=encoded,preset=ULTRA,weights=unorm8", frame);
    const Rgb table = resolveOnce("smaa1x:blendSpace=encoded,preset=ULTRA,areas=table", frame);
    EXPECT_LT(largestDifference(exact, rounded), 1.5 / 255);
    EXPECT_GT(largestDifference(exact, rounded), 0);
    EXPECT_LT(largestDifference(exact, table), 0.06);  // square distances between table entries are interpolated
    EXPECT_GT(largestDifference(exact, table), 0);
}

// Encoded steps of 0.06 between two surfaces: below HIGH's threshold in luma.
Frame twoSurfaces() {
    Rgb image(64, 20);
    PlaneF depth(64, 20);
    PlaneU object(64, 20);
    for (int y = 0; y < 20; y++)
        for (int x = 0; x < 64; x++) {
            const bool far = y > 9 + x / 16;
            for (auto& p : image.c) p.at(x, y) = far ? 0.5f : 0.56f;
            depth.at(x, y) = far ? 1e10f : 5.0f;
            object.at(x, y) = far ? 0 : 3;
        }
    Frame f = frameOf(image);
    depth.fillBorder();
    object.fillBorder();
    f.depthView = depth;
    f.objectId = object;
    f.passes = f.passes | Pass::depth | Pass::object;
    return f;
}
TEST(Smaa1x, DepthEdgesAndPredicationReadTheirPass) {
    const Frame f = twoSurfaces();
    auto changed = [&](const std::string& spec) {
        return !resolveOnce("smaa1x:blendSpace=encoded," + spec, f).samePixels(f.colorEncoded);
    };
    EXPECT_FALSE(changed("preset=HIGH"));
    EXPECT_TRUE(changed("edges=depth"));
    EXPECT_EQ(parseMethod("smaa1x:edges=depth").passes(), Pass::color | Pass::depth);
    EXPECT_EQ(parseMethod("smaa1x:predication=object").passes(), Pass::color | Pass::object);
    EXPECT_TRUE(changed("preset=custom,threshold=0.049"));
    // Doubled to 0.098, less 40 % at an edge of the pass: 0.0588.
    EXPECT_TRUE(changed("preset=custom,threshold=0.049,predication=depth"));
    EXPECT_TRUE(changed("preset=custom,threshold=0.049,predication=object"));
    EXPECT_FALSE(changed("preset=custom,threshold=0.049,predication=depth,predicationStrength=0"));
    EXPECT_FALSE(changed("preset=custom,threshold=0.052,predication=object"));
}

TEST(Smaa1x, RejectsParametersThatCannotAct) {
    EXPECT_THROW(parseMethod("smaa1x:threshold=0.2"), UsageError);  // belongs to preset=custom
    EXPECT_THROW(parseMethod("smaa1x:preset=custom,threshold=0"), UsageError);
    EXPECT_THROW(parseMethod("smaa1x:predicationScale=3"), UsageError);
    EXPECT_THROW(parseMethod("smaa1x:preset=high"), UsageError);
    EXPECT_NO_THROW(parseMethod("smaa1x:preset=custom,threshold=0.2"));
}

TEST(Smaa1x, DebugLayersShowEdgesWeightsAndSearches) {
    const Frame f = frameOf(stepImage());
    const auto method = parseMethod("smaa1x:preset=HIGH").create({.width = 64, .height = 9});
    Rgb out(64, 9);
    method->keepDebugLayers = true;
    method->resolve(f, {}, out);
    const auto layers = method->debugLayers();
    ASSERT_EQ(layers.size(), 5u);
    EXPECT_EQ(layers[0].planes[0].at(32, 4), 1.0f);  // the step's left edge
    EXPECT_EQ(layers[0].planes[1].at(20, 4), 1.0f);
    EXPECT_EQ(layers[0].planes[1].at(40, 4), 0.0f);
    EXPECT_FLOAT_EQ(layers[2].planes[0].at(32, 4), .078125f);  // Z of length 1, corner factor .625
    EXPECT_FLOAT_EQ(layers[2].planes[1].at(32, 4), .078125f);
    EXPECT_EQ(layers[3].planes[1].at(24, 4), 7.0f);  // px to the step
}
// Where a rising and a falling diagonal cross their areas may sum to more than 1, which the published target cannot
// hold.
TEST(Smaa1x, CrossingDiagonalsWeighNoMoreThanOne) {
    float most = 0;
    for (const char* more : {"", ",weights=unorm8"})
        for (unsigned seed = 1; seed <= 40; seed++) {
            Rgb image(32, 32);
            std::mt19937 random(seed);
            for (int y = 0; y < 32; y++)
                for (int x = 0; x < 32; x++) {
                    const float v = float(random() & 1);
                    for (auto& p : image.c) p.at(x, y) = v;
                }
            const auto method =
                parseMethod(std::string("smaa1x:preset=ULTRA") + more).create({.width = 32, .height = 32});
            Rgb out(32, 32);
            method->keepDebugLayers = true;
            method->resolve(frameOf(image), {}, out);
            for (const auto& layer : method->debugLayers())
                for (const auto& plane : layer.planes)
                    for (int y = 0; layer.name.starts_with("weights") && y < 32; y++)
                        for (int x = 0; x < 32; x++) most = std::max(most, plane.at(x, y));
        }
    EXPECT_LE(most, 1.0f);
}
// Along an endless edge the left search stops at 2 steps - 1 px, the right one at 2 steps.
TEST(Smaa1x, SearchesEndAtTheirCaps) {
    Rgb image(200, 10, 0.0f);
    for (auto& p : image.c)
        for (int y = 0; y < 5; y++)
            for (int x = 0; x < 200; x++) p.at(x, y) = 1.0f;
    for (const auto& [preset, steps] : {std::pair{"LOW", 4}, {"MEDIUM", 8}, {"HIGH", 16}, {"ULTRA", 32}}) {
        const auto method = parseMethod(std::string("smaa1x:preset=") + preset).create({.width = 200, .height = 10});
        Rgb out(200, 10);
        method->keepDebugLayers = true;
        method->resolve(frameOf(image), {}, out);
        const auto layers = method->debugLayers();
        EXPECT_EQ(layers[3].name, "search.top");
        EXPECT_EQ(layers[3].planes[0].at(100, 5), float(2 * steps - 1)) << preset;
        EXPECT_EQ(layers[3].planes[1].at(100, 5), float(2 * steps)) << preset;
    }
}

}  // namespace
}  // namespace aa
