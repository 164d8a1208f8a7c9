// What a run found, and its two files: results.json (everything, read back by `sheet` and `report`) and results.csv
// (one line per method and frame). Keys are those of conventions 13. JSON has no infinity: it is written as the string
// "Inf".
#pragma once
#include <filesystem>
#include <iosfwd>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "metrics/error_bar.h"
#include "metrics/measure.h"
#include "metrics/temporal.h"
#include "study/protocol.h"
#include "study/provenance.h"

namespace aa {

inline constexpr size_t kResultTilePx = 32;

struct FrameResult {
    int frame = 0;
    double seconds = 0;                       // of processor time, of all threads; 0: it did not run there
    std::optional<FrameMetrics> metrics;      // only when the frame has ground truth
    bool judged = true;                       // counts in the pooled figures; of a static shot only the last frame does
    std::string image;                        // relative path of the written image; empty when none was
    std::optional<TemporalFrame> temporal{};  // of a sequence, after the warm-up
    // Squared error where this method, or the one that it fills, rejected its history; not of a frame without history.
    std::optional<FrameSum> rejected{};
    double wallSeconds = 0;
    // Values of the method's picture, or of the truth where this one has numbers, that are none: they count as the
    // largest difference that the display allows, and linear figures are NaN.
    uint64_t nonFinite = 0;
    std::optional<double> deviceSeconds{};  // on RunResults::device, by its own clock
};

// Figures over the judged frames that have truth: means over the frames, but those of squared error, which come from
// the mean squares (metrics/metric.h).
struct PooledMetrics {
    int frames = 0;
    FrameMetrics mean;
    MseInterval mseInterval;       // the truth's noise taken off, and as measured
    double meanFinitePsnr = 0;     // over the frames whose PSNR is finite
    int infinitePsnrFrames = 0;    // frames identical to their truth
    std::optional<double> gainDb;  // PSNR over that of noaa in the same run
};

struct MethodResult {
    std::string id, text, title, family, source;  // text: as written, smaa1x:preset=HIGH
    std::string folder;                           // below the run's folder
    std::string sampling;                         // where its input was sampled: "jittered" or "centre"
    std::map<std::string, std::string, std::less<>> parameters;
    std::vector<std::string> passes;
    std::vector<FrameResult> frames;
    std::vector<double> moreSeconds;  // of frames resolved again for the time alone, where the frames are few
    // Memory in the program's own formats (conventions 13.7): the passes that it reads, sub-samples counted; the
    // picture that it writes; its history and scratch.
    size_t inputBytes = 0, targetBytes = 0, stateBytes = 0;
    size_t bytes() const { return inputBytes + targetBytes + stateBytes; }
    // Filled by finish():
    // Processor time of a frame, over `timings` of them; ns/px from the median. 0: the method did not run there.
    double secondsMedian = 0, secondsMin = 0, nsPerPixel = 0;
    double secondsLow = 0, secondsHigh = 0;  // quartiles; those of few timings are the least and the most
    int timings = 0;
    double wallMedian = 0;  // by the clock, with the run's threads, on which other methods work beside it
    std::optional<double> deviceSecondsMedian, deviceSecondsMin;
    std::optional<PooledMetrics> pooled;
    std::vector<double> tileSquares;  // sums of squared error of tiles of kResultTilePx squared
    std::vector<ErrorParts> parts;    // from which methods are compared, within a run and between runs of one shot
    std::optional<TemporalMetrics> temporal;              // of a sequence
    std::map<std::string, double, std::less<>> sequence;  // figures of metrics that watch it, over all its frames
    // Over the frames that have FrameResult::rejected; absent when no history was rejected.
    std::optional<double> rejectedMse, rejectedShare;
};

// A figure over the judged frames, as [Oliveros 2018, 5.9] prints it: the frames are those where the best and the worst
// first occur. The mean of an infinite PSNR is infinite, which is why the pooled figure stands beside it.
struct FigureRange {
    double best = 0, worst = 0, mean = 0;
    int bestFrame = 0, worstFrame = 0;
};
// Nothing where it was not measured.
std::optional<FigureRange> rangeOverFrames(const MethodResult& method, const Figure& figure);

// A pair of methods, as indices into RunResults::methods.
struct PairResult {
    size_t first = 0, second = 0;
    Comparison comparison;
    // Of ghostMse, of the square of flicker, and of rejectedMse (only where both were judged on the same pixels).
    std::optional<TimeComparison> ghost{}, flicker{}, rejected{};
};

// Pixels in which the mean of the halves exceeds the display, so that it is clipped, of all truth pixels. The protocol
// of [Oliveros 2018] clamps every sample, which a mean cannot make up for.
struct ClippedPixels {
    size_t pixels = 0, of = 0;
};

// What else the machine did while the methods were timed. Processor time is spared the worst of it, not shared caches,
// memory and clock rates.
struct MachineLoad {
    double before = 0;   // programs that wanted a processor in the minute before the run
    int processors = 1;  // of the machine
    std::optional<double>
        waited{};  // share of the methods' time by the clock that they had no processor; of one thread
    bool busy() const { return before > 0.5 * processors || waited.value_or(0) > 0.1; }
};

// The graphics device on which the methods ran, or which was timed beside the processor.
struct RunDevice {
    std::string name, kind, driver;  // kind: discrete, integrated, virtual, cpu (software), other
    std::string precision;           // exact, fast
    bool judged = false;             // the judged images are the device's, not the processor's
    bool isSoftware() const { return kind == "cpu"; }
};

// The display and the frame rate of metrics that watch a sequence.
struct ShownOn {
    std::string display;  // a name of metrics/display_model.h
    std::string words;    // what it is
    double pixelsPerDegree = 0, framesPerSecond = 0;
};

struct RunResults {
    // The shot
    std::string shot;      // its name
    std::string shotHash;  // of the frames of this run (study/provenance.h); empty in results of older programs
    int width = 0, height = 0;
    bool isStatic = false;
    std::string jitterSequence = "none";
    int jitterStart = 0, jitterPeriod = 1;
    double jitterMeanPx[2] = {0, 0};  // over one period; a block is centred when it is zero
    int subSamples = 0;               // per pixel; 0 when the shot has none
    // The truth
    int truthSamplesPerHalf = 0;
    std::string truthFilter;
    double truthFilterWidthPx = 1;
    std::optional<double> truthNoise;           // MSE(a, b) / 4, encoded, mean over the frames with truth
    std::map<int, std::string> truthImages;     // frame -> relative path; of a reference method its own images
    std::optional<ClippedPixels> truthClipped;  // only with the identity transfer
    // The run
    Provenance provenance;
    bool complete = true;    // false: it was interrupted, and its figures are of fewer frames than it was asked for
    size_t framesAsked = 0;  // 0 in results of older programs, which do not say
    std::string asked;       // what was measured and written: "metrics=flip write=exr,png frames=truth"
    // Of an earlier run in the same folder, named once and not kept: methods that this one has not and whose pictures
    // are gone; files that were made from it and are left.
    std::vector<std::string> replacedMethods, outdatedFiles;
    std::string programVersion, isa, precision, machine;
    int threads = 1;
    std::optional<RunDevice> device;
    std::optional<MachineLoad> load;  // absent where nothing was timed on the processor
    // Figures that a run has by default and this one has not, since they would have taken about so many seconds.
    std::map<std::string, double> leftOut;
    Protocol protocol;
    std::optional<ShownOn> shownOn;               // where metrics of a sequence ask for a display
    std::optional<double> flipPixelsPerDegree;    // where FLIP was not looked at from the usual distance
    size_t warmUpFrames = 0;                      // that ran before the first judged one, for a full history
    std::map<std::string, std::string> maps;      // kinds of maps that were written, and their scales
    std::map<std::string, uint64_t> sanitised;    // replaced input values by kind; empty when none
    std::map<std::string, double> renderSeconds;  // mean per frame by pass group, as the shot records them
    std::vector<MethodResult> methods;
    std::vector<PairResult> pairs;  // every pair of methods with truth

