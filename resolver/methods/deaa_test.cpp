#include "methods/deaa.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "image/error.h"

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

}  // namespace
}  // namespace aa
