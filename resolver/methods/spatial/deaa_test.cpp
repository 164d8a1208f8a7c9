#include "methods/spatial/deaa.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "image/error.h"
#include "methods/method.h"
#include "methods/spec.h"

namespace aa {
namespace {
const std::vector<glm::dvec2> k4x = {
    {-2 / 16., -6 / 16.}, {6 / 16., -2 / 16.}, {-6 / 16., 2 / 16.}, {2 / 16., 6 / 16.}};
constexpr int kW = 64, kH = 24;

template <class Inside>
Frame sampled(const Inside& inside, const std::vector<glm::dvec2>& positionsPx) {
    Frame f;
    f.width = kW, f.height = kH;
    f.subSamplePositionsPx = positionsPx;
    for (const auto& p : positionsPx) {
        f.subSamples.emplace_back();
        Rgb& image = f.subSamples.back().colorLinear = Rgb(kW, kH);
        for (auto& plane : image.c)
            for (int y = 0; y < kH; y++)
                for (int x = 0; x < kW; x++) plane.at(x, y) = inside(x + 0.5 + p.x, y + 0.5 + p.y) ? 1.0f : 0.25f;
        image.fillBorder();
    }
    return f;
}
Rgb resolved(const std::string& spec, const Frame& f) {
    Rgb out(kW, kH);
    parseMethod(spec)
        .create({.width = kW, .height = kH, .subSamplePositionsPx = f.subSamplePositionsPx})
        ->resolve(f, {}, out);
    return out;
}
struct Quality {
    double squaredError;
    size_t levels;
};
template <class Inside>
Quality quality(const Rgb& out, const Inside& inside) {
    Quality q{0, 0};
    std::set<int> levels;
    for (int y = 3; y < kH - 3; y++)
        for (int x = 3; x < kW - 3; x++) {
            double truth = 0;
            for (int j = 0; j < 16; j++)
                for (int i = 0; i < 16; i++) truth += (inside(x + (i + .5) / 16, y + (j + .5) / 16) ? 1 : 0.25) / 256;
            const double v = out.c[0].at(x, y);
            q.squaredError += (v - truth) * (v - truth);
            levels.insert(int(std::lround(v * 1000)));
        }
    q.levels = levels.size();
    return q;
}

TEST(Deaa, GivesShallowEdgesMoreLevelsThanSamples) {
    double box = 0, adaptive = 0;
    for (int k = 0; k < 8; k++) {
        auto inside = [&](double x, double y) { return y > 9.1 + 0.13 * k + (0.03 + 0.05 * k) * x; };
        const Frame f = sampled(inside, k4x);
        const Quality a = quality(resolved("ssaa", f), inside), b = quality(resolved("deaa", f), inside);
        EXPECT_LE(a.levels, 5u);
        if (k < 4) {  // steeper edges repeat after few columns
            EXPECT_GE(b.levels, 8u) << k;
        }
        box += a.squaredError;
        adaptive += b.squaredError;
    }
    EXPECT_LT(adaptive, 0.7 * box);
}
TEST(Deaa, KeepsTheBoxWhereNoPlaneFits) {
    auto thin = [](double, double y) { return std::abs(y - 12.2) < 0.35; };  // a line, not an edge
    const Frame f = sampled(thin, k4x);
    EXPECT_TRUE(resolved("deaa", f).samePixels(resolved("ssaa", f)));
    auto edge = [](double x, double y) { return y > 9.1 + 0.1 * x; };
    const Frame g = sampled(edge, k4x);
    EXPECT_TRUE(resolved("deaa:fitTolerance=0.01", g).samePixels(resolved("ssaa", g)));
    EXPECT_FALSE(resolved("deaa", g).samePixels(resolved("ssaa", g)));
    const Frame flat = sampled([](double, double) { return true; }, k4x);
    EXPECT_TRUE(resolved("deaa", flat).samePixels(resolved("ssaa", flat)));
}
TEST(Deaa, NeedsSubSamples) { EXPECT_THROW(parseMethod("deaa").create({.width = 8, .height = 8}), InputError); }
// Isolated and complex pixels, and the degenerate cases: the box stays.
TEST(Deaa, KeepsTheBoxOfIsolatedAndComplexPixels) {
    const auto keepsBox = [](const Frame& f) {
        return resolved("deaa:fitTolerance=1", f).samePixels(resolved("ssaa", f));
    };
    // One cut pixel alone; two beside each other are an edge.
    const auto dot = [](double right) {
        return [right](double x, double y) { return !(x > 20 && x < right && y > 10 && y < 10.4); };
    };
    EXPECT_TRUE(keepsBox(sampled(dot(20.6), k4x)));
    EXPECT_FALSE(keepsBox(sampled(dot(21.6), k4x)));
    // Every pixel of the neighbourhood is cut: a grid of bars of half a pixel's pitch around it.
    const Frame bars = sampled([](double x, double y) { return std::fmod(x + 0.13 * y, 0.7) < 0.4; }, k4x);
    const Rgb box = resolved("ssaa", bars), out = resolved("deaa:fitTolerance=1", bars);
    int complex = 0, changed = 0;
    for (int y = 1; y < kH - 1; y++)
        for (int x = 1; x < kW - 1; x++) {
            int cut = 0;
            for (int j = -1; j <= 1; j++)
                for (int i = -1; i <= 1; i++) {
                    float least = 2, most = 0;
                    for (const auto& s : bars.subSamples) {
                        const float v = s.colorLinear.c[0].at(x + i, y + j);
                        least = std::min(least, v), most = std::max(most, v);
                    }
                    cut += most - least > 0.01f;
                }
            changed += out.c[0].at(x, y) != box.c[0].at(x, y);
            if (cut != 9) continue;
            complex++;
            ASSERT_EQ(out.c[0].at(x, y), box.c[0].at(x, y)) << x << "," << y;
        }
    EXPECT_GT(complex, 50);
    EXPECT_GT(changed, 50);
}

}  // namespace
}  // namespace aa