    size_t framesDone() const { return methods.empty() ? 0 : methods[0].frames.size(); }
    bool wrotePictures() const { return asked.find("write=none") == std::string::npos; }
    bool wroteAllFrames() const { return wrotePictures() && asked.find("frames=all") != std::string::npos; }
    bool hasFigures() const;     // of a method at least: its frames had a truth, or another method was the reference
    bool jitterCentred() const;  // |mean| below 1e-4 px
    // The method that the others are held against: it has time and pictures, and no figures.
    bool isReference(const MethodResult& m) const { return m.text == protocol.reference; }
};

// The line that makes a method's row again; empty where the results do not say.
std::string rerunLine(const RunResults& run, const MethodResult& method);
// "interrupted after 8 of 16 frames"; empty for a run that is complete.
std::string incompleteInWords(const RunResults& run);
// Indices into RunResults::methods: the method written so; no anti-aliasing, where it was measured.
std::optional<size_t> indexOf(const RunResults& run, std::string_view text);
std::optional<size_t> noaaOf(const RunResults& run);
// The comparison of methods a and b, turned as it is asked for: gains are positive where `a` is nearer to the truth.
std::optional<Comparison> compared(const RunResults& run, size_t a, size_t b);
// Whether two methods, of one run or of two runs of one shot, were judged by the same parts of the picture.
bool comparable(const MethodResult& a, const MethodResult& b);
// Of the frames that have them: TemporalMetrics::ghostMse and the square of its flicker along the motion.
std::vector<FrameSum> ghostSums(const MethodResult& method);
std::vector<FrameSum> flickerSums(const MethodResult& method);

// Fills medians, ns/px, pooled figures, gains and pairs. `errors[m]` are the tile errors of methods[m] summed over the
// frames with truth; those that are empty leave what a method has (MethodResult::parts of an earlier run).
void finish(RunResults& run, const std::vector<TileErrors>& errors);

// OUT/results.json and OUT/results.csv through temporary names. Throws InputError when they cannot be written.
void writeResults(const RunResults& run, const std::filesystem::path& folder);
std::string toJsonText(const RunResults& run);
std::string toCsvText(const RunResults& run);
void writeCsv(const RunResults& run, std::ostream& out);
// The figures that a run holds, in the order of tables: mse, psnr and snr, those that every run has, those asked for.
std::vector<const Figure*> figuresIn(const RunResults& run);
// Reads OUT/results.json, or that file under any name. Throws InputError: no run there, damaged, wrong type of a member
// (named).
RunResults readResults(const std::filesystem::path& path);

}  // namespace aa
