#include "metrics/flip.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "image/colour.h"
#include "metrics/flip_constants.h"

namespace aa {
namespace {
using std::numbers::pi;
const double kPpd = 0.7 * (3840 / 0.7) * pi / 180;

// [Andersson 2020] once more, in double: two-dimensional kernels, pow and cbrt of the library, no separation.
using V3 = std::array<double, 3>;
struct Image {
    int w, h;
    std::vector<V3> p;
    const V3& at(int x, int y) const {
        return p[size_t(std::clamp(y, 0, h - 1)) * size_t(w) + size_t(std::clamp(x, 0, w - 1))];
    }
};
const double kM[3][3] = {{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                         {2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                         {1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};
const double kWhite[3] = {0.950428545, 1, 1.088900371};
V3 whiteXyz(const V3& rgb) {
    V3 r;
    for (size_t i = 0; i < 3; i++) r[i] = (kM[i][0] * rgb[0] + kM[i][1] * rgb[1] + kM[i][2] * rgb[2]) / kWhite[i];
    return r;
}
V3 rgbOf(const V3& white) {  // Cramer's rule
    const V3 b = {white[0] * kWhite[0], white[1] * kWhite[1], white[2] * kWhite[2]};
    const auto det = [](const double(&m)[3][3]) {
        return m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
               m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0]);
    };
    V3 r;
    for (size_t c = 0; c < 3; c++) {
        double m[3][3];
        for (size_t i = 0; i < 3; i++)
            for (size_t k = 0; k < 3; k++) m[i][k] = k == c ? b[i] : kM[i][k];
        r[c] = det(m) / det(kM);
    }
    return r;
}
V3 ycxcz(const V3& rgb) {
    const V3 x = whiteXyz(rgb);
    return {116 * x[1] - 16, 500 * (x[0] - x[1]), 200 * (x[1] - x[2])};
}
V3 huntLab(const V3& o) {
    const double y = (o[0] + 16) / 116;
    V3 rgb = rgbOf({y + o[1] / 500, y, y - o[2] / 200});
    for (double& c : rgb) c = std::clamp(c, 0.0, 1.0);
    V3 f = whiteXyz(rgb);
    for (double& t : f) t = t > std::pow(6.0 / 29, 3) ? std::cbrt(t) : t / (3 * std::pow(6.0 / 29, 2)) + 4.0 / 29;
    const double l = 116 * f[1] - 16;
    return {l, 0.01 * l * 500 * (f[0] - f[1]), 0.01 * l * 200 * (f[1] - f[2])};
}
double hyab(const V3& a, const V3& b) { return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]); }
double csf(size_t channel, int x, int y) {
    const double d = (x * x + y * y) / (kPpd * kPpd);
    const auto g = [&](double a, double b) { return a * std::sqrt(pi / b) * std::exp(-pi * pi * d / b); };
    return channel == 0 ? g(1, 0.0047) : channel == 1 ? g(1, 0.0053) : g(34.1, 0.04) + g(13.5, 0.025);
}
V3 seenAt(const Image& image, int x, int y) {
    const int r = int(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * kPpd));
    V3 sum{}, weights{};
    for (int j = -r; j <= r; j++)
        for (int i = -r; i <= r; i++)
            for (size_t c = 0; c < 3; c++) {
                const double g = csf(c, i, j);
                sum[c] += g * image.at(x + i, y + j)[c];
                weights[c] += g;
            }
    for (size_t c = 0; c < 3; c++) sum[c] /= weights[c];
    return huntLab(sum);
}
double featureAt(const Image& image, int x, int y, bool point) {
    const double sd = 0.5 * 0.082 * kPpd;
    const int r = int(std::ceil(3 * sd));
    const auto g = [&](int i) { return std::exp(-i * i / (2 * sd * sd)); };
    const auto kernel = [&](int i) { return point ? (i * i / (sd * sd) - 1) * g(i) : -i * g(i); };
    double total = 0, positive = 0, negative = 0;
    for (int i = -r; i <= r; i++) total += g(i), (kernel(i) > 0 ? positive : negative) += std::abs(kernel(i));
    double dx = 0, dy = 0;
    for (int j = -r; j <= r; j++)
        for (int i = -r; i <= r; i++) {
            const double v = (image.at(x + i, y + j)[0] + 16) / 116;
            dx += v * kernel(i) / (kernel(i) > 0 ? positive : negative) * g(j) / total;
            dy += v * kernel(j) / (kernel(j) > 0 ? positive : negative) * g(i) / total;
        }
    return std::hypot(dx, dy);
}
double naiveFlipAt(const Image& t, const Image& r, int x, int y) {
    const double cmax = std::pow(hyab(huntLab(ycxcz({0, 1, 0})), huntLab(ycxcz({0, 0, 1}))), 0.7);
    const double e = std::pow(hyab(seenAt(t, x, y), seenAt(r, x, y)), 0.7);
    const double colour = e < 0.4 * cmax ? e * 0.95 / (0.4 * cmax) : 0.95 + (e - 0.4 * cmax) / (0.6 * cmax) * 0.05;
    const double edge = std::abs(featureAt(t, x, y, false) - featureAt(r, x, y, false));
    const double point = std::abs(featureAt(t, x, y, true) - featureAt(r, x, y, true));
    const double feature = std::sqrt(std::max(edge, point) / std::sqrt(2.0));
    return colour <= 0 ? 0 : std::pow(colour, 1 - feature);
}
Image opponentOf(const Rgb& encoded) {
    Image image{encoded.width(), encoded.height(), {}};
    for (int y = 0; y < image.h; y++)
        for (int x = 0; x < image.w; x++) {
            V3 linear;
            for (size_t c = 0; c < 3; c++) {
                const double e = double(encoded.c[c].at(x, y));
                linear[c] = e <= 0.04045 ? e / 12.92 : std::pow((e + 0.055) / 1.055, 2.4);
            }
            image.p.push_back(ycxcz(linear));
        }
    return image;
}
Rgb scene(int w, int h, unsigned seed, float grain) {
    std::mt19937 random(seed);
    Rgb image(w, h);
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) {
                const float noise = grain * (float(random() >> 8) * 0x1p-23f - 1);
                const float edge = 2 * x + y > w ? 0.8f : 0.15f + 0.2f * float(c);
                image.c[c].at(x, y) = std::clamp(edge + noise, 0.0f, 1.0f);
            }
    return image;
}

