#include "methods/geometry/gbaa.h"

#include <gtest/gtest.h>

#include "methods/geometry/geometry_test_frames.h"
#include "methods/method.h"

namespace aa {
namespace {
using namespace testing;

// Signed distance along the major axis of the line's normal, as the edges pass of a triangle with that edge
// (conventions 3). `both`: triangles on both sides know the edge; otherwise only those of surface 0 do.
void putEdges(Frame& f, const Line& line, bool both = true) {
    const bool alongX = std::abs(line.nx) > std::abs(line.ny);
    for (int y = 0; y < f.height; y++)
        for (int x = 0; x < f.width; x++) {
            const double s = (line.r - line.nx * (x + 0.5) - line.ny * (y + 0.5)) / (alongX ? line.nx : line.ny);
            const bool known = both || line.has(x + 0.5, y + 0.5);
            f.edgeXPx.at(x, y) = known && alongX ? float(s) : 0.5f;
            f.edgeYPx.at(x, y) = known && !alongX ? float(s) : 0.5f;
        }
    f.edgeXPx.fillBorder(), f.edgeYPx.fillBorder();
}
double gbaaGainDb(const std::string& method, bool both, double leastSlope = 0, double mostSlope = 1) {
    const auto slope = [](const Line& l) {
        const double a = std::abs(l.nx), b = std::abs(l.ny);
        return std::min(a, b) / std::max(a, b);
    };
    return halfPlaneGainDb(
        method, {{0, 0}}, [&](Frame& f, const Line& line) { putEdges(f, line, both); },
        [&](const Line& line) { return slope(line) >= leastSlope && slope(line) <= mostSlope; });
}

// conventions 14: 19.0 dB overall, 35 dB for slopes below 1/4, 13.6 dB above 3/4.
TEST(Gbaa, GainOnHalfPlanes) {
    EXPECT_GE(gbaaGainDb("gbaa", true), 17.0);
    EXPECT_NEAR(gbaaGainDb("gbaa", true), 19.0, 1.0);
    EXPECT_GE(gbaaGainDb("gbaa", true, 0, 0.25), 32.0);
    EXPECT_NEAR(gbaaGainDb("gbaa", true, 0.75, 1), 13.6, 1.0);
}
TEST(Gbaa, SilhouettesNeedTheNeighbours) {
    EXPECT_GE(gbaaGainDb("gbaa", false), 14.0);
    EXPECT_LE(gbaaGainDb("gbaa:searchNeighbours=off", false), 6.0);
}
TEST(D2e, GainOnHalfPlanes) {
    EXPECT_GE(gbaaGainDb("d2e", true), 15.0);
    EXPECT_GE(gbaaGainDb("d2e", true, 0, 0.25), 32.0);
}
TEST(Gbaa, WrongSignsAreSeen) {
    const auto flipped = [](Frame& f, const Line& line) {
        putEdges(f, line);
        for (PlaneF* p : {&f.edgeXPx, &f.edgeYPx}) {
            for (int y = 0; y < f.height; y++)
                for (int x = 0; x < f.width; x++)
                    if (p->at(x, y) != 0.5f) p->at(x, y) = -p->at(x, y);
            p->fillBorder();
        }
    };
    EXPECT_LT(halfPlaneGainDb("gbaa", {{0, 0}}, flipped), 1.0);
    EXPECT_LT(halfPlaneGainDb("d2e", {{0, 0}}, flipped), 1.0);
}

// A row of pixels with colours 0, 1, 2, ... and no edges; one test sets single distances.
Frame ramp() {
    Frame f = renderPlanes({{}, [](double, double) { return -1; }}, 7, 7, {{0, 0}});
    for (int y = 0; y < 7; y++)
        for (int x = 0; x < 7; x++) f.colorLinear.c[0].at(x, y) = float(x), f.colorLinear.c[1].at(x, y) = float(y);
    return f;
}
TEST(Gbaa, AnEdgeBlendsTheAreaBeyondIt) {
    const auto at33 = [](const std::string& method, const Frame& f) {
        const Rgb out = resolved(method, f);
        return glm::vec2(out.c[0].at(3, 3) - 3, out.c[1].at(3, 3) - 3);
    };
    for (const char* method : {"gbaa", "d2e"}) {
        Frame f = ramp();
        EXPECT_TRUE(resolved(method, f).samePixels(f.colorLinear));
        f.edgeXPx.at(3, 3) = 0.2f;  // 30 % of the pixel lies beyond, on the right
        EXPECT_NEAR(at33(method, f).x, 0.3f, 1e-6);
        EXPECT_EQ(at33(method, f).y, 0.0f);
        f.edgeXPx.at(3, 3) = -0.4f;
        EXPECT_NEAR(at33(method, f).x, -0.1f, 1e-6);
        f.edgeXPx.at(3, 3) = 0.0f;  // 50/50 with the right
        EXPECT_NEAR(at33(method, f).x, 0.5f, 1e-6);
        for (const float none : {0.5f, -0.5f, 0.9f, 1e7f, NAN, INFINITY}) {
            f = ramp();
            f.edgeXPx.at(3, 3) = none, f.edgeYPx.at(3, 3) = none;
            EXPECT_EQ(at33(method, f), glm::vec2(0)) << none;
        }
        f = ramp();
        f.edgeXPx.at(2, 3) = 0.8f;  // the left neighbour's edge is 0.2 left of this centre
        EXPECT_NEAR(at33(method, f).x, -0.3f, 1e-6);
        f = ramp();
        f.edgeYPx.at(3, 4) = -0.9f;  // the lower neighbour's edge is 0.1 below this centre
        EXPECT_NEAR(at33(method, f).y, 0.4f, 1e-6);
        f.edgeXPx.at(4, 3) = 0.8f;  // points away
        EXPECT_EQ(at33(method, f).x, 0.0f);
    }
    // Two neighbours: gbaa takes the later one, d2e blends with both.
    Frame f = ramp();
    f.edgeXPx.at(2, 3) = 0.8f, f.edgeYPx.at(3, 4) = -0.9f;
    EXPECT_EQ(at33("gbaa", f).x, 0.0f);
    EXPECT_NEAR(at33("gbaa", f).y, 0.4f, 1e-6);
    EXPECT_NEAR(at33("d2e", f).x, -0.3f, 1e-6);
    EXPECT_NEAR(at33("d2e", f).y, 0.4f, 1e-6);
    // An own edge and a nearer one of a neighbour.
    f = ramp();
    f.edgeXPx.at(3, 3) = 0.4f, f.edgeXPx.at(2, 3) = 0.9f;
    EXPECT_NEAR(at33("gbaa", f).x, 0.1f, 1e-6);
    EXPECT_NEAR(at33("d2e", f).x, -0.4f, 1e-6);
}

}  // namespace
}  // namespace aa
