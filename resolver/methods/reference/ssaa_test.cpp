#include "methods/reference/ssaa.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "image/error.h"
#include "methods/method.h"
#include "methods/reference/noaa.h"

namespace aa {
namespace {

// A frame whose sub-sample k has the colour value(k, x, y, channel).
template <class F>
Frame frameOf(int width, int height, size_t count, const F& value) {
    Frame f;
    f.width = width, f.height = height;
    f.colorLinear = Rgb(width, height);
    f.subSamples.resize(count);
    f.subSamplePositionsPx.resize(count, glm::dvec2(0));
    for (size_t k = 0; k < count; k++) {
        f.subSamples[k].colorLinear = Rgb(width, height);
        for (size_t c = 0; c < 3; c++)
            for (int y = 0; y < height; y++)
                for (int x = 0; x < width; x++) f.subSamples[k].colorLinear.c[c].at(x, y) = value(k, x, y, c);
    }
    return f;
}
Rgb resolved(const Frame& f, const Exec& exec = {}) {
    ShotInfo shot;
    shot.width = f.width, shot.height = f.height;
    shot.subSamplePositionsPx = f.subSamplePositionsPx;
    Rgb out(f.width, f.height, -1);
    ssaaDescriptor().create(Params("ssaa", ssaaDescriptor().params, {}), shot)->resolve(f, exec, out);
    return out;
}
float noise(size_t k, int x, int y, size_t c) {
    return float(std::fmod(std::sin(double(k) * 12.9898 + x * 78.233 + y * 37.719 + double(c) * 4.581) * 43758.5453,
                           1.0)) *
           std::pow(10.0f, float((k * 5 + size_t(x)) % 9) - 4.0f);
}

TEST(Ssaa, MeanOfSamplesInAnyOrder) {
    const auto forward = [](size_t k, int x, int y, size_t c) { return noise(k, x, y, c); };
    const auto backward = [](size_t k, int x, int y, size_t c) { return noise(15 - k, x, y, c); };
    const Rgb a = resolved(frameOf(21, 5, 16, forward)), b = resolved(frameOf(21, 5, 16, backward));
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < 5; y++)
            for (int x = 0; x < 21; x++) {
                long double mean = 0;
                for (size_t k = 0; k < 16; k++) mean += static_cast<long double>(noise(k, x, y, c)) / 16;
                EXPECT_FLOAT_EQ(a.c[c].at(x, y), float(mean));
                EXPECT_FLOAT_EQ(a.c[c].at(x, y), b.c[c].at(x, y));
            }
}

TEST(Ssaa, OneSampleEqualsNoaaAndConstantsStayExact) {
    Frame f = frameOf(17, 3, 1, noise);
    f.colorLinear = f.subSamples[0].colorLinear;
    Rgb plain(17, 3);
    noaaDescriptor().create(Params("noaa", {}, {}), {})->resolve(f, {}, plain);
    EXPECT_TRUE(plain.samePixels(f.colorLinear));  // noaa: what was rendered, bit by bit
    EXPECT_TRUE(resolved(f).samePixels(plain));
    for (const size_t count : {3u, 7u, 64u})
        EXPECT_TRUE(resolved(frameOf(9, 2, count, [](auto...) { return 0.1f; })).samePixels(Rgb(9, 2, 0.1f))) << count;
}

TEST(Ssaa, FireflyIsNotClampedAndNonFiniteSamplesAreLeftOut) {
    const auto firefly = [](size_t k, int, int, size_t) { return k == 5 ? 1e6f : 0.0f; };
    EXPECT_EQ(resolved(frameOf(1, 1, 128, firefly)).c[1].at(0, 0), 7812.5f);
    const float inf = std::numeric_limits<float>::infinity();
    // Sample 0: NaN in one channel only; sample 1: Inf; samples 2 and 3: finite.
    const auto holes = [&](size_t k, int x, int, size_t c) {
        if (x == 1) return NAN;
        return k == 0 && c == 2 ? NAN : k == 1 ? inf : float(k);
    };
    const Rgb out = resolved(frameOf(2, 1, 4, holes));
    for (size_t c = 0; c < 3; c++) {
        EXPECT_EQ(out.c[c].at(0, 0), 2.5f);
        EXPECT_EQ(out.c[c].at(1, 0), 0.0f);  // no finite sample at all
    }
}

TEST(Ssaa, EveryInstructionSetAndPrecisionGivesTheSameBits) {
    const Frame f = frameOf(37, 11, 8, noise);
    const Rgb expected = resolved(f);
    for (const Isa isa : kIsas)
        for (const auto precision : {Precision::fast, Precision::scalar, Precision::oracle}) {
            if (!isaSupported(isa)) continue;
            EXPECT_TRUE(resolved(f, {isa, precision, false}).samePixels(expected)) << name(isa);
        }
}

TEST(Ssaa, ShotWithoutSubSamplesIsAnInputError) {
    EXPECT_THROW(ssaaDescriptor().create(Params("ssaa", ssaaDescriptor().params, {}), {}), InputError);
}

}  // namespace
}  // namespace aa
