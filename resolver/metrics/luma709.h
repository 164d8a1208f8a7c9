// PSNR and SSIM of BT.709 luma, 0.2126 R' + 0.7152 G' + 0.0722 B' of encoded values: what tools for video print.
#pragma once
#include "metrics/metrics.h"

namespace aa {

struct Luma709 {
    double mse = 0, ssim = 0;
};
Luma709 luma709(const Rgb& test, const Rgb& reference, const Exec& exec);

struct Metric;
Metric luma709Metric();

}  // namespace aa
