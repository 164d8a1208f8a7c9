#include "shot/synth/placed.h"

#include <gtest/gtest.h>

#include "shot/synth/synth_testing.h"

namespace aa {
namespace {
using glm::dvec2;

// Position `i` of 6 x 6 over pixel (x, y) and what lies within its reach, corners included.
dvec2 positionWithin(int x, int y, double reach, int i) {
    const double step = (1 + 2 * reach) / 5;
    return {x - reach + step * (i % 6), y - reach + step * (i / 6)};
}

class PlacedRows : public testing::TestWithParam<std::string_view> {};
AA_OVER_ALL_SCENES(PlacedRows);

// Asked shape by shape, everywhere: what a row's lists leave out, and pixels in which one answer stands for all.
TEST_P(PlacedRows, SeeWhatAllShapesSee) {
    SynthOptions o;
    o.scene = GetParam();
    o.width = 149, o.height = 61;
    const SynthShot shot(o);
    const std::vector<Placed> placed = placedAt(shot.shapes(), 3);
    for (const double reach : {0.0, 0.5}) {
        const auto shapes = shapesOfRows(placed, o.height, reach);
        int crossed = 0;
        for (int y = 0; y < o.height; y++) {
            const PlacedRow row(shapes[size_t(y)], y, o.width, reach);
            for (int x = 0; x < o.width; x++) {
                crossed += row.isCrossed(x);
                const Placed* first = frontMost(placed, positionWithin(x, y, reach, 0));
                for (int i = 0; i < 36; i++) {
                    const dvec2 p = positionWithin(x, y, reach, i);
                    const Placed* expected = frontMost(placed, p);
                    ASSERT_EQ(row.frontMost(x, p), expected) << x << " " << y;
                    if (!row.isCrossed(x)) {
                        ASSERT_EQ(expected, first) << x << " " << y;
                    }
                }
            }
        }
        if (GetParam() != "zone_plate") {
            EXPECT_GT(crossed, 50);
        }
        if (GetParam() == "half_plane" || GetParam() == "circles") {
            EXPECT_LT(crossed, o.width * o.height * 7 / 10);
        }
    }
}

// A circle's arcs alone are crossed, not what they enclose.
TEST(PlacedRow, OfADiscTheOutline) {
    SynthShape shape;
    shape.region = Disc{{20.5, 10.5}, 8.0};
    const std::vector<Placed> placed = placedAt({shape}, 0);
    const PlacedRow middle(shapesOfRows(placed, 21, 0)[10], 10, 41, 0);
    for (int x = 0; x < 41; x++) EXPECT_EQ(middle.isCrossed(x), x == 12 || x == 28) << x;
    const PlacedRow top(shapesOfRows(placed, 21, 0)[2], 2, 41, 0);
    EXPECT_TRUE(top.isCrossed(20));
    EXPECT_FALSE(top.isCrossed(10));
}

}  // namespace
}  // namespace aa
