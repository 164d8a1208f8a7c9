#include "methods/fxaa.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "image/error.h"
#include "methods/spatial_testing.h"

namespace aa {
namespace {
using namespace aa::testing;

// FXAA 3.11 written a second time, in the reference's control flow and in double: continuous positions, a general
// bilinear fetch, both directions in one loop. `nearTie` counts pixels whose decision hangs on the last bits.
class Reference311 {
  public:
    Reference311(const Rgb& image, std::vector<double> stepsPx, double subpix, double thr, double thrMin)
        : image_(image), steps_(std::move(stepsPx)), subpix_(subpix), thr_(thr), thrMin_(thrMin) {}
    int nearTies = 0;

    std::array<double, 3> pixel(int x, int y) {
        tie_ = false;
        const auto result = filtered(x, y);
        nearTies += tie_;
        return result;
    }
    bool lastWasNearTie() const { return tie_; }

  private:
    double channel(size_t c, double px, double py) const {  // bilinear at a position, clamped taps
        const double qx = px - 0.5, qy = py - 0.5, ax = std::floor(qx), ay = std::floor(qy), fx = qx - ax, fy = qy - ay;
        double sum = 0;
        for (int j = 0; j < 2; j++)
            for (int i = 0; i < 2; i++)
                sum += (i ? fx : 1 - fx) * (j ? fy : 1 - fy) * image_.c[c].clamped(int(ax) + i, int(ay) + j);
        return sum;
    }
    double luma(double px, double py) const {
        return 0.299 * channel(0, px, py) + 0.587 * channel(1, px, py) + 0.114 * channel(2, px, py);
    }
    void close(double a, double b) { tie_ = tie_ || std::abs(a - b) < 1e-6; }
    void closeEnd(double e, double gradient) {  // exact ties have a rule, near ones do not
        if (std::abs(std::abs(e) - gradient) > 1e-9) close(std::abs(e), gradient);
    }
    std::array<double, 3> filtered(int ix, int iy) {
        const double x = ix + 0.5, y = iy + 0.5;
        auto at = [&](int i, int j) { return luma(x + i, y + j); };
        const double m = at(0, 0), n = at(0, -1), s = at(0, 1), w = at(-1, 0), e = at(1, 0);
        const double highest = std::max({m, n, s, w, e}), range = highest - std::min({m, n, s, w, e});
        auto colour = [&](double px, double py) {
            return std::array{channel(0, px, py), channel(1, px, py), channel(2, px, py)};
        };
        close(range, std::max(thrMin_, highest * thr_));
        if (range < std::max(thrMin_, highest * thr_)) return colour(x, y);
        const double nw = at(-1, -1), ne = at(1, -1), sw = at(-1, 1), se = at(1, 1);
        const double horz =
            std::abs(-2 * w + (nw + sw)) + 2 * std::abs(-2 * m + (n + s)) + std::abs(-2 * e + (ne + se));
        const double vert =
            std::abs(-2 * s + (sw + se)) + 2 * std::abs(-2 * m + (w + e)) + std::abs(-2 * n + (nw + ne));
        const bool horizontal = horz >= vert * (1 - 1e-6);
        if (std::abs(horz - vert) > 1e-9) close(horz, vert * (1 - 1e-6));
        const double average = ((n + s + w + e) * 2 + nw + ne + sw + se) / 12;
        const double c = std::min(1.0, std::abs(average - m) / range), smooth = (3 - 2 * c) * c * c;
        const double before = horizontal ? n : w, after = horizontal ? s : e;
        const double gradBefore = std::abs(before - m), gradAfter = std::abs(after - m);
        if (gradBefore != gradAfter) close(gradBefore, gradAfter);
        const bool pairBefore = gradBefore >= gradAfter;
        const double sign = pairBefore ? -1 : 1, gradient = std::max(gradBefore, gradAfter) / 4;
        const double mean = ((pairBefore ? before : after) + m) / 2;
        const double bx = x + (horizontal ? 0 : sign * 0.5), by = y + (horizontal ? sign * 0.5 : 0);
        double dn = 0, dp = 0, en = 0, ep = 0;
        bool doneN = false, doneP = false;
        for (size_t k = 0; k < steps_.size(); k++) {
            if (!doneN) dn += steps_[k];
            if (!doneP) dp += steps_[k];
            if (k + 1 == steps_.size() || (doneN && doneP)) continue;
            auto end = [&](double d) { return horizontal ? luma(bx + d, by) - mean : luma(bx, by + d) - mean; };
            if (!doneN) en = end(-dn), closeEnd(en, gradient), doneN = std::abs(en) >= gradient * (1 - 1e-6);
            if (!doneP) ep = end(dp), closeEnd(ep, gradient), doneP = std::abs(ep) >= gradient * (1 - 1e-6);
        }
        const bool nearN = dn < dp;
        const bool good = ((nearN ? en : ep) < 0) != (m - mean < 0);
        const double pixelOffset = good ? 0.5 - std::min(dn, dp) / (dn + dp) : 0;
        const double offset = std::max(pixelOffset, smooth * smooth * subpix_) * sign;
        return horizontal ? colour(x, y + offset) : colour(x + offset, y);
    }
    const Rgb& image_;
    std::vector<double> steps_;
    double subpix_, thr_, thrMin_;
    bool tie_ = false;
};
const std::vector<double> kSteps10 = {1.5, 3, 12}, kSteps12 = {1, 1.5, 2, 4, 12},
                          kSteps29 = {1, 1.5, 2, 2, 2, 2, 2, 2, 2, 2, 4, 8},
                          kSteps39 = {1, 1, 1, 1, 1, 1.5, 2, 2, 2, 2, 4, 8};

struct Conformance {
    std::string spec;
    std::vector<double> stepsPx;
    double subpix = 0.75, thr = 0.166, thrMin = 0.0833;
};

TEST(Fxaa311, StepVectorOfTheSpecification) {
    const Rgb p12 = resolveOnce("fxaa311:preset=12", stepImage()), p39 = resolveOnce("fxaa311:preset=39", stepImage());
    const int x12[] = {20, 24, 28, 30, 31, 32, 33, 35, 39, 44};
    const double row4[] = {.0504, .2069, .3200, .3913, .4535, .5465, .6087, .6800, .7931, .9496};
    const double row4at39[] = {.1795, .2571, .3689, .4298, .4636, .5364, .5702, .6311, .7429, .8205};
    for (size_t i = 0; i < 10; i++) {
        EXPECT_NEAR(p12.c[0].at(x12[i], 4), row4[i], 6e-5) << "x " << x12[i];
        EXPECT_NEAR(p39.c[1].at(x12[i], 4), row4at39[i], 6e-5) << "x " << x12[i];
    }
    EXPECT_NEAR(p12.c[2].at(24, 3), .9496, 6e-5);
    EXPECT_NEAR(p12.c[2].at(30, 3), .9496, 6e-5);
    EXPECT_NEAR(p12.c[2].at(31, 3), .9817, 6e-5);
}

TEST(Fxaa311, ConformsToTheReferenceControlFlow) {
    const Conformance cases[] = {
        {"fxaa311:preset=10", kSteps10},
        {"fxaa311:preset=12", kSteps12},
        {"fxaa311:preset=29,subpix=1,edgeThreshold=0.063,edgeThresholdMin=0.0312", kSteps29, 1, 0.063, 0.0312},
        {"fxaa311:preset=39,subpix=0", kSteps39, 0},
    };
    const Rgb images[] = {randomShapes(97, 61, 7), randomCodes(50, 40, 11), randomShapes(61, 97, 8)};
    for (const auto& test : cases)
        for (const Rgb& image : images)
            for (const auto precision : {Precision::fast, Precision::scalar, Precision::oracle}) {
                const Rgb out = resolveOnce(test.spec, image, execOf(precision));
                Reference311 reference(image, test.stepsPx, test.subpix, test.thr, test.thrMin);
                int edges = 0;
                double worst = 0;
                for (int y = 0; y < image.height(); y++)
                    for (int x = 0; x < image.width(); x++) {
                        const auto expected = reference.pixel(x, y);
                        edges += out.c[0].at(x, y) != image.c[0].at(x, y);
                        if (reference.lastWasNearTie()) continue;
                        for (size_t c = 0; c < 3; c++)
                            worst = std::max(worst, std::abs(out.c[c].at(x, y) - expected[c]));
                    }
                EXPECT_LT(worst, 3e-6) << test.spec;
                EXPECT_GT(edges, 100) << test.spec;
                EXPECT_LT(reference.nearTies, 0.02 * image.width() * image.height()) << test.spec;
            }
}

TEST(Fxaa311, PrecisionsAndInstructionSetsAgree) {
    const Frame frame = frameOf(randomShapes(133, 77, 3));
    const Rgb fast = resolveOnce("fxaa311:preset=39", frame);
    for (const Isa isa : {Isa::v2, Isa::v3, Isa::v4}) {
        if (!isaSupported(isa)) continue;
        EXPECT_TRUE(fast.samePixels(resolveOnce("fxaa311:preset=39", frame, execOf(Precision::fast, isa))));
        EXPECT_TRUE(fast.samePixels(resolveOnce("fxaa311:preset=39", frame, execOf(Precision::scalar, isa))));
    }
    EXPECT_LT(largestDifference(fast, resolveOnce("fxaa311:preset=39", frame, execOf(Precision::oracle))), 3e-5);
}

TEST(Fxaa311, LeavesFlatAndDistantPixelsAlone) {
    Rgb image(200, 5, 0.25f);
    for (auto& p : image.c)
        for (int y = 0; y < 5; y++)
            for (int x = 100; x < 200; x++) p.at(x, y) = 0.75f;
    const Rgb out = resolveOnce("fxaa311:preset=29", image);
    for (int y = 0; y < 5; y++)
        for (int x = 0; x < 200; x++)
            if (x < 98 || x > 101) {
                EXPECT_EQ(out.c[0].at(x, y), image.c[0].at(x, y));
            }
}

TEST(Fxaa311, BlendsInLinearLightOnRequest) {
    const Frame frame = frameOf(stepImage());
    EXPECT_EQ(parseMethod("fxaa311:blendSpace=linear").outputSpace(), Space::linear);
    EXPECT_EQ(parseMethod("fxaa311").outputSpace(), Space::encoded);
    // Black and white are the same numbers in both spaces, so are the shares.
    EXPECT_LT(largestDifference(resolveOnce("fxaa311", frame), resolveOnce("fxaa311:blendSpace=linear", frame)), 1e-6);
}

TEST(Fxaa311, RejectsParametersOutOfRange) {
    EXPECT_THROW(parseMethod("fxaa311:preset=16"), UsageError);
    EXPECT_THROW(parseMethod("fxaa311:subpix=1.5"), UsageError);
    EXPECT_THROW(parseMethod("fxaa311:edgeThreshold=-0.1"), UsageError);
}

}  // namespace
}  // namespace aa
