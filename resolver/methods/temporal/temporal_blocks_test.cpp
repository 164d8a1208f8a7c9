// The building blocks of conventions 7 against the values of conventions 15 and the rules of conventions 9.
#include <gtest/gtest.h>

#define AA_ARCH block_test
#define AA_LANES 4
#include "methods/temporal/temporal_blocks.kernel.h"
#undef AA_ARCH

#include <cmath>
#include <limits>

#include "image/plane.h"

namespace aa {
namespace {
using namespace block_test;
using V = vec3<double>;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

void expectNear(V v, double x, double y, double z, double tolerance) {
    EXPECT_NEAR(v.x, x, tolerance);
    EXPECT_NEAR(v.y, y, tolerance);
    EXPECT_NEAR(v.z, z, tolerance);
}
RgbaPlane history(int w, int h) {
    RgbaPlane p(w, h);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            float* t = p.row(y) + 4 * x;
            t[0] = 0.1f * float(x) + 0.01f * float(y), t[1] = float((x * 31 + y * 17) % 11), t[2] = float(x * y),
            t[3] = 1;
        }
    p.fillBorder();
    return p;
}
TemporalIn input(const RgbaPlane& p) {
    TemporalIn in;
    in.history = p.row(0);
    in.stride = p.stride(), in.width = p.width(), in.height = p.height();
    return in;
}
template <class R>
Texel<R> bilinearAt(const RgbaPlane& p, int x, int y, R mx, R my) {
    const TemporalIn in = input(p);
    return fetchBilinear<R>(in.history + 4 * (y * in.stride + x), in.stride, reproject<R>(in, {mx, my}, x, y));
}

TEST(TemporalBlocks, FeedbackVectors) {
    EXPECT_NEAR(luminanceFeedback(0.5, 0.25, 0.88f, 0.97f), 0.9025, 1e-7);
    EXPECT_NEAR(luminanceFeedback(0.5, 0.5, 0.88f, 0.97f), 0.97, 1e-7);
    EXPECT_NEAR(luminanceFeedback(0.0, 0.1, 0.88f, 0.97f), 0.9025, 1e-7);
    EXPECT_NEAR(luminanceFeedback(1.0, 0.0, 0.88f, 0.97f), 0.88, 1e-7);
    // Negative luminance may not raise the feedback again.
    EXPECT_NEAR(luminanceFeedback(1.0, -3.0, 0.88f, 0.97f), 0.88, 1e-7);
}

TEST(TemporalBlocks, ClipVectors) {
    const Box<double> box{V(0.0), V(0.5)};
    const V h(1.0, 0.5, 0.25), inside(0.3, 0.49999, 0.0);
    expectNear(clipToCentre(box, h), 0.5, 1.0 / 3, 0.25, 1e-6);
    expectNear(clipToward(box, V(0.1), h), 0.5, 0.2777778, 0.1666667, 1e-6);
    expectNear(clamp3(h, box.lo, box.hi), 0.5, 0.5, 0.25, 0);
    for (const V& v : {clipToCentre(box, inside), clipToward(box, V(0.1), inside)}) {
        EXPECT_EQ(v.x, inside.x);
        EXPECT_EQ(v.y, inside.y);
        EXPECT_EQ(v.z, inside.z);
    }
    // A box of one colour: the exact clip gives that colour, the centre clip up to its floor of the extent.
    const Box<double> point{V(0.7), V(0.7)};
    expectNear(clipToward(point, V(0.7), h), 0.7, 0.7, 0.7, 0);
    expectNear(clipToCentre(point, h), 0.7, 0.7, 0.7, 1e-6);
}

V oneInWindow(int i, int j, int oneI, int oneJ) { return V(i == oneI && j == oneJ ? 1.0 : 0.0); }

TEST(TemporalBlocks, VarianceBoxVector) {
    for (const auto& [oi, oj] : {std::pair{1, 1}, {0, 0}, {-1, 0}}) {
        const auto m = moments<double>([&, oi = oi, oj = oj](int i, int j) { return oneInWindow(i, j, oi, oj); });
        EXPECT_NEAR(m.mean.x, 1.0 / 9, 1e-12);
        EXPECT_NEAR(m.sigma.x, 0.31427, 1e-5);
    }
}
TEST(TemporalBlocks, VarianceOfABrightWindowKeepsItsDigits) {
    const auto at = [](int i, int j) { return vec3<float>(1e4f + float(i) + 0.5f * float(j)); };
    // mean of i^2 over 3x3 = 2/3; sigma^2 = 2/3 (1 + 1/4).
    EXPECT_NEAR(moments<float>(at).sigma.x, std::sqrt(2.0 / 3 * 1.25), 1e-4);
}
TEST(TemporalBlocks, RoundedBoxVectors) {
    const auto roundedHigh = [](int oi, int oj) {
        return neighbourBox<double>([&](int i, int j) { return oneInWindow(i, j, oi, oj); }, Neighbourhood::rounded)
            .hi.x;
    };
    EXPECT_EQ(roundedHigh(-1, 1), 0.5);
    EXPECT_EQ(roundedHigh(0, 0), 1.0);
    EXPECT_EQ(roundedHigh(0, -1), 1.0);
    const auto cornerAlone = [](int i, int j) { return oneInWindow(i, j, 1, 1); };
    EXPECT_EQ(neighbourBox<double>(cornerAlone, Neighbourhood::rounded).lo.x, 0.0);
    EXPECT_EQ(neighbourBox<double>(cornerAlone, Neighbourhood::plus).hi.x, 0.0);
    EXPECT_NEAR(neighbourMeans<double>(cornerAlone).square.x, 1.0 / 9, 1e-12);
    EXPECT_EQ(neighbourMeans<double>(cornerAlone).plus.x, 0.0);
}

TEST(TemporalBlocks, BlendIsExactAtBothEnds) {
    const V c(0.123, 4.56, 1e-3), h(0.9, 1e6, 3e-7);
    const V none = blend(c, h, 0.0), all = blend(c, h, 1.0);
    EXPECT_EQ(none.x, c.x);
    EXPECT_EQ(none.y, c.y);
    EXPECT_EQ(all.y, h.y);
    EXPECT_EQ(all.z, h.z);
    expectNear(blend(c, h, 0.25), 0.75 * 0.123 + 0.25 * 0.9, 0.75 * 4.56 + 0.25e6, 0.75e-3 + 0.75e-7, 1e-9);
}
TEST(TemporalBlocks, InverseLuminanceBlendVector) {
    // T2MSAA (conventions 15): N = 1, c = 1, h = 0, a = 1/2 -> 1/3.
    expectNear(inverseLuminanceBlend(V(1.0), 1.0, V(0.0), 0.0, 0.5), 1.0 / 3, 1.0 / 3, 1.0 / 3, 1e-12);
}

TEST(TemporalBlocks, CatmullRomWeights) {
    double w[4];
    catmullRomWeights(0.25, w);
    const double expected[4] = {-0.0703125, 0.8671875, 0.2265625, -0.0234375};
    for (int i = 0; i < 4; i++) EXPECT_DOUBLE_EQ(w[i], expected[i]);
}

TEST(TemporalBlocks, BilinearAgreesWithItsDefinition) {
    const RgbaPlane p = history(9, 6);
    // q = p - motion: motion (0.75, -0.25) at (4, 2) reads texels 3, 4 at fraction 0.25 and rows 2, 3 at 0.25.
    const auto t = bilinearAt<double>(p, 4, 2, 0.75, -0.25);
    const auto at = [&](int x, int y, int c) { return double(p.row(y)[4 * x + c]); };
    for (int c = 0; c < 3; c++) {
        const double expected =
            0.75 * (0.75 * at(3, 2, c) + 0.25 * at(4, 2, c)) + 0.25 * (0.75 * at(3, 3, c) + 0.25 * at(4, 3, c));
        EXPECT_NEAR((c == 0 ? t.rgb.x : c == 1 ? t.rgb.y : t.rgb.z), expected, 1e-12);
    }
    // The opposite sign of motion is another place.
    EXPECT_GT(std::abs(bilinearAt<double>(p, 4, 2, -0.75, 0.25).rgb.x - t.rgb.x), 0.1);
}

TEST(TemporalBlocks, WholePixelMotionReadsTheTexelItself) {
    RgbaPlane p = history(40, 7);
    p.row(3)[4 * 20] = kNan;  // weight 0 must not spread it
    p.row(4)[4 * 21 + 1] = std::numeric_limits<float>::infinity();
    for (int x = 0; x < 40; x++)
        for (const int m : {-5, -1, 0, 1, 7}) {
            const int from = x - m;
            if (from < 0 || from >= 40 || from == 20) continue;
            const auto t = bilinearAt<float>(p, x, 3, float(m), 0.0f);
            EXPECT_EQ(t.rgb.x, p.row(3)[4 * from]);
            EXPECT_EQ(t.rgb.y, p.row(3)[4 * from + 1]);
            const TemporalIn in = input(p);
            const auto q = reproject<float>(in, {float(m), 0.0f}, x, 3);
            const float* texel = in.history + 4 * (3 * in.stride + x);
            EXPECT_EQ(fetchCatmullRom<true>(texel, in.stride, q).x, p.row(3)[4 * from]);
            EXPECT_EQ(fetchCatmullRom<false>(texel, in.stride, q).x, p.row(3)[4 * from]);
        }
}

TEST(TemporalBlocks, CatmullRomReproducesALinearRamp) {
    RgbaPlane p(20, 20);
    for (int y = 0; y < 20; y++)
        for (int x = 0; x < 20; x++)
            for (int c = 0; c < 4; c++) p.row(y)[4 * x + c] = float(3 * x + 5 * y + c);
    p.fillBorder();
    const TemporalIn in = input(p);
    const auto q = reproject<double>(in, {0.3, -0.6}, 9, 8);
    const double expected = 3 * (9 - 0.3) + 5 * (8 + 0.6);
    const float* texel = in.history + 4 * (8 * in.stride + 9);
    EXPECT_NEAR(fetchCatmullRom<true>(texel, in.stride, q).x, expected, 1e-9);
    EXPECT_NEAR(fetchCatmullRom<false>(texel, in.stride, q).x, expected, 0.7);  // without corners: not exact off axis
}

TEST(TemporalBlocks, ClosedIntervalDecidesInside) {
    const RgbaPlane p = history(8, 8);
    const TemporalIn in = input(p);
    const auto inside = [&](double mx, double my) { return reproject<double>(in, {mx, my}, 0, 0).inside; };
    EXPECT_TRUE(inside(0.5, 0));  // q.x = 0
    EXPECT_FALSE(inside(0.50001, 0));
    EXPECT_TRUE(inside(-7.5, 0));  // q.x = 8 = width
    EXPECT_FALSE(inside(-7.50001, 0));
    EXPECT_FALSE(inside(0, 0.6));
    EXPECT_FALSE(inside(0, -7.6));
    EXPECT_FALSE(inside(kNan, 0));
    EXPECT_FALSE(inside(0, kNan));
    EXPECT_FALSE(inside(1e30, 0));
    EXPECT_FALSE(inside(-std::numeric_limits<double>::infinity(), 0));
    TemporalIn clamped = in;
    clamped.clampOutside = true;
    const auto held = [&](double mx, double my) { return reproject<double>(clamped, {mx, my}, 4, 4); };
    for (const double bad : {double(kNan), 1e6, 1e30, 16.01, -16.01}) {  // more than two pictures: no motion
        EXPECT_FALSE(held(bad, 0).inside) << bad;
        EXPECT_FALSE(held(0, bad).inside) << bad;
    }
    EXPECT_TRUE(held(16, -16).inside);
}

TEST(TemporalBlocks, DilationTakesTheNearestAndTheCentreOnTies) {
    PlaneF depth(5, 5, 4.0f), mx(5, 5, 1.0f), my(5, 5, 0.0f);
    TemporalIn in;
    in.stride = depth.stride(), in.width = in.height = 5;
    auto motionAt22 = [&](Dilation d) {
        depth.fillBorder(), mx.fillBorder(), my.fillBorder();
        in.depthView = depth.row(0), in.motionXPx = mx.row(0), in.motionYPx = my.row(0);
        in.dilation = d;
        return dilatedMotion<double>(in, 2 * in.stride + 2).x;
    };
    mx.at(2, 2) = 7;
    EXPECT_EQ(motionAt22(Dilation::closest3x3), 7);  // all equal: the centre
    depth.at(2, 1) = 3, mx.at(2, 1) = 2;
    depth.at(1, 2) = 3, mx.at(1, 2) = 5;
    EXPECT_EQ(motionAt22(Dilation::closest3x3), 2);  // tie of neighbours: first row
    EXPECT_EQ(motionAt22(Dilation::closestX), 7);    // neither is diagonal
    depth.at(3, 3) = 1, mx.at(3, 3) = -3;
    EXPECT_EQ(motionAt22(Dilation::closestX), -3);
    mx.at(3, 1) = -20;
    EXPECT_EQ(motionAt22(Dilation::longest3x3), -20);
    EXPECT_EQ(motionAt22(Dilation::none), 7);
    depth.at(3, 1) = kNan;  // NaN depth is never nearest
    EXPECT_EQ(motionAt22(Dilation::closest3x3), -3);
}

TEST(TemporalBlocks, UniformFetchUndoesJitter) {
    PlaneF p(12, 12);
    for (int y = 0; y < 12; y++)
        for (int x = 0; x < 12; x++) p.at(x, y) = float(2 * x + 3 * y);
    p.fillBorder();
    const UniformFetch<double> at(-0.25f, 0.375f);
    EXPECT_NEAR(at(p.row(5) + 6, p.stride()), 2 * (6 - 0.25) + 3 * (5 + 0.375), 1e-12);
    EXPECT_EQ(UniformFetch<double>(0, 0)(p.row(5) + 6, p.stride()), 27.0);
}

TEST(TemporalBlocks, SanitiserKeepsNothingBroken) {
    const V good(0.5), bad(0.1, kNan, 0.2);
    EXPECT_EQ(sanitised(good, bad, bad).x, 0.5);
    EXPECT_EQ(sanitised(bad, good, V(0.7)).y, 0.5);
    EXPECT_EQ(sanitised(bad, bad, V(0.7)).y, 0.7);
    EXPECT_EQ(sanitised(bad, bad, bad).y, 0.0);
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_EQ(sanitised(V(inf, 0, 0), V(inf), V(0.25)).x, 0.25);
}

}  // namespace
}  // namespace aa
