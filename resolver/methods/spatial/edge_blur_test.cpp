#include "methods/spatial/edge_blur.h"

#include <gtest/gtest.h>

#include <cmath>

#include "methods/method.h"
#include "methods/spatial/spatial_testing.h"

namespace aa {
namespace {
using namespace aa::testing;

double bilinear(const PlaneF& p, double x, double y) {
    const double ax = std::floor(x), ay = std::floor(y), fx = x - ax, fy = y - ay;
    const int i = int(ax), j = int(ay);
    return (1 - fy) * ((1 - fx) * p.clamped(i, j) + fx * p.clamped(i + 1, j)) +
           fy * ((1 - fx) * p.clamped(i, j + 1) + fx * p.clamped(i + 1, j + 1));
}
template <class Expected>
void expectConforms(const char* spec, const Rgb& image, const Expected& expected) {
    for (const auto precision : {Precision::fast, Precision::oracle}) {
        const Rgb out = resolveOnce(spec, image, execOf(precision));
        double worst = 0;
        for (int y = 0; y < image.height(); y++)
            for (int x = 0; x < image.width(); x++)
                for (size_t c = 0; c < 3; c++)
                    worst = std::max(worst, std::abs(out.c[c].at(x, y) - expected(x, y, image.c[c])));
        EXPECT_LT(worst, precision == Precision::fast ? 3e-5 : 3e-6) << spec;
    }
}

TEST(Nfaa, ConformsToTheDefinition) {
    const Rgb image = randomShapes(60, 44, 6);
    expectConforms("nfaa", image, [&](int x, int y, const PlaneF& p) {
        auto luma = [&](int i, int j) {
            return 0.212 * image.c[0].clamped(x + i, y + j) + 0.716 * image.c[1].clamped(x + i, y + j) +
                   0.072 * image.c[2].clamped(x + i, y + j);
        };
        double sums[4] = {};  // top, bottom, left, right
        for (int k = -1; k <= 1; k++)
            sums[0] += luma(k, -1), sums[1] += luma(k, 1), sums[2] += luma(-1, k), sums[3] += luma(1, k);
        double nx = sums[1] - sums[0], ny = sums[2] - sums[3];
        const double length = std::hypot(nx, ny);
        if (length > 3) nx *= 3 / length, ny *= 3 / length;
        return (p.at(x, y) + bilinear(p, x + nx, y + ny) + bilinear(p, x - nx, y - ny) +
                bilinear(p, x + nx / 2, y - ny / 2) + bilinear(p, x - nx / 2, y + ny / 2)) /
               5;
    });
}
TEST(Nfaa, KeepsStraightEdges) {
    Rgb image(20, 12, 0.2f);  // the blur runs along the edge: nothing to average but equals
    for (auto& p : image.c)
        for (int y = 0; y < 6; y++)
            for (int x = 0; x < 20; x++) p.at(x, y) = 0.9f;
    EXPECT_LT(largestDifference(resolveOnce("nfaa", image), image), 1e-6);
    EXPECT_LT(largestDifference(resolveOnce("ssssaa", image), image), 1e-6);
}

TEST(Ssssaa, ConformsToTheDefinition) {
    const Rgb image = randomShapes(60, 44, 9);
    expectConforms("ssssaa:threshold=0.0601", image, [&](int x, int y, const PlaneF& p) {
        auto luma = [&](double i, double j) {
            return 0.2126 * bilinear(image.c[0], x + i, y + j) + 0.7152 * bilinear(image.c[1], x + i, y + j) +
                   0.0722 * bilinear(image.c[2], x + i, y + j);
        };
        double nx = luma(0, 1.75) - luma(0, -1.75), ny = luma(1.75, 0) - luma(-1.75, 0);
        const double length = std::hypot(nx, ny);
        if (length < 0.0601) return double(p.at(x, y));
        nx /= length, ny /= length;
        return (p.at(x, y) + 0.9 * (bilinear(p, x + nx / 2, y + ny / 2) + bilinear(p, x - nx / 2, y - ny / 2)) +
                0.75 * (bilinear(p, x + nx, y + ny) + bilinear(p, x - nx, y - ny))) /
               4.3;
    });
}

}  // namespace
}  // namespace aa
