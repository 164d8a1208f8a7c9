#include "methods/reference/resolve_filters.h"

#include <gtest/gtest.h>

#include <cmath>

#include "image/error.h"
#include "methods/spec.h"

namespace aa {
namespace {
using F = ResolveFilter;
const std::vector<glm::dvec2> k4x = {
    {-2 / 16., -6 / 16.}, {6 / 16., -2 / 16.}, {-6 / 16., 2 / 16.}, {2 / 16., 6 / 16.}};

TEST(ResolveFilters, ReferenceValues) {
    // Mitchell and Catmull-Rom at t = 2x = 0, .5, 1, 1.5; Blackman-Harris at x = .25, .5, .75.
    const double mitchell[] = {0.888889, 0.534722, 0.055556, -0.034722}, catmull[] = {1, 0.5625, 0, -0.0625};
    for (int i = 0; i < 4; i++) {
        EXPECT_NEAR(filterWeight({F::mitchell, 2}, i * 0.25), mitchell[i], 1e-6);
        EXPECT_NEAR(filterWeight({F::catmullRom, 2}, i * 0.25), catmull[i], 1e-6);
    }
    EXPECT_NEAR(filterWeight({F::blackmanHarris, 2}, 0), 1, 1e-6);
    EXPECT_NEAR(filterWeight({F::blackmanHarris, 2}, 0.25), 0.695764, 1e-6);
    EXPECT_NEAR(filterWeight({F::blackmanHarris, 2}, 0.5), 0.217470, 1e-6);
    EXPECT_NEAR(filterWeight({F::blackmanHarris, 2}, 0.75), 0.021736, 1e-6);
    EXPECT_NEAR(filterWeight({F::blackmanHarris, 2}, 1), 6e-5, 1e-6);
    EXPECT_NEAR(filterWeight({F::sinc, 2}, 0.5), 0, 1e-12);  // half a pixel
    EXPECT_NEAR(filterWeight({.filter = F::sinc, .diameterPx = 2, .textbookSinc = true}, 1), 0, 1e-12);
    EXPECT_NEAR(filterWeight({F::tent, 2}, 0.25), 0.75, 1e-12);
    EXPECT_NEAR(filterWeight({F::smoothstep, 2}, 0.5), 0.5, 1e-12);
    EXPECT_NEAR(filterWeight({F::smoothstep, 2}, 0.25), 1 - 0.0625 * 2.5, 1e-12);
    EXPECT_NEAR(filterWeight({F::gaussian, 2}, 0.5), std::exp(-0.5), 1e-12);  // at one sigma
    EXPECT_NEAR(filterWeight({.filter = F::gaussian, .diameterPx = 2, .sigma = 0.25}, 0.5), std::exp(-2.0), 1e-12);
    // B-spline: 2/3, 23/48, 1/6 and 1/48 at t = 0, .5, 1, 1.5; the general cubic at its parameters is the same.
    const double bspline[] = {2 / 3., 23 / 48., 1 / 6., 1 / 48.};
    for (int i = 0; i < 4; i++) {
        EXPECT_NEAR(filterWeight({F::bspline, 2}, i * 0.25), bspline[i], 1e-12);
        EXPECT_NEAR(filterWeight({.filter = F::cubic, .diameterPx = 2, .b = 1, .c = 0}, i * 0.25), bspline[i], 1e-12);
        EXPECT_NEAR(filterWeight({.filter = F::cubic, .diameterPx = 2, .b = 1 / 3., .c = 1 / 3.}, i * 0.25),
                    mitchell[i], 1e-6);
    }
    // sin(pi u) / (pi u) at u = 2 |dx| = 1/2 and, textbook, at |dx| = 1/2.
    const double atHalf = 2 / 3.141592653589793;
    EXPECT_NEAR(filterWeight({F::sinc, 2}, 0.25), atHalf, 1e-12);
    EXPECT_NEAR(filterWeight({.filter = F::sinc, .diameterPx = 2, .textbookSinc = true}, 0.5), atHalf, 1e-12);
    EXPECT_EQ(filterWeight({F::sinc, 2}, 1e-4), 1);
    // Lanczos of two lobes, radius 2 px: sinc(u) sinc(u / 2) at u = 1/2 and 1.
    const double quarter = std::sin(3.141592653589793 / 4) / (3.141592653589793 / 4);
    EXPECT_NEAR(filterWeight({F::lanczos, 4}, 0.25), atHalf * quarter, 1e-12);
    EXPECT_NEAR(filterWeight({F::lanczos, 4}, 0.5), 0, 1e-12);
}
TEST(ResolveFilters, WeightsAreNormalisedAndSymmetric) {
    const std::vector<glm::dvec2> grid = {{-.25, -.25}, {.25, -.25}, {-.25, .25}, {.25, .25}};
    for (int f = 0; f <= int(F::lanczos); f++) {
        const auto taps = resolveTaps({F(f), 4}, grid);
        double sum = 0, mx = 0, my = 0;
        for (const auto& t : taps) {
            sum += t.weight;
            mx += t.weight * (t.dx + grid[size_t(t.sample)].x);
            my += t.weight * (t.dy + grid[size_t(t.sample)].y);
        }
        EXPECT_NEAR(sum, 1, 1e-5) << f;
        EXPECT_NEAR(mx, 0, 1e-5) << f;
        EXPECT_NEAR(my, 0, 1e-5) << f;
    }
}
TEST(ResolveFilters, BoxOfOnePixelIsTheMean) {
    const auto taps = resolveTaps({}, k4x);
    ASSERT_EQ(taps.size(), 4u);
    for (const auto& t : taps) {
        EXPECT_EQ(t.dx, 0);
        EXPECT_EQ(t.dy, 0);
        EXPECT_EQ(t.weight, 0.25f);
    }
}
TEST(ResolveFilters, FootprintReachesIntoNeighbours) {
    const auto taps = resolveTaps({F::tent, 2}, k4x);
    EXPECT_GT(taps.size(), 4u);
    for (const auto& t : taps) EXPECT_LE(std::abs(t.dx), 1);
    // A sample at the radius exactly belongs to it; beyond, none.
    for (const auto& t : resolveTaps({F::box, 3}, {{0, 0}})) EXPECT_LE(std::max(std::abs(t.dx), std::abs(t.dy)), 1);
    EXPECT_EQ(resolveTaps({F::box, 3}, {{0, 0}}).size(), 9u);
}
// conventions 11: lobes that cancel leave the box, for all pixels or for the one where luminance weights cancel.
TEST(ResolveFilters, CancellingWeightsLeaveTheBox) {
    const auto taps = resolveTaps({F::sinc, 1}, {{0.5, 0}, {-0.5, 0}});  // both where the sinc is zero
    ASSERT_EQ(taps.size(), 2u);
    for (const auto& t : taps) EXPECT_EQ(t.weight, 0.5f);
    // Two samples of weight +w and -w/4 whose luminances make up for it.
    const std::vector<glm::dvec2> positions = {{0, 0}, {0.375, 0}};
    const auto catmull = resolveTaps({F::catmullRom, 1}, positions);
    ASSERT_EQ(catmull.size(), 2u);
    const double w0 = catmull[0].weight, w1 = catmull[1].weight;
    ASSERT_LT(w1, 0);
    Frame f;
    f.width = 3, f.height = 2;
    f.subSamplePositionsPx = positions;
    // w0 / (1 + Y0) + w1 / (1 + Y1) = 0 with Y1 = 0.
    const float y0 = float(-w0 / w1 - 1);
    f.subSamples.resize(2);
    f.subSamples[0].colorLinear = Rgb(3, 2, y0), f.subSamples[1].colorLinear = Rgb(3, 2, 0.0f);
    for (auto& s : f.subSamples) s.colorLinear.fillBorder();
    Rgb out(3, 2);
    parseMethod("resolve:filter=catmullRom,diameter=1,inverseLuminance=on")
        .create({.width = 3, .height = 2, .subSamplePositionsPx = positions})
        ->resolve(f, {}, out);
    EXPECT_FLOAT_EQ(out.c[0].at(1, 1), y0 / 2);
}
TEST(ResolveFilters, ResolvesAnImage) {
    Frame f;
    f.width = 6, f.height = 5;
    for (size_t k = 0; k < 4; k++) {
        f.subSamples.emplace_back();
        f.subSamples.back().colorLinear = Rgb(6, 5, 0.2f);
        f.subSamples.back().colorLinear.c[1].at(3, 2) = float(k);
        f.subSamples.back().colorLinear.c[2].at(3, 2) = -5.0f;  // radiance is never negative
        f.subSamples.back().colorLinear.fillBorder();
    }
    f.subSamplePositionsPx = k4x;
    const ShotInfo shot{.width = 6, .height = 5, .subSamplePositionsPx = k4x};
    Rgb out(6, 5);
    parseMethod("resolve").create(shot)->resolve(f, {}, out);
    EXPECT_FLOAT_EQ(out.c[1].at(3, 2), 1.5f);
    EXPECT_FLOAT_EQ(out.c[2].at(3, 2), 0.0f);
    EXPECT_EQ(out.c[0].at(3, 2), 0.2f);
    parseMethod("resolve:filter=catmullRom,diameter=4").create(shot)->resolve(f, {}, out);
    EXPECT_EQ(out.c[0].at(2, 2), 0.2f);
    EXPECT_NE(out.c[1].at(2, 2), 0.2f);
    // Weights 1/(1 + Y): bright samples count less.
    parseMethod("resolve:inverseLuminance=on").create(shot)->resolve(f, {}, out);
    EXPECT_LT(out.c[1].at(3, 2), 1.5f);
    EXPECT_THROW(parseMethod("resolve").create({.width = 6, .height = 5}), InputError);
    EXPECT_THROW(parseMethod("resolve:sigma=1"), UsageError);
}

}  // namespace
}  // namespace aa
