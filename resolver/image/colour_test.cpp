#include "image/colour.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aa {
namespace {
double srgbEncode(double c) { return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055; }
double srgbDecode(double e) { return e <= 0.04045 ? e / 12.92 : std::pow((e + 0.055) / 1.055, 2.4); }

TEST(Colour, SrgbAgreesWithPowInDouble) {
    Rgb linear(1000, 3), encoded, back;
    for (int y = 0; y < 3; y++)
        for (int x = 0; x < 1000; x++)
            for (auto& p : linear.c) p.at(x, y) = float(std::pow(10.0, -6.0 + 6.0 * x / 999.0) * (y == 2 ? 0 : 1));
    for (const auto precision : {Precision::fast, Precision::scalar, Precision::oracle}) {
        Exec exec;
        exec.precision = precision;
        encode(linear, {}, exec, encoded);
        decode(encoded, exec, back);
        for (int x = 0; x < 1000; x++) {
            const double c = linear.c[0].at(x, 0);
            EXPECT_NEAR(encoded.c[0].at(x, 0), srgbEncode(c), 3e-7) << c;
            EXPECT_NEAR(back.c[0].at(x, 0), srgbDecode(encoded.c[0].at(x, 0)), 3e-7) << c;
        }
    }
}

TEST(Colour, ExtremesStayInRange) {
    const float values[] = {-1, 0, 1, 1e6f, 1e30f, INFINITY, -INFINITY, NAN, 1e-40f};
    Rgb linear(9, 1), encoded;
    for (int x = 0; x < 9; x++)
        for (auto& p : linear.c) p.at(x, 0) = values[x];
    for (const auto map : {ToneMap::none, ToneMap::reinhard, ToneMap::aces}) {
        encode(linear, {2.0f, map}, {}, encoded);
        for (int x = 0; x < 9; x++) {
            EXPECT_GE(encoded.c[0].at(x, 0), 0.0f) << values[x];
            EXPECT_LE(encoded.c[0].at(x, 0), 1.0f) << values[x];
        }
        EXPECT_EQ(encoded.c[0].at(7, 0), 0.0f);
    }
}
}  // namespace
}  // namespace aa
