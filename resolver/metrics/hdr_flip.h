// HDR-FLIP [Andersson 2021]: FLIP of linear light at the exposures through which a viewer would look at it, per pixel
// the largest. The exposures go, in steps of about one stop, from where the reference's brightest pixel to where its
// median is tone-mapped to 0.85; the tone map is the ACES fit [Narkowicz 2016] with its exposure of 0.6.
//
// Ours: luminance that is not finite is left out; where the median is 0, the least luminance above 0 takes its place; a
// black reference is looked at as it is; more than 20 stops below the brightest are not looked at.
#pragma once
#include "metrics/metric.h"

namespace aa {

// Binary logarithms of what light is multiplied by.
struct ExposureRange {
    double start = 0, stop = 0;
    int count = 1;
    double at(int i) const { return count == 1 ? start : start + (stop - start) * i / (count - 1); }
};
ExposureRange exposureRange(const Rgb& referenceLinear);
// Mean over the pixels, in [0,1]; the map when `map` is given.
double hdrFlip(const Rgb& testLinear, const Rgb& referenceLinear, const Exec& exec, PlaneF* map = nullptr,
               double pixelsPerDegree = kFlipPixelsPerDegree);

Metric hdrFlipMetric();

}  // namespace aa
