// What few codes do to slow gradients: steps that the eye follows over many pixels (banding), or noise (grain).
//
//   e        = T - R, in 8-bit codes
//   banding  = RMS of e blurred by a Gaussian of sigma 4 px
//   grain    = RMS of what the blur takes away
//
// over the pixels and channels where R is a slow gradient: over the 25 x 25 px around, which must lie in the picture
// and are what the blur reads, its values span 0.5 to 4 codes. Even parts have no steps, and steps of steep parts lie
// too near to each other to be seen as such; edges fall out with them. Rounding leaves 0.29 codes of banding where its
// steps are wide; dithering leaves 0.41 of grain. R must not be rounded itself. Own definition: decisions 54.
#pragma once
#include "metrics/metrics.h"

namespace aa {

struct Banding {
    double banding = 0, grain = 0;  // 8-bit codes; 0 where nothing is a slow gradient
    double share = 0;               // of the pixels and channels that were looked at
};
// Encoded images with values in [0,1].
Banding banding(const Rgb& test, const Rgb& reference, const Exec& exec);

struct Metric;
Metric bandingMetric();

}  // namespace aa
