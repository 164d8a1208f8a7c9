#include "metrics/differences.h"

#include <gtest/gtest.h>

#include <cmath>

#include "metrics/luma709.h"
#include "metrics/measure.h"

namespace aa {
namespace {

unsigned noise(unsigned x, unsigned y, unsigned c, unsigned seed) {
    unsigned h = x * 374761393u + y * 668265263u + c * 3266489917u + seed * 2654435761u;
    h = (h ^ (h >> 13)) * 1274126177u;
    return (h ^ (h >> 16)) & 255;
}
Rgb picture(bool test) {
    Rgb image(40, 33);
    for (int c = 0; c < 3; c++)
        for (int y = 0; y < 33; y++)
            for (int x = 0; x < 40; x++) {
                const auto n = [&](unsigned seed) { return int(noise(unsigned(x), unsigned(y), unsigned(c), seed)); };
                int code = (x * 5 + y * 3 + c * 40) % 180 + n(1) * 30 / 256;
                if (test) code += n(2) * 41 / 256 - 20;
                image.c[size_t(c)].at(x, y) = float(std::clamp(code, 0, 255)) / 255.0f;
            }
    image.fillBorder();
    return image;
}
FrameMetrics figuresOf(const Rgb& test, const Rgb& reference) {
    MeasureOptions options = measureOptions({"mae", "mseLinear", "snrAc", "psnrLuma709", "ssimValid"});
    TileErrors pool;
    Reference r;
    r.linear = r.encoded = reference;
    return measure({test, &test}, r, options, {}, pool);
}

// Values of numpy 1.24 and scikit-image 0.19 for these pictures: structural_similarity with gaussian_weights,
// sigma 1.5, use_sample_covariance=False and data_range=1, of pictures padded by numpy's "edge" where the border
// counts.
TEST(Differences, AgreeWithNumpyAndScikitImage) {
    const Rgb test = picture(true), reference = picture(false);
    const FrameMetrics m = figuresOf(test, reference);
    EXPECT_NEAR(m.mse, 0.002129934575560469, 1e-9);
    EXPECT_NEAR(m.others.at("mae"), 0.039916816042298735, 1e-9);
    EXPECT_NEAR(m.others.at("acPower"), 0.04067951855346437, 1e-9);
    EXPECT_NEAR(m.others.at("snrAc"), 12.810095407834499, 1e-6);
    EXPECT_NEAR(m.others.at("mseLuma709"), 0.0011984493882996512, 1e-8);
    EXPECT_NEAR(m.others.at("psnrLuma709"), 29.213803019276167, 1e-5);
    EXPECT_NEAR(m.others.at("ssimLuma709"), 0.8127308240862815, 1e-6);
    EXPECT_NEAR(m.others.at("ssimValid"), 0.865192607657062, 1e-6);
    EXPECT_NEAR(ssimLuma(test, reference, {}), 0.8451324960664018, 1e-6);
    EXPECT_EQ(m.others.at("mseLinear"), m.mse);  // here the linear picture is the same one
}
TEST(Differences, IdenticalAndSmall) {
    for (const auto& [w, h] : {std::pair{1, 1}, {40, 10}, {11, 11}}) {
        const Rgb grey(w, h, 0.5f);
        const FrameMetrics m = figuresOf(grey, grey);
        EXPECT_EQ(m.others.at("mae"), 0.0);
        EXPECT_EQ(m.others.at("acPower"), 0.0);
        EXPECT_TRUE(std::isinf(m.others.at("snrAc")) && m.others.at("snrAc") > 0);
        EXPECT_TRUE(std::isinf(m.others.at("psnrLuma709")));
        EXPECT_NEAR(m.others.at("ssimValid"), 1, 1e-9);
    }
    // No contrast at all, and an error.
    EXPECT_EQ(figuresOf(Rgb(4, 4, 0.5f), Rgb(4, 4, 0.25f)).others.at("snrAc"), -INFINITY);
}
// Decibels over frames come from the mean squares: one perfect frame does not make them infinite.
TEST(Differences, DecibelsArePooledBySquares) {
    FrameMetrics means = figuresOf(picture(true), picture(false));
    const double own = means.others.at("psnrLuma709");
    means.others["mseLuma709"] /= 2, means.others["psnrLuma709"] = INFINITY, means.mse /= 2;
    means.others["snrAc"] = INFINITY;
    deriveFromMeans(means);
    EXPECT_NEAR(means.others.at("psnrLuma709"), own + 10 * std::log10(2.0), 1e-9);
    EXPECT_NEAR(means.others.at("snrAc"), 12.810095407834499 + 10 * std::log10(2.0), 1e-6);
}
}  // namespace
}  // namespace aa
