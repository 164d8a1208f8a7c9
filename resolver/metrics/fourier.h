// Errors by spatial frequency (conventions 13.3): tells blur (high bands lost) from aliasing (low bands polluted).
#pragma once
#include <array>
#include <complex>
#include <span>
#include <vector>

#include "metrics/metrics.h"

namespace aa {

// F are unnormalised discrete Fourier transforms; each figure is the mean over the three channels.
struct FourierError {
    double fmse = 0;        // sum |F_T - F_R|^2 / (W H)^2: equals the MSE (Parseval)
    double fmagMse = 0;     // sum (|F_T| - |F_R|)^2 / (W H)^2: blind to phase
    double fmseThesis = 0;  // Re sum (F_T - F_R)^2 / (W H)^2, as [Stejmar n.d., eq 4.3] is printed; can be negative
    std::array<double, 4> fband{};  // fmse by radial frequency, cycles/px: [0,1/8) [1/8,1/4) [1/4,1/2) [1/2,0.71]
};
FourierError fourierError(const Rgb& test, const Rgb& reference, const Exec& exec);

// Where in the spectrum they differ: |F_T - F_R| / sqrt(W H), root mean square over the channels, frequency 0 at
// (W / 2, H / 2), rounded down. Its root mean square over the frequencies is that of T - R over the pixels.
PlaneF fourierDifference(const Rgb& test, const Rgb& reference, const Exec& exec);

struct Metric;
Metric fourierMetric();

// Discrete Fourier transform of any length, mixed radix over its prime factors; a plan serves many rows.
class Fft {
  public:
    explicit Fft(size_t length);
    size_t length() const { return length_; }
    // X[k] = sum_n x[n] exp(-2 pi i k n / length); `out` must not overlap `in`.
    void transform(std::span<const std::complex<double>> in, std::span<std::complex<double>> out) const;

  private:
    void level(const std::complex<double>* in, size_t stride, size_t length, std::complex<double>* out) const;
    size_t length_;
    std::vector<std::complex<double>> roots_;  // exp(-2 pi i k / length)
};

}  // namespace aa
