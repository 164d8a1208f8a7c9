#include "methods/spatial/cmaa2.h"

#include <gtest/gtest.h>

#include <cmath>

#include "image/error.h"
#include "methods/method.h"
#include "methods/spatial/spatial_testing.h"
#include "methods/spec.h"

namespace aa {
namespace {
using namespace aa::testing;

// STEP: one Z of arms 32 and 32 px at (31, 4), so ramps of (i + 15.5) / 32; the two pixels at the step are also blurred
// by 0.1 * 0.75 * (1 + 1.9) = 0.2175 and mean (0.8 blur + 1.8 line) / 2.6.
TEST(Cmaa2, StepByHand) {
    for (const char* space : {"encoded", "linear"}) {
        const Rgb out = resolveOnce(std::string("cmaa2:blendSpace=") + space, stepImage());
        const std::pair<int, double> row4[] = {
            {15, 0},       {16, .015625},        {20, .140625},        {24, .265625}, {28, .390625},
            {30, .453125}, {31, 1.045875 / 2.6}, {32, 1.554125 / 2.6}, {33, .546875}, {47, .984375},
            {48, 1}};
        for (const auto& [x, v] : row4) EXPECT_NEAR(out.c[0].at(x, 4), v, 1e-6) << x;
        for (int x = 0; x < 64; x++) {
            EXPECT_EQ(out.c[1].at(x, 3), 1.0f) << x;
            EXPECT_EQ(out.c[1].at(x, 5), 0.0f) << x;
        }
    }
}
// The blur of the sharp mode: 0.07 * 0.75 * (1 + 1.9); no other difference on a long clean line.
TEST(Cmaa2, SharpModeByHand) {
    const Rgb out = resolveOnce("cmaa2:sharp=on", stepImage());
    EXPECT_NEAR(out.c[0].at(31, 4), (0.8 * 0.07 * 0.75 * 2.9 * (1.15 - 2.0 / 8) + 1.8 * .484375) / 2.6, 1e-6);
    EXPECT_NEAR(out.c[0].at(20, 4), .140625, 1e-6);
}

// CMAA2 [Strugar 2018] written a second time: per pixel and in double, clamped reads, results in lists.
struct Edges4 {
    double r = 0, g = 0, b = 0, a = 0;
};
class ReferenceCmaa2 {
  public:
    ReferenceCmaa2(const Frame& f, double threshold, bool sharp) : in_(f.colorLinear), sharp_(sharp) {
        w_ = f.width;
        h_ = f.height;
        const double lca = sharp ? .15 : .10;
        for (int y = 0; y < h_; y++)
            for (int x = 0; x < w_; x++) {
                const double r = rawRight(x, y), b = rawBottom(x, y);
                const double besideR =
                    std::max({rawBottom(x, y - 1), rawBottom(x, y), rawBottom(x + 1, y - 1), rawBottom(x + 1, y)});
                const double besideB =
                    std::max({rawRight(x - 1, y), rawRight(x, y), rawRight(x - 1, y + 1), rawRight(x, y + 1)});
                for (double d : {r - lca * besideR, b - lca * besideB}) nearTies += std::abs(d - threshold) < 1e-6;
                right_.push_back(r - lca * besideR > threshold);
                bottom_.push_back(b - lca * besideB > threshold);
            }
        results_.resize(size_t(w_) * size_t(h_));
        for (int y = 0; y < h_; y++)
            for (int x = 0; x < w_; x++) {
                const Edges4 e = edges(x, y);
                if (e.r * e.g + e.g * e.b + e.b * e.a + e.a * e.r == 0) continue;
                simple(x, y);
                lines += complex(x, y);
            }
    }
    int nearTies = 0, lines = 0;
    std::array<double, 3> pixel(int x, int y) const {
        const auto& list = results_[size_t(y) * size_t(w_) + size_t(x)];
        std::array<double, 3> out{};
        double weight = 0;
        for (const auto& [w, c] : list) {
            weight += w;
            for (size_t k = 0; k < 3; k++) out[k] += w * c[k];
        }
        for (size_t k = 0; k < 3; k++) out[k] = list.empty() ? value(k, x, y) : out[k] / weight;
        return out;
    }

