// Boxes whose sides run along the axes lie at one offset in all pixels of a side: a picture of few of them cannot tell
// where its samples were, and a check that guesses calls right shots wrong.
#include "shot/check/jitter.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <random>

namespace aa {
namespace {
using glm::dvec2;
using testing::HasSubstr;
constexpr int kJitterWidth = 96, kJitterHeight = 64;

struct Box {
    dvec2 low, high;
    float shade;
};
struct Disc {
    dvec2 centre;
    double radius;
    float shade;
};
struct Picture {
    std::vector<Box> boxes;
    std::vector<Disc> discs;
    float at(dvec2 p) const {
        float shade = 0.1f;
        for (const auto& b : boxes)
            if (p.x > b.low.x && p.x < b.high.x && p.y > b.low.y && p.y < b.high.y) shade = b.shade;
        for (const auto& d : discs)
            if (glm::length(p - d.centre) < d.radius) shade = d.shade;
        return shade;
    }
    PlaneF sampled(dvec2 jitterPx) const {
        PlaneF plane(kJitterWidth, kJitterHeight);
        for (int y = 0; y < kJitterHeight; y++)
            for (int x = 0; x < kJitterWidth; x++) plane.at(x, y) = at(dvec2(x, y) + 0.5 + jitterPx);
        plane.fillBorder();
        return plane;
    }
    PlaneF mean() const {
        constexpr int kSide = 16;
        PlaneF plane(kJitterWidth, kJitterHeight);
        for (int y = 0; y < kJitterHeight; y++)
            for (int x = 0; x < kJitterWidth; x++) {
                double sum = 0;
                for (int j = 0; j < kSide; j++)
                    for (int i = 0; i < kSide; i++) sum += at(dvec2(x, y) + (dvec2(i, j) + 0.5) / double(kSide));
                plane.at(x, y) = float(sum / (kSide * kSide));
            }
        plane.fillBorder();
        return plane;
    }
};

Picture boxes(uint32_t seed, int count) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> u(0, 1);
    Picture picture;
    for (int i = 0; i < count; i++) {
        const dvec2 low(4 + u(random) * (kJitterWidth - 40), 4 + u(random) * (kJitterHeight - 34));
        picture.boxes.push_back({low, low + dvec2(12 + 20 * u(random), 12 + 16 * u(random)), 0.3f + 0.2f * float(i)});
    }
    return picture;
}
Picture discs() { return {{}, {{{24.3, 30.7}, 17.2, 0.9f}, {{66.4, 28.1}, 14.6, 0.7f}}}; }

double radicalInverse(int base, int n) {
    double value = 0, scale = 1;
    for (; n; n /= base) value += n % base * (scale /= base);
    return value;
}

// Checks 16 frames sampled at Halton's jitter, with what the manifest states of it.
CheckReport judged(const Picture& picture, dvec2 (*stated)(dvec2)) {
    const PlaneF mean = picture.mean();
    JitterCheck check;
    for (int n = 1; n <= 16; n++) {
        const dvec2 jitterPx(radicalInverse(2, n) - 0.5, radicalInverse(3, n) - 0.5);
        const PlaneF sample = picture.sampled(jitterPx);
        FrameEntry entry;
        entry.frame = n;
        entry.jitterPx = stated(jitterPx);
        check.add(entry, registerSamples({&sample}, {&mean}));
    }
    CheckReport report;
    check.judge(report);
    return report;
}
dvec2 asItIs(dvec2 j) { return j; }
dvec2 turnedX(dvec2 j) { return {-j.x, j.y}; }
dvec2 turnedY(dvec2 j) { return {j.x, -j.y}; }
dvec2 exchanged(dvec2 j) { return {j.y, j.x}; }
dvec2 inClipSpace(dvec2 j) { return j / double(kJitterWidth); }

TEST(JitterCheck, RightJitterOfBoxesIsNeverCalledWrong) {
    for (uint32_t seed = 1; seed <= 25; seed++)
        for (int count : {1, 2, 3, 6, 12}) {
            const CheckReport report = judged(boxes(seed, count), asItIs);
            for (const auto& f : report.findings)
                ADD_FAILURE() << count << " boxes, seed " << seed << ": frame " << f.frame.value_or(0) << ", "
                              << f.found << ", " << f.advice;
        }
}

// Among tangled edges the fit is shortened and wins what few pixels differ, but explains the others badly: it is no
// better a statement than the one in the manifest.
TEST(JitterCheck, AnOffsetThatExplainsLittleIsNoRival) {
    const dvec2 stated(-0.45, -0.4), fitted(-0.05, 0.0);
    const MeanOf area;
    for (const double explained : {0.8, 0.99}) {
        Registration found;
        found.offsetPx = fitted;
        found.sigmaPx = dvec2(0.01);
        found.pixels = 1000;
        for (size_t direction = 0; direction < EdgeVotes::kDirections; direction++)
            for (size_t share = 0; share < EdgeVotes::kShares; share++)
                for (int n = 0; n < 100; n++) {
                    const auto one = area.bright(direction, share, stated),
                               other = area.bright(direction, share, fitted);
                    if (!other) continue;
                    const bool differs = one && *one != *other;
                    const bool shown = n < 100 * (differs ? 0.85 : explained);
                    found.votes.add(EdgeVotes::normalOf(direction), EdgeVotes::shareOf(share), *other == shown);
                }
        JitterCheck check;
        FrameEntry entry;
        entry.frame = 3;
        entry.jitterPx = stated;
        check.add(entry, found);
        for (int n = 4; n < 8; n++) {  // the others agree
            Registration right;
            right.offsetPx = entry.jitterPx = dvec2(0.1 * n - 0.5, 0.2);
            right.sigmaPx = dvec2(0.01);
            right.pixels = 1000;
            entry.frame = n;
            check.add(entry, right);
        }
        CheckReport report;
        check.judge(report);
        EXPECT_EQ(report.findings.size(), explained > 0.9 ? 1u : 0u) << area.borneOut(found.votes, fitted);
        if (explained < 0.9) {
            EXPECT_THAT(testing::PrintToString(report.notChecked), HasSubstr("tangled"));
        }
    }
}

TEST(JitterCheck, WhatEdgesOfFewPlacesHideIsSaid) {
    // The sides of this box lie at the middle of their pixels in x, where no jitter but the sign of it matters.
    const Picture aligned{{{{20.0, 12.5}, {60.0, 44.5}, 0.8f}}, {}};
    const CheckReport report = judged(aligned, asItIs);
    EXPECT_TRUE(report.findings.empty());
    EXPECT_THAT(testing::PrintToString(report.notChecked), HasSubstr("jitter"));
}

TEST(JitterCheck, WrongJitterOfRoundShapesIsFound) {
    EXPECT_TRUE(judged(discs(), asItIs).findings.empty());
    EXPECT_EQ(testing::PrintToString(judged(discs(), asItIs).notChecked), "{}");
    const std::pair<dvec2 (*)(dvec2), const char*> wrong[] = {{turnedX, "sign of the jitter in x"},
                                                              {turnedY, "sign of the jitter in y"},
                                                              {exchanged, "exchange the axes"},
                                                              {inClipSpace, "in pixels"}};
    for (const auto& [change, advice] : wrong) {
        const CheckReport report = judged(discs(), change);
        ASSERT_EQ(report.findings.size(), 1u) << advice;
        EXPECT_THAT(report.findings[0].advice, HasSubstr(advice));
    }
}

TEST(JitterCheck, ManyBoxesShowATurnedSign) {
    const Picture many = boxes(7, 14);
    EXPECT_EQ(judged(many, turnedX).findings.size(), 1u);
    EXPECT_EQ(judged(many, turnedY).findings.size(), 1u);
}

// The place of an edge that the mean's share gives is where samples change sides.
TEST(EdgeVotes, PlaceOfAnEdge) {
    const MeanOf area;
    for (size_t direction = 0; direction < EdgeVotes::kDirections; direction++)
        for (size_t share = 0; share < EdgeVotes::kShares; share++) {
            const dvec2 n = EdgeVotes::normalOf(direction);
            // Area on the bright side for a place d, by counting.
            const auto shareBeyond = [&](double d) {
                int beyond = 0;
                for (int j = 0; j < 200; j++)
                    for (int i = 0; i < 200; i++) beyond += glm::dot(n, (dvec2(i, j) + 0.5) / 200.0 - 0.5) > d;
                return beyond / 40000.0;
            };
            double low = -0.75, high = 0.75;
            for (int step = 0; step < 20; step++)
                (shareBeyond((low + high) / 2) > EdgeVotes::shareOf(share) ? low : high) = (low + high) / 2;
            EXPECT_EQ(area.bright(direction, share, n * (low + 0.12)), true) << direction << " " << share;
            EXPECT_EQ(area.bright(direction, share, n * (low - 0.12)), false) << direction << " " << share;
            EXPECT_EQ(area.bright(direction, share, n * low), std::nullopt) << direction << " " << share;
        }
}

TEST(EdgeVotes, AnEdgeSeenFromItsOtherSideIsTheSameEdge) {
    EdgeVotes votes;
    votes.add({0.6, 0.8}, 0.3, true);
    votes.add({-0.6, -0.8}, 0.7, false);
    size_t together = 0;
    for (size_t d = 0; d < EdgeVotes::kDirections; d++)
        for (size_t s = 0; s < EdgeVotes::kShares; s++) together = std::max(together, votes.count(d, s, true));
    EXPECT_EQ(together, 2u);
}
}  // namespace
}  // namespace aa
