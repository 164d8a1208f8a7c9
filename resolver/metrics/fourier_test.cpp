#include "metrics/fourier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "metrics/measure.h"
#include "metrics/metrics_testing.h"

namespace aa {
namespace {
using std::numbers::pi;

// `image` plus a wave of amplitude a at (fx, fy) cycles per px.
Rgb withWave(Rgb image, double a, double fx, double fy) {
    for (auto& p : image.c)
        for (int y = 0; y < p.height(); y++)
            for (int x = 0; x < p.width(); x++) p.at(x, y) += float(a * std::cos(2 * pi * (fx * x + fy * y)));
    return image;
}

TEST(Fourier, AnyLengthAgreesWithTheDefinition) {
    std::mt19937 random(1);
    for (const size_t n : {1u, 2u, 3u, 4u, 5u, 7u, 12u, 17u, 30u, 49u, 64u, 97u, 135u}) {
        std::vector<std::complex<double>> x(n), fast(n);
        for (auto& v : x) v = {double(random() % 1000) / 1000, double(random() % 1000) / 1000};
        Fft(n).transform(x, fast);
        for (size_t k = 0; k < n; k++) {
            std::complex<double> sum = 0;
            for (size_t i = 0; i < n; i++) sum += x[i] * std::polar(1.0, -2 * pi * double(k * i % n) / double(n));
            EXPECT_LT(std::abs(sum - fast[k]), 1e-11 * double(n)) << n << " " << k;
        }
    }
}
TEST(Fourier, ParsevalForAnySize) {
    for (const auto& [w, h] : {std::pair{1, 1}, {1, 9}, {16, 8}, {15, 7}, {31, 20}, {48, 27}}) {
        const Rgb t = noisePicture(w, h, 1), r = noisePicture(w, h, 2);
        const FourierError e = fourierError(t, r, {});
        const double mse = squaredError(t, r, {}).mse;
        EXPECT_NEAR(e.fmse, mse, 1e-6 * mse) << w << "x" << h;
        EXPECT_NEAR(std::accumulate(e.fband.begin(), e.fband.end(), 0.0), e.fmse, 1e-12);
        EXPECT_LE(e.fmagMse, e.fmse * (1 + 1e-9));
    }
}
TEST(Fourier, AWaveFallsIntoItsBand) {
    const Rgb r = noisePicture(64, 64, 3);
    const double frequencies[4][2] = {{4.0 / 64, 0}, {8.0 / 64, 8.0 / 64}, {0, 20.0 / 64}, {28.0 / 64, 28.0 / 64}};
    for (size_t b = 0; b < 4; b++) {
        const FourierError e = fourierError(withWave(r, 0.1, frequencies[b][0], frequencies[b][1]), r, {});
        for (size_t k = 0; k < 4; k++) EXPECT_NEAR(e.fband[k], k == b ? 0.005 : 0, 1e-7) << b << " " << k;
    }
}
TEST(Fourier, PhaseBlindAndThesisForms) {
    const Rgb r = noisePicture(32, 16, 4);
    Rgb moved(32, 16), shiftedDc = r;
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < 16; y++)
            for (int x = 0; x < 32; x++) {
                moved.c[c].at(x, y) = r.c[c].at((x + 3) % 32, y);
                shiftedDc.c[c].at(x, y) += 0.25f;
            }
    const FourierError moves = fourierError(moved, r, {});
    EXPECT_GT(moves.fmse, 0.05);
    EXPECT_NEAR(moves.fmagMse, 0, 1e-12);  // a cyclic shift changes the phase only
    const FourierError dc = fourierError(shiftedDc, r, {});
    EXPECT_NEAR(dc.fmagMse, 0.0625, 1e-6);
    // The printed formula equals the mean of D(x) D(-x).
    const Rgb t = noisePicture(32, 16, 5);
    double mirrored = 0;
    for (size_t c = 0; c < 3; c++)
        for (int y = 0; y < 16; y++)
            for (int x = 0; x < 32; x++) {
                const auto d = [&](int i, int j) { return double(t.c[c].at(i, j)) - double(r.c[c].at(i, j)); };
                mirrored += d(x, y) * d((32 - x) % 32, (16 - y) % 16) / (3 * 32 * 16);
            }
    EXPECT_NEAR(fourierError(t, r, {}).fmseThesis, mirrored, 1e-9);
}
// By hand, four pixels in a row (conventions 13.3 and [Stejmar n.d., eq 4.3] as printed). A lone 1 at x has the
// transform
// (-i)^(k x): magnitude 1 everywhere.
TEST(Fourier, FourPixelsByHand) {
    const auto lone = [](int at) {
        Rgb row(4, 1, 0.0f);
        for (auto& p : row.c)
            if (at >= 0) p.at(at, 0) = 1;
        return row;
    };
    // Against black, D = 1, -i, -1, i: magnitudes 4 over 16, squares without modulus 1 - 1 + 1 - 1.
    const FourierError black = fourierError(lone(1), lone(-1), {});
    EXPECT_NEAR(black.fmse, 0.25, 1e-12);
    EXPECT_NEAR(black.fmagMse, 0.25, 1e-12);
    EXPECT_NEAR(black.fmseThesis, 0, 1e-12);
    // Against a lone 1 at 0, D = 0, -1 - i, -2, -1 + i: magnitudes are equal; |D|^2 = 0 + 2 + 4 + 2 and
    // Re D^2 = 0 + 0 + 4 + 0.
    const FourierError moved = fourierError(lone(1), lone(0), {});
    EXPECT_NEAR(moved.fmse, 0.5, 1e-12);
    EXPECT_NEAR(moved.fmagMse, 0, 1e-12);
    EXPECT_NEAR(moved.fmseThesis, 0.25, 1e-12);
    // 1 cycle per 4 px is the third band, 1/2 the last.
    EXPECT_NEAR(moved.fband[2], 4.0 / 16, 1e-12);
    EXPECT_NEAR(moved.fband[3], 4.0 / 16, 1e-12);
    // fmagMse is named in `--metrics` and measured with that value.
    const Rgb test = lone(1), reference = lone(-1);
    const FigureChoice choice = findFigure("fmagMse");
    FrameMetrics m;
    addFigures(m, *choice.metric, {test, reference}, {});
    EXPECT_NEAR(*m.figure("fmagMse"), 0.25, 1e-12);
}
TEST(Fourier, IdenticalIsZero) {
    const Rgb a = noisePicture(20, 10, 6);
    EXPECT_NEAR(fourierError(a, a, {}).fmse, 0, 1e-30);
}
}  // namespace
}  // namespace aa
