#include "shot/synth/coverage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace aa {
namespace {
using glm::dvec2;
const Polygon kPixel = rectangle(3, 7, 4, 8);

// Share of a fine regular grid of the pixel's points whose first containing region is i (last: none).
std::vector<double> countedAreas(std::span<const Region* const> regions) {
    constexpr int n = 400;
    std::vector<double> r(regions.size() + 1);
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            const dvec2 p(3 + (i + .5) / n, 7 + (j + .5) / n);
            size_t k = 0;
            while (k < regions.size() && !contains(*regions[k], p)) k++;
            r[k] += 1.0 / (n * n);
        }
    return r;
}

TEST(Coverage, HalfPlanesOfThePixel) {
    EXPECT_NEAR(area(clip(kPixel, {{1, 0}, 3.2})), 0.2, 1e-15);
    EXPECT_NEAR(area(clip(kPixel, {{-1, 0}, -3.2})), 0.8, 1e-15);
    EXPECT_NEAR(area(clip(kPixel, {{1, 1}, 10.5})), 0.125, 1e-15);
    EXPECT_EQ(area(clip(kPixel, {{1, 0}, 2.9})), 0);
    EXPECT_EQ(area(clip(kPixel, {{1, 0}, 4.5})), 1);
}

TEST(Coverage, DiscsOfKnownArea) {
    EXPECT_NEAR(area(kPixel, Disc{{3.5, 7.5}, 0.3}), std::numbers::pi * 0.09, 1e-15);
    EXPECT_NEAR(area(kPixel, Disc{{3, 7}, 0.5}), std::numbers::pi / 16, 1e-15);  // a quarter
    EXPECT_NEAR(area(kPixel, Disc{{3.5, 7}, 0.25}), std::numbers::pi / 32, 1e-15);
    EXPECT_NEAR(area(kPixel, Disc{{3.5, 7.5}, 5}), 1, 1e-13);
    EXPECT_EQ(area(kPixel, Disc{{30, 70}, 5}), 0);
    // All pixels together hold the whole disc.
    double sum = 0;
    for (int y = 0; y < 40; y++)
        for (int x = 0; x < 40; x++) sum += area(rectangle(x, y, x + 1, y + 1), Disc{{19.3, 20.7}, 17.2});
    EXPECT_NEAR(sum, std::numbers::pi * 17.2 * 17.2, 1e-11);
}

// Areas as counting finds them, none below 0, and together the pixel.
void expectCountedAndFull(std::span<const Region* const> regions, int trial) {
    const auto exact = visibleAreas(kPixel, regions), counted = countedAreas(regions);
    double sum = 0;
    for (size_t i = 0; i < exact.size(); i++) {
        EXPECT_NEAR(exact[i], counted[i], 3e-3) << trial << " " << i;
        EXPECT_GE(exact[i], -1e-12);
        sum += exact[i];
    }
    EXPECT_NEAR(sum, 1, 1e-12);
}
TEST(Coverage, LayersAgreeWithCountingAndFillThePixel) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> u(-0.6, 1.6);
    for (int trial = 0; trial < 60; trial++) {
        const auto p = [&] { return dvec2(3 + u(random), 7 + u(random)); };
        const Region a = Polygon{p(), p(), p()}, disc = Disc{p(), 0.2 + 0.4 * std::abs(u(random))},
                     c = Polygon{p(), p(), p()};
        const Region* orders[][3] = {{&a, &disc, &c}, {&disc, &a, &c}, {&a, &c, &disc}};
        expectCountedAndFull(orders[trial % 3], trial);
    }
}

TEST(Coverage, OverlappingDiscsAgreeWithCountingAndFillThePixel) {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> u(-0.3, 1.3);
    for (int trial = 0; trial < 60; trial++) {
        const auto p = [&] { return dvec2(3 + u(random), 7 + u(random)); };
        const auto disc = [&] { return Region(Disc{p(), 0.1 + 0.5 * std::abs(u(random))}); };
        const Region a = disc(), b = disc(), c = Polygon{p(), p(), p()}, d = disc(), e = disc();
        const Region* orders[][6] = {{&a, &b, &c, &d, &e, &a}, {&c, &a, &b, &d, &d, &e}, {&a, &b, &d, &e, &c, &b}};
        expectCountedAndFull(orders[trial % 3], trial);
    }
}

TEST(Coverage, UnionsOfKnownArea) {
    // Two unit discs one radius apart: 2 pi - (2 pi / 3 - sqrt(3) / 2).
    const Disc two[] = {{{20, 20}, 1}, {{21, 20}, 1}};
    const double lens = 2 * std::numbers::pi / 3 - std::sqrt(3.0) / 2;
    EXPECT_NEAR(area(rectangle(10, 10, 30, 30), two), 2 * std::numbers::pi - lens, 1e-12);
    EXPECT_NEAR(area(rectangle(10, 10, 30, 20), two), std::numbers::pi - lens / 2, 1e-12);
    const Disc nested[] = {{{20, 20}, 2}, {{20.3, 20.1}, 1}, {{20, 20}, 2}};
    EXPECT_NEAR(area(rectangle(10, 10, 30, 30), nested), 4 * std::numbers::pi, 1e-12);
    const Disc apart[] = {{{15, 20}, 1}, {{25, 20}, 2}};
    EXPECT_NEAR(area(rectangle(10, 10, 30, 30), apart), 5 * std::numbers::pi, 1e-12);
    const Disc around[] = {{{20, 20}, 50}, {{21, 20}, 50}};
    EXPECT_NEAR(area(rectangle(10, 10, 30, 30), around), 400, 1e-10);
}

TEST(Coverage, AbuttingRegionsLeaveNoGap) {
    const HalfPlane h{{0.3, 0.95}, 8.4};
    const Region a = clip(rectangle(0, 0, 10, 10), h), b = clip(rectangle(0, 0, 10, 10), {-h.normal, -h.offset});
    const Region* regions[] = {&a, &b};
    const auto areas = visibleAreas(kPixel, regions);
    EXPECT_NEAR(areas[2], 0, 1e-15);
    EXPECT_GT(areas[0], 0.1);
    EXPECT_GT(areas[1], 0.1);
}
}  // namespace
}  // namespace aa
