#include "metrics/hdr_flip.h"

#include <gtest/gtest.h>

#include <cmath>

#include "metrics/flip.h"

namespace aa {
namespace {

unsigned noise(unsigned x, unsigned y, unsigned c) {
    unsigned h = x * 374761393u + y * 668265263u + c * 3266489917u + 7 * 2654435761u;
    h = (h ^ (h >> 13)) * 1274126177u;
    return (h ^ (h >> 16)) & 255;
}
// Light over twelve stops, or even grey, with a bright disc; the test has grain.
Rgb scene(bool stops, bool test, int w = 64, int h = 48) {
    Rgb image(w, h);
    for (int c = 0; c < 3; c++)
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) {
                float v = stops ? 0.002f * float(1 << (x * 12 / w)) : 0.5f;
                if ((x - w / 2) * (x - w / 2) + (y - h / 2) * (y - h / 2) < 49) v += 20.0f;
                v *= 1 + 0.25f * float(c);
                if (test) v *= 0.75f + float(noise(unsigned(x), unsigned(y), unsigned(c))) / 512.0f;
                image.c[size_t(c)].at(x, y) = v;
            }
    image.fillBorder();
    return image;
}

// What the authors' program says of the same pictures: FLIP::evaluate of https://github.com/NVlabs/flip, v1.7, on the
// processor, BSD licence.
TEST(HdrFlip, AgreesWithTheReferenceProgram) {
    struct Known {
        bool stops;
        double mean, start, stop;
        int count;
    };
    for (const Known& k :
         {Known{true, 0.0875608, -3.53782, 3.76824, 8}, Known{false, 0.1046508, -3.55509, 1.80246, 6}}) {
        const Rgb test = scene(k.stops, true), reference = scene(k.stops, false);
        EXPECT_NEAR(hdrFlip(test, reference, {}), k.mean, 1e-4);
        const ExposureRange range = exposureRange(reference);
        EXPECT_NEAR(range.start, k.start, 1e-4);
        EXPECT_NEAR(range.stop, k.stop, 1e-4);
        EXPECT_EQ(range.count, k.count);
    }
}
// The same program at other distances, without exposures: half of the light, what exceeds 1 shown as 1.
TEST(Flip, AgreesWithTheReferenceProgramAtAnyDistance) {
    Rgb test = scene(true, true), reference = scene(true, false);
    for (Rgb* image : {&test, &reference})
        for (auto& c : image->c)
            for (int y = 0; y < 48; y++)
                for (int x = 0; x < 64; x++) c.at(x, y) = std::min(1.0f, c.at(x, y) * 0.5f);
    EXPECT_NEAR(flipOfLight(test, reference, {}, nullptr, 30), 0.0843545, 5e-5);
    EXPECT_NEAR(flipOfLight(test, reference, {}, nullptr, 120), 0.0359297, 5e-5);
    // The filters of the usual distance, once constant and once computed.
    const double usual = flipOfLight(test, reference, {});
    EXPECT_NEAR(usual, 0.0485365, 5e-5);
    EXPECT_NEAR(flipOfLight(test, reference, {}, nullptr, std::nextafter(kFlipPixelsPerDegree, 100)), usual, 1e-6);
    for (const double ppd : {kLeastFlipPixelsPerDegree, kMostFlipPixelsPerDegree}) {
        PlaneF map;
        const double value = flipOfLight(test, reference, {}, &map, ppd);
        EXPECT_TRUE(value > 0 && value < 1) << ppd;
        EXPECT_EQ(flipOfLight(test, test, {}, nullptr, ppd), 0.0);
    }
}
TEST(HdrFlip, IsTheLargestOverTheExposures) {
    const Rgb test = scene(true, true), reference = scene(true, false);
    PlaneF map;
    const double mean = hdrFlip(test, reference, {}, &map);
    double sum = 0;
    for (int y = 0; y < map.height(); y++)
        for (int x = 0; x < map.width(); x++) sum += double(map.at(x, y));
    EXPECT_NEAR(mean, sum / (64 * 48), 1e-12);
    // One exposure shows one end of the range alone: there the others see more.
    EXPECT_GT(mean, 1.5 * flipOfLight(test, reference, {}));
}
TEST(HdrFlip, IdenticalIsZeroAndOddLightIsRead) {
    EXPECT_EQ(hdrFlip(scene(true, true), scene(true, true), {}), 0.0);
    const Rgb black(20, 10);
    EXPECT_EQ(exposureRange(black).count, 1);
    EXPECT_EQ(hdrFlip(black, black, {}), 0.0);
    Rgb dark(20, 10);  // one lit pixel: the median is black
    for (auto& c : dark.c) c.at(3, 3) = 8;
    const ExposureRange range = exposureRange(dark);
    EXPECT_EQ(range.count, 2);
    EXPECT_NEAR(range.start, range.stop, 1e-12);
    for (auto& c : dark.c) c.at(4, 4) = 1e-30f;
    EXPECT_NEAR(exposureRange(dark).stop - exposureRange(dark).start, 20, 1e-9);
    Rgb bad = scene(false, true);
    bad.c[0].at(5, 5) = NAN, bad.c[1].at(6, 6) = INFINITY, bad.c[2].at(7, 7) = -1;
    for (const double value :
         {hdrFlip(scene(false, false), bad, {}), hdrFlip(bad, scene(false, false), {}), hdrFlip(black, dark, {})})
        EXPECT_TRUE(value > 0 && value <= 1) << value;
}
TEST(HdrFlip, SameBitsEverywhere) {
    const Rgb t = scene(true, true, 150, 140), r = scene(true, false, 150, 140);
    const double first = hdrFlip(t, r, {bestIsa(), Precision::scalar, false});
    for (const Isa isa : kIsas) {
        if (!isaSupported(isa)) continue;
        EXPECT_EQ(hdrFlip(t, r, {isa, Precision::fast, true}), first);
    }
}
}  // namespace
}  // namespace aa
