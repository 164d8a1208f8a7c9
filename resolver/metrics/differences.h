// Plain differences that tables elsewhere print.
//  mae        mean of |T - R| over pixels and channels, encoded values
//  mseLinear  mean of (T - R)^2 of linear light: bright pixels decide it (relMse divides by their own light)
//  snrAc      dB of the reference's contrast over the error: 10 log10(acPower / MSE). acPower is the mean of R^2 less
//  each
//             channel's squared mean, so that a bright but flat picture counts as no signal; `snr` counts its mean
#pragma once
#include "metrics/metrics.h"

namespace aa {

double meanAbsoluteError(const Rgb& test, const Rgb& reference, const Exec& exec);
double contrastPower(const Rgb& reference, const Exec& exec);

struct Metric;
Metric absoluteMetric();
Metric linearMseMetric();
Metric contrastSnrMetric();

}  // namespace aa
