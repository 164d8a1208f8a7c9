#include "study/angle_study.h"

#include <gtest/gtest.h>

#include "image/error.h"

namespace aa {
namespace {

AngleStudy study(const std::vector<std::string>& methods, int angles = 16) {
    AngleStudyOptions o;
    for (const auto& text : methods) o.methods.push_back(parseMethod(text));
    o.angles = angles;
    o.offsets = 2;
    o.sizePx = 96;
    return studyAngles(o, {});
}

TEST(AngleStudy, MirroredMethodsGainAlikeAtMirroredAngles) {
    const AngleStudy s = study({"noaa", "mlaa", "cmaa2", "fxaa311:preset=39", "smaa1x:preset=ULTRA", "msaa"});
    EXPECT_EQ(s.methods[5].subsamples, "d3d8");
    EXPECT_EQ(s.methods[1].subsamples, "");
    for (size_t k = 0; k < s.degrees.size(); k++) {
        EXPECT_GT(s.noaaMse[k], 1e-4);
        EXPECT_EQ(s.gainDb(0, k), 0) << s.degrees[k];
        for (size_t m = 1; m < s.methods.size(); m++) EXPECT_GT(s.gainDb(m, k), 0.5) << m << " " << s.degrees[k];
    }
    for (size_t m = 1; m < 5; m++) {
        EXPECT_LT(s.mirrorAsymmetryDb(m), 0.75) << s.methods[m].text;
        EXPECT_LT(s.turnAsymmetryDb(m), 0.75) << s.methods[m].text;
    }
    EXPECT_GT(s.pooledGainDb(4), s.pooledGainDb(3));  // SMAA over FXAA, as in [Oliveros 2018, table 5.2]
    EXPECT_GT(s.turnAsymmetryDb(5), 0.05);            // the D3D pattern does not turn onto itself
}
// The measure sees an asymmetry: a directional filter helps at some angles only.
TEST(AngleStudy, AsymmetryIsSeen) {
    AngleStudy s;
    s.degrees = {45, 135, 225, 315};
    s.noaaMse = {1, 1, 1, 1};
    s.methods = {{"turns", "", "", "", {0.1, 0.1, 0.1, 0.1}},
                 {"mirrors", "", "", "", {0.1, 0.1, 0.01, 0.01}},
                 {"neither", "", "", "", {0.1, 0.01, 0.1, 0.01}}};
    EXPECT_EQ(s.mirrorAsymmetryDb(0), 0);
    EXPECT_EQ(s.turnAsymmetryDb(0), 0);
    EXPECT_NEAR(s.mirrorAsymmetryDb(1), 0, 1e-12);
    EXPECT_NEAR(s.turnAsymmetryDb(1), 10, 1e-12);
    EXPECT_NEAR(s.mirrorAsymmetryDb(2), 10, 1e-12);
    EXPECT_NEAR(s.turnAsymmetryDb(2), 10, 1e-12);
    EXPECT_NEAR(s.pooledGainDb(1), 10 * std::log10(4 / 0.22), 1e-12);
}
TEST(AngleStudy, TemporalMethodsAreJudgedAfterTheirFrames) {
    const AngleStudy s = study({"accum", "taaSimplest"}, 8);
    for (size_t k = 0; k < s.degrees.size(); k++) EXPECT_GT(s.gainDb(0, k), 8) << s.degrees[k];
}
TEST(AngleStudy, WrongUse) { EXPECT_THROW(study({"noaa"}, 10), UsageError); }

}  // namespace
}  // namespace aa
