// ColorVideoVDP [Mantiuk 2024]: how much worse than the reference a viewer finds a picture or a sequence on a given
// display, in just-objectionable differences (JOD): 10 is no difference, one less means that 75 of 100 viewers prefer
// the reference, 2 less that 91 do.
//
//   light:       pixel values -> light of the display (display_model.h) -> opponent colours (DKL, D65)
//   time:        filters of a quarter of a second: achromatic sustained, red-green, yellow-violet, achromatic transient
//   space:       Laplacian pyramid down to 0.2 cycles per degree; contrast = band over the local mean of luminance
//   sensitivity: castleCSF of the reference's luminance, by frequency and channel
//   masking:     |T' - R'|^p / (1 + sum over channels of w blur(min(|T'|, |R'|))^q), saturating
//   pooling:     rms over pixels, 4-norm over bands and channels, rms over frames, then to JOD
//
// Before the first frame, the first one is taken to have stood still. The filters are symmetric and look back, so that
// a frame's own value shows best what was on the display half a filter before (an eighth of a second).
//
// As in the authors' program, also where that departs from the paper's text: x^p is (x + 1e-5)^p - 1e-5^p; the last
// column of a level is weighted by the parity of its height (cvvdp.kernel.cpp). Values agree with it to 0.01 JOD
// (docs/metrics.md). Ours: a picture less than 4 px high or wide is one band.
#pragma once
#include "metrics/metric.h"
#include "metrics/sequence.h"

namespace aa {

// The figures' order: JOD of all, then JOD that would be left if the pictures differed in one channel alone.
std::unique_ptr<SequenceReference> cvvdp(const SequenceSetting& setting);
// Two pictures, looked at as long as one wants.
double cvvdpOfStill(const Rgb& test, const Rgb& reference, const DisplayModel& display, const Exec& exec,
                    PlaneF* map = nullptr);
Metric cvvdpMetric();

}  // namespace aa
