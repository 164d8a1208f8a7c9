// LDR-FLIP [Andersson 2020]: the difference that a viewer sees when flipping between two images, usually at 67 pixels
// per degree (0.7 m from a 0.7 m wide monitor of 3840 px).
//
//   colour:  opponent space, blurred by the eye's contrast sensitivity, CIELab with Hunt's adjustment, HyAB distance
//   feature: differences of edges and points of the unblurred luminance
//   FLIP   = colour^(1 - feature)
//
// All filters are separable (the blue-yellow one is a sum of two), which is exact.
#pragma once
#include <memory>
#include <vector>

#include "metrics/metric.h"

namespace aa {

struct FlipFilters;
// What is seen of a reference: half of the work, done once for all pictures that are held against it. 20 bytes a pixel.
class FlipReference {
  public:
    enum class Values { encoded, light };  // as flip() and flipOfLight() take them
    FlipReference(const Rgb& reference, Values values, const Exec& exec, double pixelsPerDegree = kFlipPixelsPerDegree);
    ~FlipReference();
    // Mean over the pixels; the map when `map` is given. `exec` of the precision that the reference was seen in.
    double flip(const Rgb& test, const Exec& exec, PlaneF* map = nullptr) const;

  private:
    int width_, height_;
    Values values_;
    Precision precision_;
    std::unique_ptr<const FlipFilters> filters_;  // null: those at the usual distance
    std::vector<float, PlaneAllocator<float>> seen_;
};

// Encoded images in [0,1]; values outside count as 0 or 1, NaN as 0. They are taken as sRGB codes whatever the transfer
// of the run: with the identity transfer, too, a screen gets the displayed values as its codes. Mean over the pixels,
// in [0,1]; the map when `map` is given.
double flip(const Rgb& test, const Rgb& reference, const Exec& exec, PlaneF* map = nullptr,
            double pixelsPerDegree = kFlipPixelsPerDegree);
// The same of light that a display gives off, in [0,1].
double flipOfLight(const Rgb& test, const Rgb& reference, const Exec& exec, PlaneF* map = nullptr,
                   double pixelsPerDegree = kFlipPixelsPerDegree);

// Pooled values of a map: quartiles weighted by the error itself, as the reference implementation prints them.
struct FlipStatistics {
    double mean = 0, firstQuartile = 0, median = 0, thirdQuartile = 0, max = 0;
};
FlipStatistics flipStatistics(const PlaneF& map);

Metric flipMetric();

}  // namespace aa
