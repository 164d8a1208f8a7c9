#include <gtest/gtest.h>

#include <cmath>

#include "shot/synth/synth.h"
#include "shot/synth/synth_testing.h"

namespace aa {
namespace {
using glm::dvec2;
using glm::dvec3;

class SynthSubSamples : public testing::TestWithParam<std::string_view> {};
AA_OVER_ALL_SCENES(SynthSubSamples);

// Jittered, some lie in the row or the column beside their pixel's.
TEST_P(SynthSubSamples, SeeWhatLiesAtTheirPlace) {
    SynthOptions o;
    o.scene = GetParam();
    o.width = 121, o.height = 77, o.frames = 4;
    o.subsamples = "d3d8", o.subsampleColor = true;
    const SynthShot shot(o);
    int beyond = 0, wrong = 0;
    for (size_t frame = 1; frame < 4; frame++) {
        const Frame f = shot.frame(frame);
        const auto picture = shot.picture(frame);
        const auto check = [&](const Rgb& color, int x, int y, dvec2 place) {
            beyond += std::floor(place.y) != y;
            const dvec3 expected = picture(place);
            for (int c = 0; c < 3; c++) wrong += color.c[size_t(c)].at(x, y) != float(expected[c]);
        };
        for (int y = 0; y < o.height; y++)
            for (int x = 0; x < o.width; x++) {
                const dvec2 p = dvec2(x + 0.5, y + 0.5) + f.jitterPx;
                check(f.colorLinear, x, y, p);
                for (size_t k = 0; k < f.subSamples.size(); k++)
                    check(f.subSamples[k].colorLinear, x, y, p + f.subSamplePositionsPx[k]);
            }
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(beyond, 1000);
}

}  // namespace
}  // namespace aa
