#include "methods/spatial/mlaa.h"

#include <gtest/gtest.h>

#include <cmath>

#include "methods/method.h"
#include "methods/spatial/spatial_testing.h"

namespace aa {
namespace {
using namespace aa::testing;

TEST(Mlaa, StepVector) {
    const Rgb out = resolveOnce("mlaa", stepImage());
    const std::pair<int, double> row[] = {{12, 0},       {20, .140625}, {24, .265625}, {31, .488281},
                                          {32, .511719}, {39, .734375}, {44, .890625}};
    for (const auto& [x, v] : row) EXPECT_NEAR(out.c[0].at(x, 4), v, 1e-6) << x;
    for (int x = 0; x < 64; x++) {
        EXPECT_EQ(out.c[0].at(x, 3), 1.0f) << x;
        EXPECT_EQ(out.c[0].at(x, 5), 0.0f) << x;
    }
}

// MLAA written a second time: silhouettes integrated by many samples, run by run, without edge planes or weights.
class ReferenceMlaa {
  public:
    explicit ReferenceMlaa(const Rgb& image)
        : original_(image), current_(image), w_(image.width()), h_(image.height()) {
        pass(false);
        pass(true);
    }
    const Rgb& result() const { return current_; }

  private:
    bool differs(int x, int y, int u, int v) const {
        if (std::min({x, y, u, v}) < 0 || std::max(x, u) >= w_ || std::max(y, v) >= h_) return false;
        float d = 0;
        for (const auto& p : original_.c) d = std::max(d, std::abs(p.at(x, y) - p.at(u, v)));
        return d >= 1.0f / 16;
    }
    // In a frame that may be transposed: is there an edge between (x, y - 1) and (x, y), or (x - 1, y) and (x, y)?
    bool lies(bool t, int x, int y) const { return t ? differs(y, x, y - 1, x) : differs(x, y, x, y - 1); }
    bool crosses(bool t, int x, int y) const { return t ? differs(y, x, y, x - 1) : differs(x, y, x - 1, y); }
    void pass(bool t) {
        const Rgb source = current_;
        const int width = t ? h_ : w_, rows = t ? w_ : h_;
        for (int y = 1; y < rows; y++)
            for (int a = 0; a < width; a++) {
                if (!lies(t, a, y) || (a > 0 && lies(t, a - 1, y))) continue;
                int b = a;
                while (b + 1 < width && lies(t, b + 1, y)) b++;
                auto ends = [&](int x) { return (crosses(t, x, y - 1) ? 1 : 0) + (crosses(t, x, y) ? 2 : 0); };
                const int left = ends(a), right = ends(b + 1);
                auto side = [](int own, int other) {
                    if (own == 1) return 0.5;
                    if (own == 2) return -0.5;
                    if (own == 0) return 0.0;
                    return other == 1 ? -0.5 : other == 2 ? 0.5 : 0.0;
                };
                const double hl = side(left, right), hr = side(right, left), d = b - a + 1;
                for (int x = a; x <= b; x++) {
                    double above = 0, below = 0;
                    for (int i = 0; i < 2000; i++) {
                        const double s = x - a + (i + 0.5) / 2000;
                        const double h = hl * hr < 0 ? hl + (hr - hl) * s / d
                                         : s < d / 2 ? hl * (1 - 2 * s / d)
                                                     : hr * (2 * s / d - 1);
                        (h > 0 ? above : below) += std::abs(h) / 2000;
                    }
                    mixInto(source, t, x, y, x, y - 1, below);
                    mixInto(source, t, x, y - 1, x, y, above);
                }
            }
    }
    void mixInto(const Rgb& source, bool t, int x, int y, int u, int v, double amount) {
        for (size_t c = 0; c < 3; c++) {
            const auto& p = source.c[c];
            const double own = t ? p.at(y, x) : p.at(x, y), other = t ? p.at(v, u) : p.at(u, v);
            float& target = t ? current_.c[c].at(y, x) : current_.c[c].at(x, y);
            target = float(target + amount * (other - own));
        }
    }
    Rgb original_, current_;
    int w_, h_;
};
TEST(Mlaa, ConformsToTheDefinition) {
    for (const Rgb& image : {randomShapes(97, 61, 7), randomShapes(40, 90, 2), randomShapes(23, 17, 3)}) {
        const Rgb reference = ReferenceMlaa(image).result();
        EXPECT_GT(largestDifference(reference, image), 0.1);
        for (const auto precision : {Precision::fast, Precision::oracle})
            EXPECT_LT(largestDifference(resolveOnce("mlaa", image, execOf(precision)), reference), 2e-4);
    }
}

// Two steps whose colours differ a little on either side: (1 - h) 1 + h 0 = h 0.015 + (1 - h) 0.955 at h = 0.75.
TEST(Mlaa, HeightsByColourMakeBothSidesMeet) {
    Rgb image(64, 8);
    for (auto& p : image.c)
        for (int y = 0; y < 8; y++)
            for (int x = 0; x < 64; x++) p.at(x, y) = x < 32 ? (y < 3 ? 0.955f : 0.015f) : (y < 4 ? 1.0f : 0.0f);
    const Rgb out = resolveOnce("mlaa:heights=colour", image), half = resolveOnce("mlaa", image);
    EXPECT_NEAR(out.c[0].at(34, 3), 1 - 0.75 * 13.5 / 16, 1e-6);
    EXPECT_NEAR(out.c[0].at(29, 3), 0.015 + 0.25 * 13.5 / 16 * 0.94, 1e-6);
    EXPECT_NEAR(half.c[0].at(34, 3), 1 - 0.5 * 13.5 / 16, 1e-6);
    // Of two colours any height serves, and the middle is taken: the area table and the formula are one.
    const Rgb step = resolveOnce("mlaa:heights=colour", stepImage()), table = resolveOnce("mlaa", stepImage());
    for (int y = 0; y < step.height(); y++)
        for (int x = 0; x < step.width(); x++) EXPECT_NEAR(step.c[0].at(x, y), table.c[0].at(x, y), 1e-6);
}
// A row of two pixels between two lines: together they may not take more than all of a pixel.
TEST(Mlaa, HeightsByColourStayWithinTheirInput) {
    Rgb image(64, 9);
    for (auto& p : image.c)
        for (int y = 0; y < 9; y++)
            for (int x = 0; x < 64; x++) {
                const int middle = x < 31 ? 100 : x < 33 ? 250 : 150;
                p.at(x, y) = float(y < 4 ? 100 : y > 4 ? 150 : middle) / 255;
            }
    for (const char* text : {"mlaa:heights=colour", "mlaa:heights=colour,simultaneous=on"}) {
        const Rgb out = resolveOnce(text, image);
        for (int y = 0; y < 9; y++)
            for (int x = 0; x < 64; x++) {
                EXPECT_GE(out.c[0].at(x, y), 100 / 255.0f - 1e-6f) << text << ' ' << x << ' ' << y;
                EXPECT_LE(out.c[0].at(x, y), 250 / 255.0f + 1e-6f) << text << ' ' << x << ' ' << y;
            }
    }
}
TEST(Mlaa, SimultaneousAveragesTheTwoMoves) {
    const Rgb out = resolveOnce("mlaa:simultaneous=on", stepImage()), ordered = resolveOnce("mlaa", stepImage());
    const double move = (0.5 * 15.5 / 16 + 0.125) / 2;  // of the horizontal L and of the vertical Z of length 1
    EXPECT_NEAR(out.c[0].at(31, 4), move, 1e-6);
    EXPECT_NEAR(out.c[0].at(32, 4), 1 - move, 1e-6);
    for (int x = 0; x < 64; x++)
        if (x != 31 && x != 32) {
            EXPECT_EQ(out.c[0].at(x, 4), ordered.c[0].at(x, 4)) << x;
        }
}
TEST(Mlaa, DifferenceRules) {
    // Codes 15 and 16 differ in their four highest bits although they are 1/255 apart; 16 and 31 do not.
    auto stair = [](int low, int high) {
        Rgb image(40, 6, float(low) / 255);
        for (auto& p : image.c)
            for (int y = 0; y < 6; y++)
                for (int x = 0; x < 40; x++)
                    if (y < (x < 20 ? 3 : 2)) p.at(x, y) = float(high) / 255;
        return image;
    };
    auto changed = [](const char* spec, const Rgb& image) { return !resolveOnce(spec, image).samePixels(image); };
    EXPECT_TRUE(changed("mlaa:edges=msb4", stair(15, 16)));
    EXPECT_FALSE(changed("mlaa:edges=maxdiff", stair(15, 16)));
    EXPECT_FALSE(changed("mlaa:edges=msb4", stair(16, 31)));
    EXPECT_FALSE(changed("mlaa:edges=maxdiff", stair(16, 31)));
    EXPECT_TRUE(changed("mlaa:edges=maxdiff", stair(16, 32)));
    EXPECT_FALSE(changed("mlaa:edges=luma", stair(16, 32)));
    EXPECT_TRUE(changed("mlaa:edges=luma", stair(16, 48)));
}

TEST(Mlaa, IsSymmetricUnderMirroring) {
    const Rgb image = randomShapes(51, 37, 13);
    Rgb mirrored(51, 37);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < 37; y++)
            for (int x = 0; x < 51; x++) mirrored.c[c].at(x, y) = image.c[c].at(50 - x, 36 - y);
    const Rgb a = resolveOnce("mlaa", image), b = resolveOnce("mlaa", mirrored);
    for (int y = 0; y < 37; y++)
        for (int x = 0; x < 51; x++) EXPECT_NEAR(a.c[0].at(x, y), b.c[0].at(50 - x, 36 - y), 1e-6);
}

}  // namespace
}  // namespace aa
