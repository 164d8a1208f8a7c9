#include "metrics/fourier.h"

#include <cassert>
#include <cmath>
#include <numbers>

#include "metrics/metric.h"

namespace aa {
namespace {
using Complex = std::complex<double>;

size_t smallestFactor(size_t n) {
    for (size_t p = 2; p * p <= n; p++)
        if (n % p == 0) return p;
    return n;
}

// Both images in one transform: z = T + i R, so that F_T = (Z(k) + conj Z(-k)) / 2 and F_R = (Z(k) - conj Z(-k)) / 2i.
std::vector<Complex> transformPair(const PlaneF& t, const PlaneF& r, const Exec& exec) {
    const size_t w = size_t(t.width()), h = size_t(t.height());
    std::vector<Complex> spectrum(w * h);
    const Fft alongX(w), alongY(h);
    forRows(exec, int(h), [&](int y0, int y1) {
        std::vector<Complex> line(w);
        for (int y = y0; y < y1; y++) {
            for (size_t x = 0; x < w; x++) line[x] = {double(t.row(y)[x]), double(r.row(y)[x])};
            alongX.transform(line, std::span(spectrum).subspan(size_t(y) * w, w));
        }
    });
    forRows(exec, int(w), [&](int x0, int x1) {
        std::vector<Complex> line(h), out(h);
        for (size_t x = size_t(x0); x < size_t(x1); x++) {
            for (size_t y = 0; y < h; y++) line[y] = spectrum[y * w + x];
            alongY.transform(line, out);
            for (size_t y = 0; y < h; y++) spectrum[y * w + x] = out[y];
        }
    });
    return spectrum;
}
size_t band(size_t u, size_t v, size_t w, size_t h) {
    const double fx = double(std::min(u, w - u)) / double(w), fy = double(std::min(v, h - v)) / double(h);
    const double f = std::sqrt(fx * fx + fy * fy);
    return f < 0.125 ? 0 : f < 0.25 ? 1 : f < 0.5 ? 2 : 3;
}
}  // namespace

Fft::Fft(size_t length) : length_(length), roots_(length) {
    for (size_t k = 0; k < length; k++) {
        const double angle = -2 * std::numbers::pi * double(k) / double(length);
        roots_[k] = {std::cos(angle), std::sin(angle)};
    }
}
void Fft::transform(std::span<const Complex> in, std::span<Complex> out) const {
    assert(in.size() == length_ && out.size() == length_);
    level(in.data(), 1, length_, out.data());
}
// Decimation in time: p interleaved transforms of length / p, joined by p-point transforms (p prime, done directly).
void Fft::level(const Complex* in, size_t stride, size_t length, Complex* out) const {
    if (length == 1) {
        *out = *in;
        return;
    }
    const size_t p = smallestFactor(length), part = length / p, turn = length_ / length;
    for (size_t r = 0; r < p; r++) level(in + r * stride, stride * p, part, out + r * part);
    std::vector<Complex> taps(p);
    for (size_t k = 0; k < part; k++) {
        for (size_t r = 0; r < p; r++) taps[r] = out[r * part + k] * roots_[turn * r * k];
        if (p == 2) {
            out[k] = taps[0] + taps[1];
            out[k + part] = taps[0] - taps[1];
            continue;
        }
        for (size_t q = 0; q < p; q++) {
            Complex sum = taps[0];
            for (size_t r = 1; r < p; r++) sum += taps[r] * roots_[length_ / p * (q * r % p)];
            out[k + q * part] = sum;
        }
    }
}

FourierError fourierError(const Rgb& test, const Rgb& reference, const Exec& exec) {
    assert(test.width() == reference.width() && test.height() == reference.height());
    const size_t w = size_t(test.width()), h = size_t(test.height());
    const double scale = 1 / (3 * double(w * h) * double(w * h));
    FourierError e;
    for (size_t c = 0; c < 3; c++) {
        const auto z = transformPair(test.c[c], reference.c[c], exec);
        for (size_t v = 0; v < h; v++)
            for (size_t u = 0; u < w; u++) {
                const Complex a = z[v * w + u], b = std::conj(z[(h - v) % h * w + (w - u) % w]);
                const Complex t = (a + b) * 0.5, r = (a - b) * Complex(0, -0.5), d = t - r;
                const double squared = std::norm(d), magnitudes = std::abs(t) - std::abs(r);
                e.fband[band(u, v, w, h)] += squared * scale;
                e.fmagMse += magnitudes * magnitudes * scale;
                e.fmseThesis += (d * d).real() * scale;
            }
    }
    e.fmse = e.fband[0] + e.fband[1] + e.fband[2] + e.fband[3];
    return e;
}

PlaneF fourierDifference(const Rgb& test, const Rgb& reference, const Exec& exec) {
    assert(test.width() == reference.width() && test.height() == reference.height());
    const int w = test.width(), h = test.height();
    std::vector<double> squares(size_t(w) * size_t(h));
    for (size_t c = 0; c < 3; c++) {
        // The difference alone: its transform is that of the real part.
        PlaneF difference(w, h), none(w, h);
        for (int y = 0; y < h; y++)
            for (int x = 0; x < w; x++) difference.at(x, y) = test.c[c].at(x, y) - reference.c[c].at(x, y);
        const auto spectrum = transformPair(difference, none, exec);
        for (size_t i = 0; i < squares.size(); i++) squares[i] += std::norm(spectrum[i]) / (3.0 * w * h);
    }
    PlaneF map(w, h);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            map.at((x + w / 2) % w, (y + h / 2) % h) = float(std::sqrt(squares[size_t(y) * size_t(w) + size_t(x)]));
    map.fillBorder();
    return map;
}

Metric fourierMetric() {
    return {.figures = {{"fmagMse", "Fourier MSE", "Fourier magnitudes, blind to phase"},
                        {"fband0", "MSE <1/8", "MSE at 0 to 1/8 cycles/px"},
                        {"fband1", "MSE <1/4", "MSE at 1/8 to 1/4"},
                        {"fband2", "MSE <1/2", "MSE at 1/4 to 1/2"},
                        {"fband3", "MSE >1/2", "MSE at 1/2 and above"}},
            .nsPerPixel = 700,
            .source = "conventions 13.3",
            .measure = [](const ImagePair& i, const Exec& exec) {
                const FourierError e = fourierError(i.testEncoded, i.referenceEncoded, exec);
                return std::vector{e.fmagMse, e.fband[0], e.fband[1], e.fband[2], e.fband[3]};
            }};
}

}  // namespace aa
