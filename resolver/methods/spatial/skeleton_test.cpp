// What the property tests (tests/property) cannot know: the method's own definition. They run over the skeletons, too.
#include "methods/spatial/skeleton.h"

#include <gtest/gtest.h>

#include "methods/spatial/spatial_testing.h"

namespace aa {
namespace {
using namespace aa::testing;

// The definition once more, written plainly, in double. Lanes may differ by rounding, the double form hardly.
double expectedSpatialSkeleton(const Rgb& image, size_t c, int x, int y, double threshold, double strength) {
    const int cross[5][2] = {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}};
    double least = 2, most = -1, mean = 0;
    for (const auto& [dx, dy] : cross) {
        const double luma = 0.299 * image.c[0].clamped(x + dx, y + dy) + 0.587 * image.c[1].clamped(x + dx, y + dy) +
                            0.114 * image.c[2].clamped(x + dx, y + dy);
        least = std::min(least, luma), most = std::max(most, luma);
        mean += image.c[c].clamped(x + dx, y + dy) / 5.0;
    }
    const double own = image.c[c].at(x, y);
    return most - least >= threshold ? own + strength * (mean - own) : own;
}
TEST(SpatialSkeleton, ConformsToTheDefinition) {
    const Rgb image = randomShapes(60, 44, 6);
    for (const auto precision : {Precision::fast, Precision::oracle}) {
        const Rgb out = resolveOnce("spatialSkeleton:threshold=0.123,strength=0.75", image, execOf(precision));
        double worst = 0;
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < image.height(); y++)
                for (int x = 0; x < image.width(); x++)
                    worst = std::max(
                        worst, std::abs(out.c[c].at(x, y) - expectedSpatialSkeleton(image, c, x, y, 0.123, 0.75)));
        EXPECT_LT(worst, precision == Precision::fast ? 1e-6 : 1e-7);
    }
}
// A test must be able to fail: what each parameter does is seen when it is left out.
TEST(SpatialSkeleton, ParametersAct) {
    const Rgb image = randomShapes(60, 44, 6);
    const Rgb byDefault = resolveOnce("spatialSkeleton", image);
    EXPECT_TRUE(resolveOnce("spatialSkeleton:strength=0", image).samePixels(image));
    EXPECT_TRUE(resolveOnce("spatialSkeleton:threshold=1", image).samePixels(image));
    EXPECT_FALSE(byDefault.samePixels(image));
    EXPECT_FALSE(byDefault.samePixels(resolveOnce("spatialSkeleton:luma=green", image)));
}
TEST(SpatialSkeleton, ALineOfOnePixelSpreads) {
    Rgb image(9, 5, 0.0f);
    for (auto& p : image.c)
        for (int x = 0; x < 9; x++) p.at(x, 2) = 1.0f;
    const Rgb out = resolveOnce("spatialSkeleton", image);
    const float column[] = {0.0f, 0.2f, 0.6f, 0.2f, 0.0f};
    for (int y = 0; y < 5; y++) EXPECT_NEAR(out.c[0].at(4, y), column[y], 1e-6f) << y;
}

}  // namespace
}  // namespace aa