  private:
    double value(size_t c, int x, int y) const { return in_.c[c].clamped(x, y); }
    double luma(int x, int y) const {
        const double weights[] = {.299, .587, .114};
        double sum = 0;
        for (size_t c = 0; c < 3; c++) sum += weights[c] * std::sqrt(std::clamp(value(c, x, y), 0.0, 1.0));
        return sum;
    }
    double rawRight(int x, int y) const { return std::abs(luma(x, y) - luma(x + 1, y)); }
    double rawBottom(int x, int y) const { return std::abs(luma(x, y) - luma(x, y + 1)); }
    double at(const std::vector<char>& plane, int x, int y) const {
        return x >= 0 && y >= 0 && x < w_ && y < h_ ? double(plane[size_t(y) * size_t(w_) + size_t(x)]) : 0.0;
    }
    Edges4 edges(int x, int y) const {
        if (x < 0 || y < 0 || x >= w_ || y >= h_) return {};
        return {at(right_, x, y), at(bottom_, x, y), at(right_, x - 1, y), at(bottom_, x, y - 1)};
    }
    void put(int x, int y, double weight, std::array<double, 3> c) {
        results_[size_t(y) * size_t(w_) + size_t(x)].push_back({weight, c});
    }
    void simple(int x, int y) {
        const Edges4 e = edges(x, y), l = edges(x - 1, y), r = edges(x + 1, y), t = edges(x, y - 1),
                     b = edges(x, y + 1);
        double coeff = sharp_ ? .07 : .10, wr = e.r, wb = e.g, wl = e.b, wt = e.a;
        if (e.r + e.g + e.b + e.a == 2) {
            coeff *= .75;
            wr += .9 * (e.g * t.r * (1 - l.g) + e.a * b.r * (1 - l.a));
            wb += .9 * (e.b * r.g * (1 - t.b) + e.r * l.g * (1 - t.r));
            wl += .9 * (e.a * b.b * (1 - r.a) + e.g * t.b * (1 - r.g));
            wt += .9 * (e.r * l.a * (1 - b.r) + e.b * r.a * (1 - b.b));
        }
        const double n = l.g + l.b + l.a + r.r + r.g + r.a + t.a + t.r + t.b + b.r + b.g + b.b;
        coeff *= std::clamp(sharp_ ? 1.15 - n / 8 : 1.30 - n / 10, 0.0, 1.0);
        std::array<double, 3> c;
        for (size_t k = 0; k < 3; k++)
            c[k] = value(k, x, y) * (1 - coeff * (wr + wb + wl + wt)) +
                   coeff * (wr * value(k, x + 1, y) + wb * value(k, x, y + 1) + wl * value(k, x - 1, y) +
                            wt * value(k, x, y - 1));
        put(x, y, .8, c);
    }
    static Edges4 argb(Edges4 e) { return {e.a, e.r, e.g, e.b}; }
    bool complex(int x, int y) {
        auto scores = [](Edges4 e, Edges4 m1, Edges4 p1, Edges4 p2) {
            return std::pair{e.r * e.g * p1.a * (2 + m1.g + p2.a - (e.a + p1.g) - .7 * (p2.g + m1.a + e.b + p1.r)),
                             e.r * e.a * p1.g * (2 + m1.a + p2.g - (e.g + p1.a) - .7 * (p2.a + m1.g + e.b + p1.r))};
        };
        const auto [hi, hn] = scores(edges(x, y), edges(x - 1, y), edges(x + 1, y), edges(x + 2, y));
        const auto [vi, vn] =
            scores(argb(edges(x, y)), argb(edges(x, y + 1)), argb(edges(x, y - 1)), argb(edges(x, y - 2)));
        const bool vertical = std::max(vi, vn) > std::max(hi, hn);
        const double score = vertical ? std::max(vi, vn) : std::max(hi, hn);
        if (score <= 0) return false;
        const bool inverted = vertical ? vi > vn : hi > hn;
        const double q = std::floor(std::clamp(4 - score, 0.0, 3.0));
        const int sx = vertical ? 0 : 1, sy = vertical ? -1 : 0;  // "right"
        auto traced = [&](int i, bool leftArm) {  // is the line still there, i px from the step's pixel?
            Edges4 e = edges(x + sx * i, y + sy * i);
            if (vertical) e = argb(e);
            return (leftArm != inverted ? e.a : e.g) != 0;
        };
        double l = 1, r = 1;
        for (bool left = true, right = true;;) {
            left = left && traced(-int(l), true);
            right = right && traced(int(r) + 1, false);
            l += left;
            r += right;
            if ((!left && !right) || std::max(l, r) >= std::min(86.0, 1.25 * std::min(l, r) - .25)) break;
        }
        l -= q;
        r -= q;
        if (l + r < 5) return false;
        const double lOdd = .22 * std::fmod(l, 2), rOdd = .22 * std::fmod(r, 2);
        const double from = 1 - std::floor((l + 1) / 2), to = std::floor((r + 1) / 2);
        const double total = to - from + 1 - lOdd - rOdd, damping = std::min(1.0, (l + r - q) * (sharp_ ? .11 : .15));
        for (int i = int(from); i <= int(to); i++) {
            const double k = (i + .5 - lOdd - from) / total, w = (i <= 0 ? k : 1 - k) * damping;
            // Horizontal: toward the row above on the left arm; vertical: toward the column on the left.
            const int sign = (i <= 0) == !inverted ? -1 : 1;
            const int px = x + sx * i, py = y + sy * i, qx = px + (vertical ? sign : 0),
                      qy = py + (vertical ? 0 : sign);
            std::array<double, 3> c;
            for (size_t m = 0; m < 3; m++) c[m] = value(m, px, py) * (1 - w) + value(m, qx, qy) * w;
            put(px, py, 1.8, c);
        }
        return true;
    }
    const Rgb& in_;
    bool sharp_;
    int w_ = 0, h_ = 0;
    std::vector<char> right_, bottom_;
    std::vector<std::vector<std::pair<double, std::array<double, 3>>>> results_;
};

TEST(Cmaa2, ConformsToASecondForm) {
    struct Case {
        std::string spec;
        double threshold;
        bool sharp;
    };
    int lines = 0, compared = 0;
    for (const Case& test : {Case{"cmaa2", .07, false},
                             {"cmaa2:preset=LOW", .15, false},
                             {"cmaa2:preset=ULTRA,sharp=on", .05, true},
                             {"cmaa2:preset=custom,threshold=0.2", .2, false}})
        for (const Rgb& image :
             {randomShapes(97, 61, 7), randomCodes(40, 33, 11), randomShapes(61, 97, 21), stepImage()}) {
            const Frame f = frameOf(image);
            const ReferenceCmaa2 reference(f, test.threshold, test.sharp);
            if (reference.nearTies > 0) continue;
            compared++;
            lines += reference.lines;
            for (const auto precision : {Precision::fast, Precision::scalar, Precision::oracle}) {
                const Rgb out = resolveOnce(test.spec, f, execOf(precision));
                double worst = 0;
                for (int y = 0; y < f.height; y++)
                    for (int x = 0; x < f.width; x++) {
                        const auto expected = reference.pixel(x, y);
                        for (size_t c = 0; c < 3; c++)
                            worst = std::max(worst, std::abs(out.c[c].at(x, y) - expected[c]));
                    }
                EXPECT_LT(worst, 3e-6) << test.spec << " " << f.width;
            }
        }
    EXPECT_GT(compared, 10);
    EXPECT_GT(lines, 500);
}
TEST(Cmaa2, TurnsWithTheImage) {
    const Rgb image = randomShapes(60, 60, 5);
    Rgb turned(60, 60);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < 60; y++)
            for (int x = 0; x < 60; x++) turned.c[c].at(y, 59 - x) = image.c[c].at(x, y);  // counter-clockwise
    const Rgb a = resolveOnce("cmaa2", image), b = resolveOnce("cmaa2", turned);
    size_t far = 0;
    for (int y = 0; y < 60; y++)
        for (int x = 0; x < 60; x++) far += std::abs(a.c[0].at(x, y) - b.c[0].at(y, 59 - x)) > 1e-5f;
    EXPECT_EQ(far, 0u);
}
TEST(Cmaa2, DebugLayersShowEdgesBlursAndLines) {
    const auto method = parseMethod("cmaa2").create({.width = 64, .height = 9});
    Rgb out(64, 9);
    method->keepDebugLayers = true;
    method->resolve(frameOf(stepImage()), {}, out);
    const auto layers = method->debugLayers();
    ASSERT_EQ(layers.size(), 3u);
    EXPECT_EQ(layers[0].planes[0].at(31, 4), 1.0f);
    EXPECT_EQ(layers[0].planes[1].at(20, 3), 1.0f);
    EXPECT_EQ(layers[0].planes[2].at(32, 4), 1.0f);
    EXPECT_EQ(layers[0].planes[2].at(20, 4), 0.0f);
    EXPECT_FLOAT_EQ(layers[1].planes[0].at(31, 4), 0.2175f);
    EXPECT_EQ(layers[2].planes[0].at(31, 4), 1.0f);
    EXPECT_EQ(layers[2].planes[1].at(31, 4), 32.0f);
    EXPECT_EQ(layers[2].planes[2].at(31, 4), 32.0f);
}
TEST(Cmaa2, RejectsParametersThatCannotAct) {
    EXPECT_THROW(parseMethod("cmaa2:threshold=0.2"), UsageError);  // belongs to preset=custom
    EXPECT_THROW(parseMethod("cmaa2:preset=custom,threshold=0"), UsageError);
    EXPECT_THROW(parseMethod("cmaa2:maxLine=2"), UsageError);
    EXPECT_NO_THROW(parseMethod("cmaa2:preset=custom,threshold=0.2,maxLine=40,symmetryCorrection=0.1"));
}

}  // namespace
}  // namespace aa