TEST(Flip, AgreesWithTheFormulas) {
    for (const auto& [w, h] : {std::pair{1, 1}, {1, 7}, {9, 1}, {23, 12}, {100, 6}}) {
        const Rgb test = scene(w, h, 1, 0.2f), reference = scene(w, h, 2, 0.05f);
        const Image t = opponentOf(test), r = opponentOf(reference);
        for (const auto precision : {Precision::fast, Precision::oracle}) {
            Exec exec;
            exec.precision = precision;
            PlaneF map;
            // float: Newton's roots, 3e-7, through differences of Lab values up to 100
            const double tolerance = precision == Precision::oracle ? 1e-6 : 5e-6;
            const double mean = flip(test, reference, exec, &map);
            double sum = 0;
            for (int y = 0; y < h; y++)
                for (int x = 0; x < w; x++) {
                    const double expected = naiveFlipAt(t, r, x, y);
                    sum += expected;
                    EXPECT_NEAR(double(map.at(x, y)), expected, tolerance) << w << "x" << h << " at " << x << "," << y;
                }
            EXPECT_NEAR(mean, sum / (w * h), tolerance) << w << "x" << h << " " << int(precision);
            EXPECT_GT(mean, 0.02);
        }
    }
}
TEST(Flip, IdenticalIsExactlyZero) {
    const Rgb a = scene(90, 40, 3, 0.3f);
    EXPECT_EQ(flip(a, a, {}), 0.0);
    EXPECT_EQ(flip(Rgb(1, 1), Rgb(1, 1), {}), 0.0);
}
TEST(Flip, BlackToWhiteIsNearTheTop) {
    // HyAB = 100 for black and white; nothing to feature in flat images.
    const double d = std::pow(100, 0.7), knee = 0.4 * flip_constants::kMaxColour;
    const double expected = 0.95 + (d - knee) / (flip_constants::kMaxColour - knee) * 0.05;
    EXPECT_NEAR(flip(Rgb(30, 30, 0.0f), Rgb(30, 30, 1.0f), {}), expected, 1e-5);
}
TEST(Flip, ExtremesStayInRange) {
    Rgb bad = scene(40, 30, 1, 0.1f);
    bad.c[0].at(5, 5) = NAN, bad.c[1].at(6, 6) = INFINITY, bad.c[2].at(7, 7) = -INFINITY, bad.c[0].at(8, 8) = 1e30f;
    PlaneF map;
    flip(bad, scene(40, 30, 2, 0.1f), {}, &map);
    for (int y = 0; y < 30; y++)
        for (int x = 0; x < 40; x++) ASSERT_TRUE(map.at(x, y) >= 0 && map.at(x, y) <= 1) << x << "," << y;
}
TEST(Flip, SameBitsEverywhere) {
    const Rgb t = scene(203, 150, 1, 0.2f), r = scene(203, 150, 2, 0.2f);
    PlaneF first, map;
    const double mean = flip(t, r, {bestIsa(), Precision::scalar, false}, &first);
    for (const Isa isa : kIsas)
        for (const bool parallel : {false, true}) {
            if (!isaSupported(isa)) continue;
            EXPECT_EQ(flip(t, r, {isa, Precision::fast, parallel}, &map), mean);
            EXPECT_TRUE(map.samePixels(first));
        }
}
TEST(Flip, OneReferenceServesManyPictures) {
    const Rgb r = scene(203, 150, 2, 0.2f);
    for (const double ppd : {kFlipPixelsPerDegree, 40.0})
        for (const Precision precision : {Precision::fast, Precision::oracle}) {
            const Exec exec{.precision = precision};
            const FlipReference reference(r, FlipReference::Values::encoded, exec, ppd);
            for (const unsigned seed : {1u, 3u, 2u}) {
                const Rgb t = scene(203, 150, seed, 0.2f);
                PlaneF map, alone;
                EXPECT_EQ(reference.flip(t, exec, &map), flip(t, r, exec, &alone, ppd)) << seed;
                EXPECT_TRUE(map.samePixels(alone)) << seed;
            }
        }
}
TEST(Flip, CodesAreDecodedAsImagesAre) {
    const Rgb t = scene(90, 40, 1, 0.2f), r = scene(90, 40, 2, 0.2f);
    Rgb linearTest, linearReference;
    decode(t, {}, {}, linearTest), decode(r, {}, {}, linearReference);
    // To rounding: in float FLIP has a decoding of its own.
    EXPECT_NEAR(flip(t, r, {}), flipOfLight(linearTest, linearReference, {}), 1e-7);
}
// Of every code of 8 bits: FLIP of a flat picture against that of its light in double.
TEST(Flip, EveryCodeIsDecodedAsIfInDouble) {
    Exec oracle;
    oracle.precision = Precision::oracle;
    for (int code = 0; code < 256; code++) {
        const Rgb test(2, 1, float(code) / 255), reference(2, 1, 0.5f);
        // From afar windows are small: flat ground must have no feature there either.
        for (const double ppd : {kFlipPixelsPerDegree, kLeastFlipPixelsPerDegree})
            EXPECT_NEAR(flip(test, reference, {}, nullptr, ppd), flip(test, reference, oracle, nullptr, ppd), 2e-6)
                << code << " at " << ppd;
    }
}
TEST(Flip, ConstantsAgreeWithTheirFormulas) {
    using namespace flip_constants;
    const auto gaussian = [](double b, int i) { return std::exp(-pi * pi * i * i / (kPpd * kPpd * b)); };
    const auto check = [&](const double* taps, int count, double b) {
        double sum = 0;
        for (int i = -kCsfReach; i <= kCsfReach; i++) sum += gaussian(b, i);
        for (int i = 0; i < count; i++) EXPECT_NEAR(taps[i], gaussian(b, i) / sum, 1e-15) << b << " " << i;
        return sum;
    };
    check(kCsfY, kNarrowReach + 1, 0.0047);
    check(kCsfCx, kNarrowReach + 1, 0.0053);
    const double wide = check(kCsfCzWide, kCsfReach + 1, 0.04), narrow = check(kCsfCzNarrow, kCsfReach + 1, 0.025);
    const double a = 34.1 * std::sqrt(pi / 0.04) * wide * wide, b = 13.5 * std::sqrt(pi / 0.025) * narrow * narrow;
    EXPECT_NEAR(kCzWideShare, a / (a + b), 1e-15);
    EXPECT_NEAR(kMaxColour, std::pow(hyab(huntLab(ycxcz({0, 1, 0})), huntLab(ycxcz({0, 0, 1}))), 0.7), 1e-6);
    for (size_t i = 0; i < 3; i++)
        for (size_t k = 0; k < 3; k++) {
            double sum = 0;
            for (size_t j = 0; j < 3; j++) sum += kToXyz[i][j] * kToRgb[j][k];
            EXPECT_NEAR(sum, i == k ? 1 : 0, 1e-14);
        }
}
TEST(Flip, StatisticsAreWeightedByTheError) {
    PlaneF map(4, 1);
    const float values[] = {0.1f, 0.0f, 0.6f, 0.3f};
    for (int x = 0; x < 4; x++) map.at(x, 0) = values[x];
    const FlipStatistics s = flipStatistics(map);
    EXPECT_NEAR(s.mean, 0.25, 1e-7);
    EXPECT_NEAR(s.max, 0.6, 1e-7);
    EXPECT_NEAR(s.median, 0.3, 1e-7);  // 0.1 + 0.3 of 1.0 lie below one half
    EXPECT_NEAR(s.firstQuartile, 0.1, 1e-7);
    // Of values that no map has, too.
    for (const float v : {NAN, -1e30f, 1e30f, INFINITY}) {
        map.at(1, 0) = v;
        flipStatistics(map);
    }
}
}  // namespace
}  // namespace aa
