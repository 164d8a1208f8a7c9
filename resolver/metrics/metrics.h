// Full-reference image metrics (methods/07). Sums are double, over fixed row blocks in a fixed order, so that the
// result does not depend on the number of threads.
#pragma once
#include "image/plane.h"
#include "kernels/dispatch.h"

namespace aa {

// Mean over pixels and channels of (T - R)^2 and of R^2: what PSNR and SNR need, poolable over frames.
struct SquaredError {
    double mse = 0;        // mean squared error
    double reference = 0;  // mean of R^2
};
SquaredError squaredError(const Rgb& test, const Rgb& reference, const Exec& exec);
double psnr(double mse, double peak = 1.0);  // dB; +Inf for mse = 0
double snr(const SquaredError& error);       // dB; +Inf for mse = 0, -Inf for an all-zero reference
// mean((T-R)^2 / (R^2 + 0.01)), linear light (methods/07 s.8).
double relMse(const Rgb& test, const Rgb& reference, const Exec& exec);

// SSIM of BT.601 luma of encoded images: 11x11 Gaussian, sigma 1.5, replicated border, variances about the local mean
// (methods/07 s.2). Returns the mean; writes the per-pixel map when `map` is given.
double ssimLuma(const Rgb& test, const Rgb& reference, const Exec& exec, PlaneF* map = nullptr);
// Mean of the per-channel SSIMs.
double ssimRgb(const Rgb& test, const Rgb& reference, const Exec& exec);

}  // namespace aa
