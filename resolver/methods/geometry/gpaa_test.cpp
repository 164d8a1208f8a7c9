#include "methods/geometry/gpaa.h"

#include <gtest/gtest.h>

#include "image/error.h"
#include "methods/geometry/geometry_test_frames.h"
#include "methods/method.h"

namespace aa {
namespace {
using namespace testing;

// The line through the picture as one segment that ends outside of it.
void putSegment(Frame& f, const Line& line, float depthView = 4) {
    const double reach = f.width + f.height, cx = f.width / 2.0, cy = f.height / 2.0;
    const double t = line.r - line.nx * cx - line.ny * cy;
    const double x = cx + line.nx * t, y = cy + line.ny * t;
    f.segments = {{float(x - line.ny * reach), float(y + line.nx * reach), depthView, float(x + line.ny * reach),
                   float(y - line.nx * reach), depthView}};
}
double gpaaGainDb(const std::string& method, double leastSlope = 0, double mostSlope = 1) {
    const auto slope = [](const Line& l) {
        const double a = std::abs(l.nx), b = std::abs(l.ny);
        return std::min(a, b) / std::max(a, b);
    };
    return halfPlaneGainDb(
        method, {{0, 0}}, [](Frame& f, const Line& line) { putSegment(f, line); },
        [&](const Line& line) { return slope(line) >= leastSlope && slope(line) <= mostSlope; });
}

// The blend of gbaa with an edge known on both sides, so its figures: 19.0 dB, 35 and 13.6 dB for small and large
// slopes (conventions 14).
TEST(Gpaa, GainOnHalfPlanes) {
    EXPECT_GE(gpaaGainDb("gpaa"), 17.0);
    EXPECT_NEAR(gpaaGainDb("gpaa"), 19.0, 1.0);
    EXPECT_GE(gpaaGainDb("gpaa", 0, 0.25), 32.0);
    EXPECT_NEAR(gpaaGainDb("gpaa", 0.75, 1), 13.6, 1.0);
}
TEST(Gpaa, WrongSignsAreSeen) {
    const auto gainWith = [](const auto& wrong) {
        return halfPlaneGainDb("gpaa", {{0, 0}}, [&](Frame& f, const Line& line) {
            Line l = line;
            wrong(l, f);
            putSegment(f, l);
        });
    };
    const auto middle = [](Line& l, const Frame& f) { return l.nx * f.width / 2 + l.ny * f.height / 2; };
    EXPECT_LT(gainWith([&](Line& l, const Frame& f) { l.r = 2 * middle(l, f) - l.r; }), 1.0);  // beyond the centre
    EXPECT_LT(gainWith([&](Line& l, const Frame&) { l.r += 0.5; }), 10.0);                     // half a pixel off
}

// A ramp: the colour of pixel (x, y) is (x, y, 0), everything at depth 5.
Frame ramp(std::vector<EdgeSegment> segments) {
    Frame f = renderPlanes({{{{0, 0, 1}, -5, glm::vec3(1.0f), 1}}, [](double, double) { return 0; }}, 9, 9, {{0, 0}});
    for (int y = 0; y < 9; y++)
        for (int x = 0; x < 9; x++) f.colorLinear.c[0].at(x, y) = float(x), f.colorLinear.c[1].at(x, y) = float(y);
    f.colorLinear.fillBorder();
    f.segments = std::move(segments);
    return f;
}
glm::vec2 shiftAt(const std::string& method, const Frame& f, int x = 4, int y = 4) {
    const Rgb out = resolved(method, f);
    return {out.c[0].at(x, y) - float(x), out.c[1].at(x, y) - float(y)};
}
EdgeSegment vertical(float x, float z = 5) { return {x, -3, z, x, 12, z}; }
EdgeSegment horizontal(float y, float z = 5) { return {-3, y, z, 12, y, z}; }

void expectShift(glm::vec2 found, float x, float y) {
    EXPECT_NEAR(found.x, x, 1e-5);
    EXPECT_NEAR(found.y, y, 1e-5);
}
TEST(Gpaa, AnEdgeBlendsTheAreaBeyondIt) {
    expectShift(shiftAt("gpaa", ramp({})), 0, 0);
    expectShift(shiftAt("gpaa", ramp({vertical(4.7f)})), 0.3f, 0);    // 0.2 right of the centre: 30 % lie beyond
    expectShift(shiftAt("gpaa", ramp({vertical(4.1f)})), -0.1f, 0);   // 0.4 left of it
    expectShift(shiftAt("gpaa", ramp({horizontal(4.6f)})), 0, 0.4f);  // below
    expectShift(shiftAt("gpaa", ramp({horizontal(4.3f)})), 0, -0.3f);
    expectShift(shiftAt("gpaa", ramp({{4.7f, 12, 5, 4.7f, -3, 5}})), 0.3f, 0);  // whichever end comes first
    expectShift(shiftAt("gpaa", ramp({vertical(5)})), 0, 0);                    // on the border: nothing beyond
    expectShift(shiftAt("gpaa", ramp({vertical(5)}), 5), 0, 0);
    expectShift(shiftAt("gpaa", ramp({vertical(4.5f)})), 0.5f, 0);  // through the centre: toward +
    expectShift(shiftAt("gpaa", ramp({vertical(4.4995f)})), -0.4995f, 0);
    // A slope of 1/4: s is measured along y at the pixel's own column.
    expectShift(shiftAt("gpaa", ramp({{0.5f, 3.7f, 5, 8.5f, 5.7f, 5}})), 0, 0.3f);
    expectShift(shiftAt("gpaa", ramp({{0.5f, 3.7f, 5, 8.5f, 5.7f, 5}}), 5), 0, 0.05f);
}
TEST(Gpaa, TheLastEdgeWinsOrTheNearest) {
    const Frame two = ramp({vertical(4.6f), horizontal(4.9f)});
    expectShift(shiftAt("gpaa", two), 0, 0.1f);
    expectShift(shiftAt("gpaa:keep=nearest", two), 0.4f, 0);
    expectShift(shiftAt("gpaa:keep=nearest", ramp({horizontal(4.9f), vertical(4.6f)})), 0.4f, 0);
    expectShift(shiftAt("gpaa:keep=nearest", ramp({vertical(4.75f), horizontal(4.75f)})), 0.25f,
                0);  // a tie: the first
}
TEST(Gpaa, HiddenEdgesAreSkipped) {
    expectShift(shiftAt("gpaa", ramp({vertical(4.7f, 5.004f)})), 0.3f, 0);  // within the bias
    expectShift(shiftAt("gpaa", ramp({vertical(4.7f, 5.006f)})), 0, 0);
    expectShift(shiftAt("gpaa:depthBias=0.01", ramp({vertical(4.7f, 5.006f)})), 0.3f, 0);
    expectShift(shiftAt("gpaa:depthTest=off", ramp({vertical(4.7f, 50)})), 0.3f, 0);
    expectShift(shiftAt("gpaa", ramp({vertical(4.7f, 1), vertical(4.1f, 50)})), 0.3f, 0);  // does not win
    // Only the surface beyond the edge is far enough not to hide it.
    Frame slope = ramp({vertical(4.7f, 5.5f)});
    slope.depthView.at(5, 4) = 6;
    expectShift(shiftAt("gpaa", slope), 0, 0);
    expectShift(shiftAt("gpaa:depthTest=farther", slope), 0.3f, 0);
    slope.segments = {vertical(4.2f, 5.5f)};  // beyond is the left
    expectShift(shiftAt("gpaa:depthTest=farther", slope), 0, 0);
    // In perspective 1 / z is linear along the picture: 3.2 between 2 and 8, not 5.
    const EdgeSegment steep{4.7f, 0.5f, 2, 4.7f, 8.5f, 8};
    Frame f = ramp({steep});
    f.depthView = PlaneF(9, 9, 4.0f);
    expectShift(shiftAt("gpaa", f), 0.3f, 0);
    f.camera->kind = "orthographic";
    expectShift(shiftAt("gpaa", f), 0, 0);
}
TEST(Gpaa, SegmentsEndHalfAPixelBeyondTheirEnds) {
    const auto touchedRows = [](float from, float to) {
        const Frame f = ramp({{4.7f, from, 5, 4.7f, to, 5}});
        std::string rows;
        for (int y = 0; y < 9; y++) rows += shiftAt("gpaa", f, 4, y).x > 0 ? 'x' : '.';
        return rows;
    };
    EXPECT_EQ(touchedRows(3.4f, 5.6f), "...xxx...");  // rows 3 to 5, whose centres lie on it
    EXPECT_EQ(touchedRows(3.1f, 5.9f), "...xxx...");
    EXPECT_EQ(touchedRows(2.9f, 5.1f), "..xxxx...");  // rows 2 and 5: 0.4 px beyond its ends
}
// The list is of the un-jittered picture; in a jittered frame everything is displaced by -jitter.
TEST(Gpaa, JitteredFramesMoveTheList) {
    Frame f = ramp({vertical(4.7f)});
    f.jitterPx = {0.3, -0.2};
    expectShift(shiftAt("gpaa", f), -0.4f, 0);  // from 0.2 right of the centre to 0.1 left of it
    f.segments = {horizontal(4.6f)};
    expectShift(shiftAt("gpaa", f), 0, 0.2f);
}
// conventions 11: shifts stay within a pixel, broken and endless edges cut nothing.
TEST(Gpaa, DegenerateSegments) {
    const Frame clean = ramp({});
    for (const EdgeSegment& s : {EdgeSegment{4.5f, 4.5f, 5, 4.5f, 4.5f, 5}, EdgeSegment{NAN, 1, 5, 4, 8, 5},
                                 EdgeSegment{4.7f, 1, NAN, 4.7f, 8, 5}, EdgeSegment{INFINITY, 1, 5, -INFINITY, 8, 5},
                                 EdgeSegment{-300, -200, 5, -100, -200, 5}, EdgeSegment{4.7f, 1e7f, 5, 4.7f, 2e7f, 5},
                                 EdgeSegment{4.7f, 1, 1e10f, 4.7f, 8, 1e10f}})
        EXPECT_TRUE(resolved("gpaa", ramp({s})).samePixels(clean.colorLinear)) << s.x0 << " " << s.y0;
    Frame sky = ramp({vertical(4.7f, 1e9f)});
    sky.depthView = PlaneF(9, 9, kBackgroundDepth);
    expectShift(shiftAt("gpaa", sky), 0.3f, 0);
    EXPECT_THROW(parseMethod("gpaa:depthTest=off,depthBias=0.1"), UsageError);
    EXPECT_EQ(parseMethod("gpaa").passes(), Pass::color | Pass::segments | Pass::depth);
    EXPECT_EQ(parseMethod("gpaa:depthTest=off").passes(), Pass::color | Pass::segments);
    std::vector<DebugLayer> layers;
    resolved("gpaa", ramp({vertical(4.7f)}), {}, &layers);
    EXPECT_NEAR(layer(layers, "offsetXPx").at(4, 4), 0.3f, 1e-5);
    EXPECT_EQ(layer(layers, "offsetYPx").at(4, 4), 0.0f);
}

}  // namespace
}  // namespace aa
