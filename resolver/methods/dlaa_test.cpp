#include "methods/dlaa.h"

#include <gtest/gtest.h>

#include <cmath>

#include "methods/spatial_testing.h"

namespace aa {
namespace {
using namespace aa::testing;

// methods/04 s.4.1 written a second time with a general bilinear fetch, per pixel and in double.
class ReferenceDlaa {
  public:
    explicit ReferenceDlaa(const Rgb& image) : image_(image) {}
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
        if (std::abs(mh - mv) <= 0.2) return out;
        const C l = tap(x - 1, y), r = tap(x + 1, y), t = tap(x, y - 1), b = tap(x, y + 1);
        auto first = [&](double target, const C& n) {
            return luma(c) == luma(n) ? 1.0 : std::clamp((target - luma(n)) / (luma(c) - luma(n)), 0.0, 1.0);
        };
        auto second = [&](double target, const C& n) {
            return luma(c) == luma(n) ? 1.0 : std::clamp(1 + (target - luma(c)) / (luma(c) - luma(n)), 0.0, 1.0);
        };
        double hx = first(luma(bh), t), hy = second(luma(bh), b), vx = first(luma(bv), l), vy = second(luma(bv), r);
        if (hx + hy + vx + vy == 0) hx = hy = vx = vy = 1;
        out = mix(out, mix(r, mix(l, c, vx), vy), mv);
        return mix(out, mix(b, mix(t, c, hx), hy), mh);
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
};

TEST(Dlaa, ConformsToTheDefinition) {
    for (const Rgb& image : {randomShapes(97, 61, 7), stepImage(), randomCodes(30, 20, 5)}) {
        const Rgb out = resolveOnce("dlaa", image, execOf(Precision::oracle));
        const Rgb fast = resolveOnce("dlaa", image);
        const ReferenceDlaa reference(image);
        double worst = 0;
        int changed = 0, far = 0;
        for (int y = 0; y < image.height(); y++)
            for (int x = 0; x < image.width(); x++) {
                const auto expected = reference.pixel(x, y);
                for (size_t c = 0; c < 3; c++) {
                    worst = std::max(worst, std::abs(out.c[c].at(x, y) - expected[c]));
                    far += std::abs(fast.c[c].at(x, y) - expected[c]) > 3e-5;
                }
                changed += out.c[0].at(x, y) != image.c[0].at(x, y);
            }
        EXPECT_LT(worst, 1e-5);
        EXPECT_GT(changed, 10);
        EXPECT_LE(far, 3 * image.width() * image.height() / 500);  // ratios of equal lumas
    }
}
TEST(Dlaa, PreservesHighlightsOnRequest) {
    const Rgb image = randomCodes(40, 30, 1);  // strong edges everywhere
    const Rgb plain = resolveOnce("dlaa", image), kept = resolveOnce("dlaa:preserveHighlights=on", image);
    EXPECT_GT(largestDifference(plain, image), 0.1);
    EXPECT_LT(largestDifference(kept, image), 0.5 * largestDifference(plain, image));
}

}  // namespace
}  // namespace aa
