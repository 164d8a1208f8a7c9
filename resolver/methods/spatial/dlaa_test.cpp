#include "methods/spatial/dlaa.h"

#include <gtest/gtest.h>

#include <cmath>

#include "methods/method.h"
#include "methods/spatial/spatial_testing.h"

namespace aa {
namespace {
using namespace aa::testing;

// [Andreev 2011] written a second time with a general bilinear fetch, per pixel and in double. `literal`: with the
// jumps of the publication where ours fade (dlaa_kernels.h).
class ReferenceDlaa {
  public:
    explicit ReferenceDlaa(const Rgb& image, bool literal = false) : image_(image), literal_(literal) {}
    using C = std::array<double, 3>;
    C pixel(int x, int y) const {
        const C c = tap(x, y);
        auto plus = [](C a, C b) { return C{a[0] + b[0], a[1] + b[1], a[2] + b[2]}; };
        auto times = [](C a, double s) { return C{a[0] * s, a[1] * s, a[2] * s}; };
        auto mix = [&](C a, C b, double t) { return plus(times(a, 1 - t), times(b, t)); };
        const C wh = times(plus(tap(x - 1.5, y), tap(x + 1.5, y)), 2),
                wv = times(plus(tap(x, y - 1.5), tap(x, y + 1.5)), 2);
        auto edge = [&](C w) {
            C e;
            for (size_t k = 0; k < 3; k++) e[k] = std::abs(w[k] - 4 * c[k]) / 4;
            return luma(e);
        };
        const C blurH = times(plus(wh, times(c, 2)), 1.0 / 6), blurV = times(plus(wv, times(c, 2)), 1.0 / 6);
        auto mask = [](double e, double level) {
            const double n = 3 * e - 0.1;
            return level > 0 ? std::clamp(n / level, 0.0, 1.0) : n > 0 ? 1.0 : 0.0;
        };
        C out = mix(c, blurH, mask(edge(wv), luma(blurH)));
        out = mix(out, blurV, 0.5 * mask(edge(wh), luma(blurV)));
        double eh = 0, ev = 0;
        C bh{}, bv{};
        for (const double d : {-7.5, -5.5, -3.5, -1.5, 1.5, 3.5, 5.5, 7.5}) {
            eh += strength(x + d, y) / 8;
            ev += strength(x, y + d) / 8;
            bh = plus(bh, times(tap(x + d, y), 0.125));
            bv = plus(bv, times(tap(x, y + d), 0.125));
        }
        const double mh = std::clamp(2 * eh - 1, 0.0, 1.0), mv = std::clamp(2 * ev - 1, 0.0, 1.0);
        const double over = std::abs(mh - mv) - 0.2;
        if (over <= 0) return out;
        const C l = tap(x - 1, y), r = tap(x + 1, y), t = tap(x, y - 1), b = tap(x, y + 1);
        auto weighed = [&](double ratio, double difference) {
            return literal_ ? ratio : 1 + (ratio - 1) * std::min(1.0, std::pow(difference * 510, 2));
        };
        auto first = [&](double target, const C& n) {
            const double d = luma(c) - luma(n);
            return d == 0 ? 1.0 : std::clamp(weighed((target - luma(n)) / d, d), 0.0, 1.0);
        };
        auto second = [&](double target, const C& n) {
            const double d = luma(c) - luma(n);
            return d == 0 ? 1.0 : std::clamp(weighed(1 + (target - luma(c)) / d, d), 0.0, 1.0);
        };
        double hx = first(luma(bh), t), hy = second(luma(bh), b), vx = first(luma(bv), l), vy = second(luma(bv), r);
        const double sum = hx + hy + vx + vy;
        if (sum == 0) hx = hy = vx = vy = 1;
        const double shift = literal_ ? 1 : std::min(1.0, sum * 255), fade = literal_ ? 1 : std::min(1.0, over * 255);
        out = mix(out, mix(c, mix(r, mix(l, c, vx), vy), shift), mv * fade);
        return mix(out, mix(c, mix(b, mix(t, c, hx), hy), shift), mh * fade);
    }
    // Step 5: how far the pixel is kept. The four taps of the cross, like the others, lie at 1.5 px.
    double highlight(int x, int y) const {
        double diagonals = 0, cross = 0;
        for (const double d : {-1.5, 1.5}) {
            diagonals += strength(x + d, y + 1.5) + strength(x + d, y - 1.5);
            cross += strength(x + d, y) + strength(x, y + d);
        }
        return std::clamp(3 * (4 * diagonals + strength(x, y) + 2 * cross) / 25 - 1.5, 0.0, 1.0);
    }

