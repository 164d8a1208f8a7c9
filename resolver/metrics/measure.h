// All figures of one frame in one call: what the runner and `compare` need.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "image/colour.h"
#include "metrics/figures.h"
#include "metrics/metric.h"

namespace aa {

// Of encoded values (primary, conventions 13.8) but for metrics of linear light, which methods with encoded output
// lack.
struct FrameMetrics {
    double mse = 0, reference = 0;  // mean of (T-R)^2 and of R^2
    double psnr = 0, snr = 0;       // dB
    FigureValues others;            // that are not of squared error
    SquaredError squares() const { return {mse, reference}; }
    std::optional<double> figure(std::string_view name) const;  // any figure; nothing where it was not measured
};
FrameMetrics frameMetrics(const SquaredError& squares);
// Measures what is not of squared error and adds it. The images must be those that the metric asks for (isPossible).
// `prepared`: metric.against() the reference, where somebody has it already.
void addFigures(FrameMetrics& to, const Metric& metric, const ImagePair& images, const Exec& exec,
                const Measure* prepared = nullptr);

// Of means over frames: figures that follow from others' means (Figure::ofMeans).
void deriveFromMeans(FrameMetrics& means);

// The ground truth of one frame, prepared once for all methods.
struct Reference {
    Rgb linear, encoded;  // mean of the halves, and its display encoding; one and the same with the identity transfer
    Rgb broken = {};      // what was encoded, where that holds values that are no numbers; otherwise empty
    double noise = 0;     // MSE(encoded a, encoded b) / 4, not rounded
    Rgb encodedA, encodedB;    // the halves as they are compared; empty where they are equal
    size_t clippedPixels = 0;  // of which the mean exceeds what the display shows (counted with the identity transfer)
    // What prepare() found, which all pictures that are held against it share.
    std::optional<double> sumOfSquares = {};  // of `encoded`
    std::map<const Metric*, Measure> prepared = {};
};
// Rounded to 8-bit codes: `encoded` alone.
Reference makeReference(const Rgb& halfA, const Rgb& halfB, const DisplayChain& display, const Exec& exec,
                        bool eightBit = false);

// Squared errors against the truth, and against its halves where they differ; some rows at a time, from any thread. The
// pictures must outlive it.
class ReferenceErrors {
  public:
    ReferenceErrors(const Rgb& encoded, const Reference& reference, const Exec& exec);
    void add(int y0, int y1);
    TileErrors total() const;  // of all rows

  private:
    const Reference& reference_;
    std::vector<TileErrorRows> against_;  // the mean, half A, half B
};
TileErrors tileErrors(const Rgb& encoded, const Reference& reference, const Exec& exec);

struct MeasureOptions {
    std::vector<const Metric*> metrics;  // beside those that every run has
    // Of the frames that are judged alone: those that a run measures without being asked.
    std::vector<const Metric*> ofJudged = {};
    Viewing viewing = {};  // of metrics of a sequence
    double flipPixelsPerDegree = kFlipPixelsPerDegree;
};
// The metrics that a run measures by default and that `asked` does not name; none where they would take more than
// kDefaultSeconds on one processor. `pixels`: of all frames that are judged, times the methods.
inline constexpr double kDefaultSeconds = 20;
struct DefaultMetrics {
    std::vector<const Metric*> metrics;
    double seconds = 0;  // about
    bool fit() const { return seconds <= kDefaultSeconds; }
};
DefaultMetrics defaultMetrics(const MeasureOptions& asked, double pixels);
// Of the names in `--metrics`. Throws UsageError.
MeasureOptions measureOptions(const std::vector<std::string>& names);
// `judged`: whether the frame counts in the pooled figures (MeasureOptions::ofJudged).
void prepare(Reference& reference, const MeasureOptions& options, const Exec& exec, bool judged = true);
struct MeasuredPicture {
    const Rgb& encoded;           // after the display chain
    const Rgb* linear = nullptr;  // null when the method gives encoded colour
    // Where somebody has them already: pictureLuma(encoded), tileErrors(encoded, reference).
    const PlaneF* luma = nullptr;
    const TileErrors* errors = nullptr;
};
// The tile errors of the encoded image are added to `pool`.
FrameMetrics measure(const MeasuredPicture& picture, const Reference& reference, const MeasureOptions& options,
                     const Exec& exec, TileErrors& pool, bool judged = true);

}  // namespace aa
