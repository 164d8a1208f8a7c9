#include "metrics/glance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <tuple>

#include "metrics/metrics_testing.h"

namespace aa {
namespace {

constexpr int kGlanceWidth = 75, kGlanceHeight = 43;  // neither whole tiles nor whole blocks of rows

Reference referenceOf(const Rgb& a, const Rgb& b) {
    Reference r = makeReference(a, b, {}, {});
    prepare(r, {}, {});
    return r;
}

TEST(Glance, TellsWhatEachWouldTellByItself) {
    const Rgb a = noisePicture(kGlanceWidth, kGlanceHeight, 1), b = noisePicture(kGlanceWidth, kGlanceHeight, 2),
              resolved = noisePicture(kGlanceWidth, kGlanceHeight, 3);
    Rgb shown;
    encode(resolved, {}, {}, shown);
    for (const Reference& reference : {referenceOf(a, a), referenceOf(a, b)})
        for (const Exec& exec : {Exec{}, Exec{.parallel = false}, Exec{.precision = Precision::scalar}}) {
            const Glance g = glance(resolved, shown, &reference, true, exec);
            EXPECT_TRUE(g.isFinite);
            const PlaneF luma = pictureLuma(shown, exec);
            EXPECT_TRUE(g.luma.samePixels(luma));
            EXPECT_EQ(g.luma.at(-3, -2), luma.at(-3, -2)) << "the border is filled";
            const TileErrors expected = tileErrors(shown, reference, exec);
            EXPECT_EQ(g.errors->sum, expected.sum);
            EXPECT_EQ(g.errors->againstA, expected.againstA);
            EXPECT_EQ(g.errors->againstB, expected.againstB);
            EXPECT_EQ(g.errors->values, expected.values);
            EXPECT_EQ(g.errors->referenceSum, expected.referenceSum);
            EXPECT_EQ(g.errors->columns, expected.columns);
        }
    EXPECT_FALSE(referenceOf(a, b).encodedA.empty()) << "two halves were tried";
}

TEST(Glance, SeesAValueThatIsNoNumberInAnyPlaceOfWhatWasResolved) {
    for (const float value : {std::numeric_limits<float>::quiet_NaN(), INFINITY, -INFINITY})
        for (const auto& [x, y, c] : {std::tuple{0, 0, 0}, {kGlanceWidth - 1, kGlanceHeight - 1, 2}, {37, 8, 1}}) {
            Rgb resolved = noisePicture(kGlanceWidth, kGlanceHeight, 4);
            const Rgb shown = resolved;
            resolved.c[size_t(c)].at(x, y) = value;
            const Glance g = glance(resolved, shown, nullptr, false, {});
            EXPECT_FALSE(g.isFinite) << x << ' ' << y;
            EXPECT_TRUE(g.luma.empty());
            EXPECT_FALSE(g.errors);
        }
    EXPECT_TRUE(glance(Rgb(kGlanceWidth, kGlanceHeight, std::numeric_limits<float>::max()),
                       Rgb(kGlanceWidth, kGlanceHeight), nullptr, true, {})
                    .isFinite);
}

}  // namespace
}  // namespace aa
