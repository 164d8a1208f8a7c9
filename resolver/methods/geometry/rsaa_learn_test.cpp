#include "methods/geometry/rsaa_learn.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "methods/geometry/rsaa_lut_data.h"

namespace aa {
namespace {

TEST(RsaaLearn, ShippedOffsetsAreTheLearnedOnesToTheBit) {
    for (const size_t samples : {4u, 8u, 16u}) {
        const auto learned = learnRsaa(d3dPattern(samples), RsaaTraining::all);
        const auto shipped = shippedRsaaEntries(samples);
        ASSERT_EQ(learned.size(), shipped.size()) << samples;
        for (size_t i = 0; i < learned.size(); i++) EXPECT_EQ(learned[i], shipped[i]) << samples << " entry " << i;
    }
}

// Offsets learned from half-planes alone, +-0.06 of training noise (conventions 14).
TEST(RsaaLearn, HalfPlaneOffsets) {
    const auto table = rsaaTable(8, learnRsaa(d3dPattern(8), RsaaTraining::halfPlanes));
    struct Entry {
        size_t mask;
        double u, v, toleranceV;
    };
    // 0xcf: the error changes by 1 % along v from 0.03 to -0.10 (a flat valley), so v is wider there.
    for (const Entry& e : {Entry{0x7f, 0.070, -0.070, 0.06}, Entry{0xbf, 0.039, 0.117, 0.06},
                           Entry{0xcf, -0.242, -0.102, 0.14}, Entry{0xd7, -0.266, 0.086, 0.06},
                           Entry{0x3b, 0.344, 0.039, 0.06}, Entry{0x8d, -0.438, -0.070, 0.06}, Entry{0xff, 0, 0, 0}}) {
        EXPECT_NEAR(table[2 * e.mask], e.u, 0.06) << std::hex << e.mask;
        EXPECT_NEAR(table[2 * e.mask + 1], e.v, e.toleranceV) << std::hex << e.mask;
    }
}

// A vertical edge that covers the fraction f on the right asks for (f, 0).
TEST(RsaaLearn, VerticalEdgesMoveByTheCoveredFraction) {
    for (const size_t samples : {4u, 8u, 16u}) {
        const auto positionsPx = d3dPattern(samples);
        const auto table = rsaaTable(samples, learnRsaa(positionsPx, RsaaTraining::halfPlanes));
        for (double edge = 0.02; edge < 0.5; edge += 0.05) {
            size_t mask = 0;
            for (size_t k = 0; k < samples; k++) mask |= size_t(positionsPx[k].x < edge) << k;
            if (mask + 1 == size_t(1) << samples) continue;
            EXPECT_NEAR(table[2 * mask], 0.5 - edge, 1.0 / double(samples)) << samples << " edge at " << edge;
        }
    }
}

// conventions 14: 10.4 / 13.9 / 18.2 dB for half-planes alone; 8.6 / 12.7 / 15.0 for the sub-sample mean.
TEST(RsaaLearn, GainsOnHalfPlanes) {
    struct Expected {
        size_t samples;
        double halfPlanes, all, mean;
    };
    for (const auto& e : {Expected{4, 10.4, 9.5, 8.6}, Expected{8, 13.9, 13.0, 12.7}, Expected{16, 18.2, 17.0, 15.0}}) {
        const auto positionsPx = d3dPattern(e.samples);
        const auto gain = [&](RsaaTraining training) {
            const auto errors = halfPlaneErrors(positionsPx, rsaaTable(e.samples, learnRsaa(positionsPx, training)));
            EXPECT_NEAR(10 * std::log10(errors.noaa / errors.msaa), e.mean, 0.1);
            return 10 * std::log10(errors.noaa / errors.rsaa);
        };
        EXPECT_NEAR(gain(RsaaTraining::halfPlanes), e.halfPlanes, 0.1) << e.samples;
        EXPECT_GE(gain(RsaaTraining::all), e.all) << e.samples;  // a little less: wedges and strips count too
    }
}

TEST(RsaaLearn, MasksWithoutTrainingTakeTheMeanOfTheNearestOnes) {
    const std::vector<RsaaEntry> trained = {{0b0001, 64, 0}, {0b0100, 0, 128}};
    const auto table = rsaaTable(4, trained);
    EXPECT_EQ(table[2 * 0b0001], 0.25f);
    EXPECT_EQ(table[2 * 0b1001], 0.25f);  // one bit from the first, three from the second
    EXPECT_EQ(table[2 * 0b1001 + 1], 0.0f);
    EXPECT_EQ(table[2 * 0b0000], 0.125f);  // one bit from both
    EXPECT_EQ(table[2 * 0b0000 + 1], 0.25f);
    EXPECT_EQ(table[2 * 0b1111], 0.0f);  // all ones never move
    for (const float v : rsaaTable(4, {})) EXPECT_EQ(v, 0.0f);
}
// conventions 14: half-planes realise 9 / 35 / 130 masks; tables have 16, 256 and 65536 entries.
TEST(RsaaLearn, MasksThatHalfPlanesRealise) {
    for (const auto& [samples, masks] : {std::pair{4u, 9u}, {8u, 35u}, {16u, 130u}}) {
        const auto positionsPx = d3dPattern(samples);
        std::set<uint32_t> seen;
        for (int i = 0; i < 7200; i++)
            for (int j = -300; j <= 300; j++) {
                const double angle = 6.283185307179586 * (i + 0.37) / 7200, r = 0.75 * (j + 0.21) / 300;
                const double nx = std::cos(angle), ny = std::sin(angle);
                uint32_t mask = 0;
                for (size_t k = 0; k < samples; k++)
                    mask |= uint32_t((nx * positionsPx[k].x + ny * positionsPx[k].y < r) == (0 < r)) << k;
                seen.insert(mask);
            }
        EXPECT_NEAR(double(seen.size()), masks, samples == 16 ? 2 : 0) << samples;
        const auto learned = learnRsaa(positionsPx, RsaaTraining::halfPlanes);
        EXPECT_LE(learned.size(), seen.size());
        for (const auto& e : learned) EXPECT_TRUE(seen.count(e.mask)) << samples << " " << e.mask;
        EXPECT_EQ(rsaaTable(samples, learned).size(), size_t(2) << samples);
    }
}

}  // namespace
}  // namespace aa
