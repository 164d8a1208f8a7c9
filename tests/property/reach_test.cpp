// How far a spatial method looks and how far from an edge it changes anything: never farther than it states.
#include <gtest/gtest.h>

#include "frames.h"
#include "methods/methods_under_test.h"

namespace aa::testing {
namespace {

// Methods that resolve a frame by itself.
std::vector<std::string> spatialSpecs() {
    std::vector<std::string> specs;
    for (const auto& text : allSpecs())
        if (!specUnderTest(text).method->temporal && specUnderTest(text).method->id != "accum") specs.push_back(text);
    return specs;
}
int reachOf(const std::string& text) { return specUnderTest(text).method->reachPx; }
std::string testName(const ::testing::TestParamInfo<std::string>& info) {
    std::string s = info.param;
    for (char& c : s)
        if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
    return s;
}

// Light over dark along a line that steps down by a pixel at `stepAt`; `broken` is a pixel of the other surface on the
// line. Transposed when `vertical`.
struct LineScene {
    int stepAt, brokenAt;
    bool broken, vertical;
    static constexpr int kRow = 12;
    Surface operator()(double x, double y) const {
        const int u = int(std::floor(vertical ? y : x)), v = int(std::floor(vertical ? x : y));
        bool light = v < (u >= stepAt ? kRow + 1 : kRow);
        if (broken && u == brokenAt && v == kRow) light = !light;
        if (light) return {glm::vec3(0.8f, 0.7f, 0.75f), 4.0f, {0, 0, 1}, 2};
        return {glm::vec3(0.05f), 8.0f, {0, 0, 1}, 1};
    }
};
// The largest distance from the one pixel that differs between two frames at which their outputs differ.
int influencePx(const std::string& text, int looked) {
    int farthest = 0;
    for (const bool vertical : {false, true})
        for (const int away : {0, 1, looked / 3, looked / 2, 2 * looked / 3}) {
            const int length = 2 * looked + 41, middle = looked + 20, w = vertical ? 25 : length,
                      h = vertical ? length : 25;
            Rgb outputs[2];
            for (const bool broken : {false, true}) {
                Subject s = makeSubject(text, w, h);
                const LineScene scene{middle - away, middle, broken, vertical};
                outputs[broken] = step(s, renderFrame(scene, w, h, 1, {0, 0}, {0, 0}, s.samples));
            }
            for (size_t c = 0; c < 3; c++)
                for (int y = 0; y < h; y++)
                    for (int x = 0; x < w; x++) {
                        if (outputs[0].c[c].at(x, y) == outputs[1].c[c].at(x, y)) continue;
                        const int along = std::abs((vertical ? y : x) - middle),
                                  across = std::abs((vertical ? x : y) - LineScene::kRow);
                        farthest = std::max(farthest, std::max(along, across));
                    }
        }
    return farthest;
}

class Reach : public ::testing::TestWithParam<std::string> {};

TEST_P(Reach, NoPixelIsInfluencedFromFartherAway) {
    const int reach = reachOf(GetParam());
    if (reach <= 0) GTEST_SKIP() << "no limit stated";
    EXPECT_LE(influencePx(GetParam(), reach + 20), reach)
        << fileOf(GetParam()) << ": .reachPx is smaller than the distance from which a pixel is influenced";
}

// Shapes in the middle of a flat picture. Returns the largest distance from an edge (a pixel that differs from one of
// its 4 neighbours) at which the output is not the flat colour.
int changePx(const std::string& text, int looked) {
    const int size = 2 * looked + 61;
    const Scene shapesInTheMiddle = [&](double x, double y) -> Surface {
        const double u = x - size / 2.0, v = y - size / 2.0;
        if (std::hypot(u + 6, v - 4) < 8.3) return {{0.9f, 0.2f, 0.1f}, 4.0f, {0, 0, 1}, 2};
        if (std::abs(v + 0.21 * u) < 3.4 && std::abs(u) < 22) return {{0.7f, 0.8f, 0.9f}, 6.0f, {0, 0, 1}, 3};
        if (std::abs(u - 0.3 * v - 9) < 0.7 && std::abs(v) < 20) return {{0.0f, 0.0f, 0.0f}, 5.0f, {0, 0, 1}, 4};
        return {{0.2f, 0.25f, 0.3f}, 9.0f, {0, 0, 1}, 1};
    };
    Subject s = makeSubject(text, size, size);
    const Frame f = renderFrame(shapesInTheMiddle, size, size, 1, {0, 0}, {0, 0}, s.samples);
    const Rgb out = step(s, f);
    // Chebyshev distance to the nearest edge in two sweeps.
    PlaneF distance(size, size, 1e6f);
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++) {
            const auto id = [&](int i, int j) { return f.objectId.clamped(x + i, y + j); };
            const bool partly = [&] {
                for (const auto& sub : f.subSamples)
                    if (sub.objectId.at(x, y) != f.objectId.at(x, y)) return true;
                return false;
            }();
            if (partly || id(0, 0) != id(1, 0) || id(0, 0) != id(-1, 0) || id(0, 0) != id(0, 1) ||
                id(0, 0) != id(0, -1))
                distance.at(x, y) = 0;
        }
    const auto relax = [&](int x, int y, int i, int j) {
        if (x + i < 0 || y + j < 0 || x + i >= size || y + j >= size) return;
        distance.at(x, y) = std::min(distance.at(x, y), distance.at(x + i, y + j) + 1);
    };
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++)
            for (const auto& [i, j] : {std::pair{-1, 0}, {-1, -1}, {0, -1}, {1, -1}}) relax(x, y, i, j);
    for (int y = size - 1; y >= 0; y--)
        for (int x = size - 1; x >= 0; x--)
            for (const auto& [i, j] : {std::pair{1, 0}, {1, 1}, {0, 1}, {-1, 1}}) relax(x, y, i, j);
    Rgb expected;
    if (specUnderTest(text).outputSpace() == Space::encoded)
        encode(f.colorLinear, {}, {}, expected);
    else
        expected = f.colorLinear;
    int farthest = 0;
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < size; y++)
            for (int x = 0; x < size; x++)
                if (std::abs(out.c[c].at(x, y) - expected.c[c].at(x, y)) > 2e-6f)
                    farthest = std::max(farthest, int(distance.at(x, y)));
    return farthest;
}
TEST_P(Reach, NothingChangesFartherFromAnEdge) {
    const bool mlaa = specUnderTest(GetParam()).method->id == "mlaa";  // lines of any length, but only beside them
    const int reach = mlaa ? 1 : reachOf(GetParam());
    if (reach <= 0) GTEST_SKIP() << "no reach stated";
    EXPECT_LE(changePx(GetParam(), reach), reach)
        << fileOf(GetParam()) << ": .reachPx is smaller than the distance from an edge at which pixels change";
}
INSTANTIATE_TEST_SUITE_P(Methods, Reach, ::testing::ValuesIn(spatialSpecs()), testName);

// A reach that is stated too small is seen.
TEST(ReachNegative, TooSmallAReachIsSeen) {
    for (const auto& [text, tooSmall] : {std::pair{"fxaa311:preset=29", 20},
                                         {"fxaa311:preset=39", 17},
                                         {"fxaa1:preset=5", 30},
                                         {"fxaacs", 9},
                                         {"smaa1x:preset=LOW", 7},
                                         {"smaa1x:preset=HIGH", 30},
                                         {"smaa1x:preset=ULTRA", 62},
                                         {"smaaS2x:preset=ULTRA", 62},
                                         {"cmaa2", 60},
                                         {"dlaa", 6},
                                         {"nfaa", 1},
                                         {"ssssaa", 1},
                                         {"fxaaconsole", 1},
                                         {"mlaa", 40}})
        EXPECT_GT(influencePx(text, std::max(tooSmall, reachOf(text)) + 20), tooSmall) << text;
    for (const auto& [text, tooSmall] : {std::pair{"dlaa", 0}, {"nfaa", 0}, {"ssssaa", 0}})
        EXPECT_GT(changePx(text, 20), tooSmall) << text;
}

}  // namespace
}  // namespace aa::testing
