#include "methods/stage.h"

#include <gtest/gtest.h>

#include "image/error.h"
#include "methods/sharpen.h"
#include "methods/spatial/spatial_testing.h"

namespace aa {
namespace {
using namespace aa::testing;

float at(const Rgb& image, int x, int y, size_t c = 0) { return image.c[c].at(x, y); }

TEST(Stage, IsParsedAfterTheMethod) {
    const MethodSpec plain = parseMethod("noaa"), two = parseMethod("fxaa311:subpix=0.5+sharpen=norm+sharpen=xu");
    EXPECT_TRUE(plain.stages.empty());
    ASSERT_EQ(two.stages.size(), 2u);
    EXPECT_EQ(two.method->id, "fxaa311");
    EXPECT_EQ(two.params().real("subpix"), 0.5);
    EXPECT_EQ(two.stages[0].value, "norm");
    EXPECT_EQ(two.stages[1].value, "xu");
    EXPECT_EQ(two.folderName(), "fxaa311_subpix=0.5+sharpen=norm+sharpen=xu");
    EXPECT_EQ(two.outputSpace(), Space::encoded);
}
TEST(Stage, BadStagesAreUsageErrors) {
    EXPECT_THROW(parseMethod("noaa+sharpn=norm"), UsageError);
    EXPECT_THROW(parseMethod("noaa+sharpen"), UsageError);
    EXPECT_THROW(parseMethod("noaa+sharpen="), UsageError);
    EXPECT_THROW(parseMethod("noaa+sharpen=strong"), UsageError);
    EXPECT_THROW(parseMethod("noaa+"), UsageError);
    EXPECT_NO_THROW(parseMethod("fxaa311:subpix=1e+0"));  // the sign of an exponent opens no stage
}
TEST(Stage, RunsInOrderAndKeepsTheMethodsOutputSpace) {
    const Frame frame = frameOf(randomShapes(40, 30, 5));
    Rgb once = resolveOnce("fxaa311", frame), sharpened, twice;
    once.fillBorder();
    sharpen(once, Sharpen::norm, Space::encoded, {}, sharpened);
    sharpened.fillBorder();
    sharpen(sharpened, Sharpen::xu, Space::encoded, {}, twice);
    EXPECT_TRUE(resolveOnce("fxaa311+sharpen=norm", frame).samePixels(sharpened));
    EXPECT_TRUE(resolveOnce("fxaa311+sharpen=norm+sharpen=xu", frame).samePixels(twice));
    EXPECT_FALSE(sharpened.samePixels(twice));
}

TEST(Sharpen, ImpulseGivesTheKernel) {
    Rgb image(7, 7, 0.4f), out;
    for (auto& p : image.c) p.at(3, 3) = 0.5f;
    image.fillBorder();
    sharpen(image, Sharpen::xu, Space::encoded, {}, out);
    EXPECT_NEAR(at(out, 3, 3), 5 * 0.5 - 4 * 0.4, 1e-6);
    EXPECT_NEAR(at(out, 2, 3), 0.4 - 0.1, 1e-6);
    EXPECT_NEAR(at(out, 3, 4), 0.4 - 0.1, 1e-6);
    EXPECT_EQ(at(out, 2, 2), 0.4f);
    sharpen(image, Sharpen::norm, Space::encoded, {}, out);
    EXPECT_NEAR(at(out, 3, 3), 2 * 0.5 - 0.4, 1e-6);
    EXPECT_NEAR(at(out, 2, 3), 0.4 - 0.025, 1e-6);
    sharpen(image, Sharpen::lumaPost, Space::encoded, {}, out);
    EXPECT_NEAR(at(out, 3, 3), 0.5 + (0.5 - (8 * 0.4 + 0.5) / 9), 1e-6);
    EXPECT_NEAR(at(out, 2, 2), 0.4 + (0.4 - (8 * 0.4 + 0.5) / 9), 1e-6);
}
TEST(Sharpen, ClampsToTheDisplayOrToTheNeighbourhood) {
    Rgb image(5, 5, 0.0f), out;
    for (auto& p : image.c) p.at(2, 2) = 1e6f;
    image.fillBorder();
    for (const auto filter : {Sharpen::xu, Sharpen::norm, Sharpen::lumaPost}) {
        sharpen(image, filter, Space::linear, {}, out);
        EXPECT_EQ(at(out, 2, 2), 1e6f);  // 5e6 without the clamp of conventions 9
        EXPECT_EQ(at(out, 1, 2), 0.0f);
        sharpen(image, filter, Space::encoded, {}, out);
        EXPECT_EQ(at(out, 2, 2), 1.0f);
        EXPECT_EQ(at(out, 1, 2), 0.0f);
    }
}
TEST(Sharpen, LumaPostKeepsTheHueAndBlackPixels) {
    Rgb image = randomShapes(30, 20, 9), out;
    for (auto& p : image.c) p.at(4, 4) = 0.0f;
    image.fillBorder();
    sharpen(image, Sharpen::lumaPost, Space::linear, {}, out);
    EXPECT_EQ(at(out, 4, 4), 0.0f);
    sharpen(image, Sharpen::lumaPost, Space::encoded, execOf(Precision::oracle), out);
    int scaled = 0;
    for (int y = 0; y < 20; y++)
        for (int x = 0; x < 30; x++) {
            const double r = at(out, x, y, 0), g = at(out, x, y, 1), b = at(out, x, y, 2);
            if (std::max({r, g, b}) >= 1 || r + g + b <= 0) continue;
            scaled += r != at(image, x, y, 0);
            EXPECT_NEAR(r * at(image, x, y, 1), g * at(image, x, y, 0), 1e-6);
            EXPECT_NEAR(r * at(image, x, y, 2), b * at(image, x, y, 0), 1e-6);
        }
    EXPECT_GT(scaled, 50);
}
TEST(Sharpen, PrecisionsAgree) {
    Rgb image = randomShapes(61, 33, 2), fast, other;
    image.fillBorder();
    for (const auto filter : {Sharpen::xu, Sharpen::norm, Sharpen::lumaPost})
        for (const auto space : {Space::linear, Space::encoded}) {
            sharpen(image, filter, space, {}, fast);
            sharpen(image, filter, space, execOf(Precision::scalar), other);
            EXPECT_TRUE(fast.samePixels(other));
            sharpen(image, filter, space, execOf(Precision::oracle), other);
            EXPECT_LT(largestDifference(fast, other), 3e-6);
        }
}

}  // namespace
}  // namespace aa
