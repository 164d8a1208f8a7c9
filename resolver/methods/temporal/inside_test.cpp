#include "methods/temporal/inside.h"

#include <gtest/gtest.h>

#include "methods/method.h"
#include "methods/temporal/temporal_test_frames.h"

namespace aa {
namespace {
using namespace testing;

constexpr int kInsideWidth = 27, kInsideHeight = 19;

// Depths and motions for which the distance of the four taps varies: 0.5 / (speed * depth) lies about 1.
Frame randomFrame(int n) {
    const Picture colours = noisePicture(unsigned(60 + n)), surfaces = noisePicture(unsigned(80 + n));
    Frame f = temporalFrame(n, kInsideWidth, kInsideHeight, colours);
    for (int y = 0; y < kInsideHeight; y++)
        for (int x = 0; x < kInsideWidth; x++) {
            f.depthView.at(x, y) = 0.2f + 2 * surfaces(x, y, 0);
            f.motionXPx.at(x, y) = 2 * surfaces(x, y, 1) - 1;
            f.motionYPx.at(x, y) = 2 * surfaces(x, y, 2) - 1;
        }
    f.depthView.fillBorder(), f.motionXPx.fillBorder(), f.motionYPx.fillBorder();
    return f;
}

// The game's first form (neighbourhood=4tapVarying) with a clamp, evaluated directly; `reach` 1: motion of the nearest
// surface in 3x3, 0: the pixel's own; `ownDepth`: the depth of the pixel itself in either case; `read`: where the
// colours of the frame are read, from the pixel.
double fourTap(const Frame& f, const Rgb& past, int reach, bool ownDepth, glm::dvec2 read, size_t c, int x, int y) {
    const auto at = [&](const PlaneF& p, int i, int j) {
        return double(p.at(std::clamp(i, 0, kInsideWidth - 1), std::clamp(j, 0, kInsideHeight - 1)));
    };
    const auto bilinear = [&](const PlaneF& p, double px, double py) {
        const double fx = px - 0.5 - std::floor(px - 0.5), fy = py - 0.5 - std::floor(py - 0.5);
        const int i = int(std::floor(px - 0.5)), j = int(std::floor(py - 0.5));
        return (1 - fy) * ((1 - fx) * at(p, i, j) + fx * at(p, i + 1, j)) +
               fy * ((1 - fx) * at(p, i, j + 1) + fx * at(p, i + 1, j + 1));
    };
    int nearX = x, nearY = y;
    for (int j = -reach; j <= reach; j++)
        for (int i = -reach; i <= reach; i++)
            if (at(f.depthView, x + i, y + j) < at(f.depthView, nearX, nearY)) nearX = x + i, nearY = y + j;
    const double mx = at(f.motionXPx, nearX, nearY), my = at(f.motionYPx, nearX, nearY);
    const double depth = ownDepth ? at(f.depthView, x, y) : at(f.depthView, nearX, nearY);
    const double qx = x + 0.5 - mx, qy = y + 0.5 - my;
    const Rgb& now = f.colorEncoded;
    if (qx < 0 || qx > kInsideWidth || qy < 0 || qy > kInsideHeight)
        return bilinear(now.c[c], x + 0.5 + read.x, y + 0.5 + read.y);
    const double s = 0.5 + 0.1666 * std::min(0.5 / (1e-8 + std::hypot(mx, my) * depth), 1.0);
    double current[3], held[3];
    for (size_t k = 0; k < 3; k++) {
        double lo = 1e9, hi = -1e9;
        for (const double i : {-s, s})
            for (const double j : {-s, s}) {
                const double tap = bilinear(now.c[k], x + 0.5 + read.x + i, y + 0.5 + read.y + j);
                lo = std::min(lo, tap), hi = std::max(hi, tap);
            }
        current[k] = bilinear(now.c[k], x + 0.5 + read.x, y + 0.5 + read.y);
        held[k] = std::min(std::max(bilinear(past.c[k], qx, qy), lo), hi);
    }
    const auto luma = [](const double* v) { return 0.2126 * v[0] + 0.7152 * v[1] + 0.0722 * v[2]; };
    const double a = luma(current), b = luma(held), d = std::fabs(a - b) / std::max({a, b, 0.2});
    const double k = 0.88 + 0.09 * (1 - d) * (1 - d);
    return current[c] + (held[c] - current[c]) * k;
}

// The depth belongs to the surface whose motion was taken (the original's find_closest_fragment returns both).
TEST(Inside, FourTapsVaryWithTheDilatedDepth) {
    for (const int reach : {1, 0}) {
        RunningMethod m = running(std::string("inside:neighbourhood=4tapVarying,unjitterColor=off,clipTarget=clamp,"
                                              "dilation=") +
                                      (reach ? "closest3x3" : "none"),
                                  kInsideWidth, kInsideHeight);
        const Frame first = randomFrame(0), second = randomFrame(1);
        m.resolve(first, {}, {});
        m.resolve(second, {}, {});
        double wrong = 0;
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < kInsideHeight; y++)
                for (int x = 0; x < kInsideWidth; x++) {
                    const double found = double(m.out.c[c].at(x, y));
                    EXPECT_NEAR(found, fourTap(second, first.colorEncoded, reach, false, {}, c, x, y), 2e-6)
                        << reach << ": " << x << "," << y;
                    wrong = std::max(wrong,
                                     std::fabs(found - fourTap(second, first.colorEncoded, reach, true, {}, c, x, y)));
                }
        if (reach) {
            EXPECT_GT(wrong, 1e-2);  // the pixel's own depth is another picture
        }
    }
}
// Un-jittered, each of the four taps is one bilinear read of the frame, not one between nine of them.
TEST(Inside, FourTapsAreReadWhereTheyLie) {
    for (const glm::dvec2 jitter : {glm::dvec2(0.25, -0.375), {-0.5, 0.4375}, {0, 0}}) {
        RunningMethod m = running("inside:neighbourhood=4tapVarying,unjitterNeighbourhood=on,clipTarget=clamp",
                                  kInsideWidth, kInsideHeight);
        Frame first = randomFrame(0), second = randomFrame(1);
        first.jitterPx = second.jitterPx = jitter;
        m.resolve(first, {}, {});
        const Rgb past = m.out;
        m.resolve(second, {}, {});
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < kInsideHeight; y++)
                for (int x = 0; x < kInsideWidth; x++)
                    ASSERT_NEAR(m.out.c[c].at(x, y), fourTap(second, past, 1, false, -jitter, c, x, y), 3e-6)
                        << jitter.x << ": " << x << "," << y;
    }
}

}  // namespace
}  // namespace aa