  private:
    static double luma(const C& c) { return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; }
    template <class F>
    static auto bilinear(double px, double py, const F& at) {
        const double ax = std::floor(px), ay = std::floor(py), fx = px - ax, fy = py - ay;
        return at(int(ax), int(ay), (1 - fx) * (1 - fy)) + at(int(ax) + 1, int(ay), fx * (1 - fy)) +
               at(int(ax), int(ay) + 1, (1 - fx) * fy) + at(int(ax) + 1, int(ay) + 1, fx * fy);
    }
    C tap(double px, double py) const {
        C c;
        for (size_t k = 0; k < 3; k++)
            c[k] = bilinear(px, py, [&](int x, int y, double w) { return w * image_.c[k].clamped(x, y); });
        return c;
    }
    double strengthAt(int x, int y) const {
        x = std::clamp(x, 0, image_.width() - 1);
        y = std::clamp(y, 0, image_.height() - 1);
        C e;
        for (size_t k = 0; k < 3; k++) {
            const auto& p = image_.c[k];
            e[k] = 4 * std::abs(double(p.clamped(x - 1, y)) + p.clamped(x + 1, y) + p.clamped(x, y - 1) +
                                p.clamped(x, y + 1) - 4 * double(p.clamped(x, y)));
        }
        return std::min(1.0, luma(e));
    }
    double strength(double px, double py) const {
        return bilinear(px, py, [&](int x, int y, double w) { return w * strengthAt(x, y); });
    }
    const Rgb& image_;
    bool literal_;
};

TEST(Dlaa, ConformsToTheDefinition) {
    for (const Rgb& image : {randomShapes(97, 61, 7), stepImage(), randomCodes(30, 20, 5)}) {
        const Rgb out = resolveOnce("dlaa", image, execOf(Precision::oracle));
        const Rgb fast = resolveOnce("dlaa", image);
        const ReferenceDlaa reference(image), literal(image, true);
        double worst = 0, worstFast = 0;
        int changed = 0, published = 0;
        for (int y = 0; y < image.height(); y++)
            for (int x = 0; x < image.width(); x++) {
                const auto expected = reference.pixel(x, y), jumping = literal.pixel(x, y);
                bool same = true;
                for (size_t c = 0; c < 3; c++) {
                    worst = std::max(worst, std::abs(out.c[c].at(x, y) - expected[c]));
                    worstFast = std::max(worstFast, std::abs(fast.c[c].at(x, y) - expected[c]));
                    same = same && std::abs(out.c[c].at(x, y) - jumping[c]) < 1e-5;
                }
                changed += out.c[0].at(x, y) != image.c[0].at(x, y);
                published += same;
            }
        EXPECT_LT(worst, 1e-5);
        EXPECT_LT(worstFast, 3e-5);
        EXPECT_GT(changed, 10);
        EXPECT_GT(published, 0.985 * image.width() * image.height());  // the fades are narrow
    }
}
// Lines before a wall whose colours differ in the last bit only: their lumas are equal or not as the rounding goes, and
// where a ratio of such differences decided, single pixels jumped by 0.3.
TEST(Dlaa, RoundingDecidesNothing) {
    std::mt19937 random(3);
    Rgb image(180, 140);
    for (auto& p : image.c)
        for (int y = 0; y < 140; y++)
            for (int x = 0; x < 180; x++) p.at(x, y) = 0.9f + 6e-8f * float(random() % 4);
    for (int line = 0; line < 9; line++)
        for (int t = 0; t < 140; t++) {
            const int x = 10 + 18 * line + t * line / 60;
            for (auto& p : image.c)
                p.at(x, t) = p.at(std::min(t + 3, 179), 12 + 14 * line) = 0.2f + 0.05f * float(line);
        }
    const Rgb fast = resolveOnce("dlaa", image), exact = resolveOnce("dlaa", image, execOf(Precision::oracle));
    EXPECT_GT(largestDifference(fast, image), 0.05);
    EXPECT_LT(largestDifference(fast, exact), 1e-4);
}
TEST(Dlaa, PreservesHighlightsOnRequest) {
    const Rgb image = randomCodes(40, 30, 1);  // strong edges everywhere
    const Rgb plain = resolveOnce("dlaa", image), kept = resolveOnce("dlaa:preserveHighlights=on", image);
    EXPECT_GT(largestDifference(plain, image), 0.1);
    EXPECT_LT(largestDifference(kept, image), 0.5 * largestDifference(plain, image));
    const Rgb shapes = randomShapes(97, 61, 7);
    const Rgb out = resolveOnce("dlaa:preserveHighlights=on", shapes), open = resolveOnce("dlaa", shapes);
    const ReferenceDlaa reference(shapes);
    int partly = 0;
    for (int y = 0; y < 61; y++)
        for (int x = 0; x < 97; x++) {
            const double keep = reference.highlight(x, y), c = open.c[0].at(x, y);
            partly += keep > 0.01 && keep < 0.99;
            ASSERT_NEAR(out.c[0].at(x, y), c + (shapes.c[0].at(x, y) - c) * keep, 3e-6) << x << "," << y;
        }
    EXPECT_GT(partly, 50);
}

}  // namespace
}  // namespace aa
