#include "metrics/non_finite.h"

#include <gtest/gtest.h>

#include <cmath>

#include "image/colour.h"
#include "metrics/measure.h"

namespace aa {
namespace {

TEST(NonFinite, CountsAsTheLargestDifferenceWhereverItStands) {
    const float inf = INFINITY;
    for (const float broken : {NAN, inf, -inf})
        for (const float reference : {0.0f, 1.0f, 0.2f, 0.7f}) {
            Rgb source(9, 5, 0.5f), shown;
            source.c[1].at(4, 2) = broken;
            const Rgb truth(9, 5, reference);
            encode(source, {}, {}, shown);
            const Rgb before = shown;
            putFarthest(&source, nullptr, truth, shown);
            EXPECT_EQ(shown.c[1].at(4, 2), reference < 0.5f ? 1.0f : 0.0f);
            EXPECT_TRUE(shown.c[0].samePixels(before.c[0]));
            EXPECT_EQ(shown.c[1].at(3, 2), before.c[1].at(3, 2));
            Rgb other = before;  // the same of a broken reference
            putFarthest(nullptr, &source, truth, other);
            EXPECT_TRUE(other.samePixels(shown));
        }
}

TEST(NonFinite, AReferenceRemembersWhatItsEncodingHides) {
    Rgb half(8, 8, 0.5f);
    EXPECT_TRUE(makeReference(half, half, {}, {}).broken.empty());
    half.c[2].at(1, 1) = NAN;
    for (const Transfer transfer : {Transfer::srgb, Transfer::identity})
        EXPECT_TRUE(std::isnan(makeReference(half, Rgb(8, 8, 0.5f), {.transfer = transfer}, {}).broken.c[2].at(1, 1)));
}

}  // namespace
}  // namespace aa
