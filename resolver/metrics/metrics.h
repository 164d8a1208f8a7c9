// Full-reference image metrics (conventions 13). Both images have the same size; borders need not be filled.
//
// Sums are double, over fixed blocks in a fixed order, so that a figure depends neither on the number of threads nor on
// the instruction set. NaN in an image gives a NaN figure: nothing is skipped. (The display encoding maps NaN to 0, so
// encoded images hold none.)
#pragma once
#include <optional>
#include <vector>

#include "image/plane.h"
#include "kernels/dispatch.h"

namespace aa {

// Mean over pixels and channels of (T - R)^2 and of R^2: what PSNR and SNR need, poolable over frames.
struct SquaredError {
    double mse = 0;        // mean squared error
    double reference = 0;  // mean of R^2
};
SquaredError squaredError(const Rgb& test, const Rgb& reference, const Exec& exec);
double rmse(double mse);
double psnr(double mse, double peak = 1.0);  // dB; +Inf for mse = 0
double snr(const SquaredError& error);       // dB; +Inf for mse = 0, -Inf for an all-zero reference
// mean((T-R)^2 / (R^2 + 0.01)), linear light (conventions 13.8).
double relMse(const Rgb& test, const Rgb& reference, const Exec& exec);

// Sums of squared error over tiles of 8 x 8 px, row-major, over pixels and channels: what intervals are made of
// (metrics/error_bar.h). Frames of one sequence are added tile by tile, so that memory does not grow with their number.
struct TileErrors {
    static constexpr int kTilePx = 8;
    size_t columns = 0;          // tiles in a row of the image; 0: all tiles lie in one row
    std::vector<double> sum;     // of (T - R)^2
    std::vector<double> values;  // how many pixel channels each tile holds
    // The same against either half of the truth alone; empty where its halves are equal, so that it is exact.
    std::vector<double> againstA, againstB;
    double referenceSum = 0;  // of R^2, over the image

    double totalSum() const;
    double totalValues() const;
    SquaredError squaredError() const { return {totalSum() / totalValues(), referenceSum / totalValues()}; }
    TileErrors& operator+=(const TileErrors& frame);  // same tiles, or *this still empty
    // Sums over tiles of `tiles` times the side.
    std::vector<double> coarse(size_t tiles) const;
};
// The same, some rows at a time, from any thread. The pictures must outlive it.
class TileErrorRows {
  public:
    TileErrorRows(const Rgb& test, const Rgb& reference, const Exec& exec);
    void add(int y0, int y1);
    TileErrors total(std::optional<double> squares) const;  // of all rows

  private:
    const Rgb &test_, &reference_;
    Exec exec_;
    size_t tilesX_;
    std::vector<double> rows_;  // [height][tilesX_]: of one row of each tile
};
// `squares`: sumOfSquares(reference), where it is known.
TileErrors tileErrors(const Rgb& test, const Rgb& reference, const Exec& exec, std::optional<double> squares = {});
double sumOfSquares(const Rgb& image, const Exec& exec);  // over pixels and channels

// BT.601, of encoded images. Border filled.
PlaneF pictureLuma(const Rgb& encoded, const Exec& exec);
// Rows [y0, y1) of it, into a plane of that size; the border is left.
void pictureLumaRows(const Rgb& encoded, const Exec& exec, int y0, int y1, PlaneF& luma);
// Where somebody has it already.
struct KnownLuma {
    const PlaneF *test = nullptr, *reference = nullptr;
};

// SSIM of encoded images: 11x11 Gaussian, sigma 1.5, replicated border, variances about the local mean
// (conventions 13.2). Each returns the mean over all pixels and writes the per-pixel map when `map` is given.
double ssimLuma(const Rgb& test, const Rgb& reference, const Exec& exec, PlaneF* map = nullptr, KnownLuma known = {});
// Of luma, over the windows that lie within the picture: the border is not extended, 5 px around it are left out. In a
// picture that holds none, over all pixels.
double ssimValid(const Rgb& test, const Rgb& reference, const Exec& exec, PlaneF* map = nullptr, KnownLuma known = {});
double ssimRgb(const Rgb& test, const Rgb& reference, const Exec& exec, PlaneF* map = nullptr);  // mean over channels
// As MATLAB treats an M x N x 3 array: a volume, filtered across the channels too (replicated). For comparison only.
double ssimMatlab3D(const Rgb& test, const Rgb& reference, const Exec& exec, PlaneF* map = nullptr);

// How `--metrics` names them (metrics/metric.h).
struct Metric;
Metric squaredErrorMetric();
Metric relMseMetric();
Metric ssimLumaMetric();
Metric ssimValidMetric();
Metric ssimRgbMetric();
Metric ssimMatlab3DMetric();

// floor(255 x + 0.5) / 255: what an 8-bit image file keeps. Border filled.
void quantise8(Rgb& encoded, const Exec& exec);
// floor(255 x + u) / 255 with u even in [0, 1), by place, channel and frame number: the mean over places or frames is
// x, so that slow gradients show noise and no steps. A whole code stays. Border filled.
void dither8(Rgb& encoded, int frame, const Exec& exec);

}  // namespace aa
