// One row per metric: what `--metrics` names, results hold, tables show and reports explain. A new metric is one pair
// of files (x.h, x.cpp: its function and its Metric) and one line in metrics/registry.cpp.
#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "metrics/metrics.h"
#include "metrics/sequence.h"

namespace aa {

enum class FigureForm { significant, decibels, similarity, jod };  // how it is written (report/format.h)
enum class ColourSpace { encoded, linear };                        // display-encoded values in [0,1], or linear light

struct FrameMetrics;

// A number that a metric gives.
struct Figure {
    std::string_view name;   // in JSON, in CSV and on the command line
    std::string_view title;  // head of a column
    std::string_view help;   // one line
    FigureForm form = FigureForm::significant;
    bool higherIsBetter = false;
    // Of squared error: pooled over frames it comes from the mean squares, so that a PSNR is never a mean of decibels.
    // Null: the mean over the frames.
    double (*ofSquares)(const SquaredError&) = nullptr;
    // Pooled from other figures' means over the frames instead of its own: decibels of a mean, never a mean of
    // decibels.
    double (*ofMeans)(const FrameMetrics&) = nullptr;
    std::string_view spreadOf = {};  // the figure beside which it is shown, whose spread over the picture it tells
};

// Where FLIP looks from: 0.7 m from a 0.7 m wide monitor of 3840 px, 3840 pi / 180; and what it can be told.
inline constexpr double kFlipPixelsPerDegree = 67.020643276582;
inline constexpr double kLeastFlipPixelsPerDegree = 5, kMostFlipPixelsPerDegree = 177;

// Images of one size with filled borders. The linear ones are null where there is no linear light: 8-bit files, methods
// that give encoded colour.
struct ReferencePicture {
    const Rgb& encoded;
    const Rgb* linear = nullptr;
    double flipPixelsPerDegree = kFlipPixelsPerDegree;
};
struct ImagePair {
    const Rgb& testEncoded;
    const Rgb& referenceEncoded;
    const Rgb* testLinear = nullptr;
    const Rgb* referenceLinear = nullptr;
    double flipPixelsPerDegree = kFlipPixelsPerDegree;
    const PlaneF* testLuma = nullptr;  // pictureLuma() of testEncoded, where somebody has it already
    ReferencePicture reference() const { return {referenceEncoded, referenceLinear, flipPixelsPerDegree}; }
};
// One value per figure, of one frame.
using Measure = std::function<std::vector<double>(const ImagePair&, const Exec&)>;

struct Metric {
    std::vector<Figure> figures;
    ColourSpace space = ColourSpace::encoded;
    bool always = false;     // in every run; others when they are asked for
    bool byDefault = false;  // without being asked for, too, where a run has the time
    int nsPerPixel = 0;      // about, on one AVX2 core: what asking for it costs
    std::string_view source;
    // Empty where every figure is of squared error, which is always there.
    Measure measure = {};
    // Instead of it: what the reference alone decides is computed here, once for all pictures that are held against it.
    // The Measure keeps of the reference what it needs, and takes pairs with it in the precision that `exec` has here.
    // Several threads may call it.
    std::function<Measure(const ReferencePicture&, const Exec&)> prepare = {};
    // Of a sequence: its frames are watched in order, and its figures are those of all of them together instead of
    // means.
    std::function<std::unique_ptr<SequenceReference>(const SequenceSetting&)> watch = {};
    Measure against(const ReferencePicture& reference, const Exec& exec) const {
        return prepare ? prepare(reference, exec) : measure;
    }
    bool isPossible(const ImagePair& images) const {
        return space == ColourSpace::encoded || (images.testLinear && images.referenceLinear);
    }
};

// All of them, in the order of tables.
const std::vector<Metric>& metrics();

struct FigureChoice {
    const Metric* metric = nullptr;
    const Figure* figure = nullptr;
};
// "ssim" is ssimLuma. Throws UsageError: unknown, with a suggestion.
FigureChoice findFigure(std::string_view name);
const Figure* figureByName(std::string_view name);  // null: no such figure
// For help: "\n  name  explanation" of every figure, or of those that not every run has.
std::string listOfFigures(bool optionalAlone = false);

}  // namespace aa
