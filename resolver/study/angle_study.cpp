#include "study/angle_study.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "image/error.h"
#include "methods/driver.h"
#include "shot/synth/synth.h"
#include "study/synthetic_frames.h"

namespace aa {
namespace {

SynthOptions pictureOf(const AngleStudyOptions& o, const std::string& subsamples, bool colour, double degrees,
                       double offsetPx) {
    SynthOptions s;
    s.scene = "half_plane";
    s.width = s.height = o.sizePx;
    s.frames = o.frames;
    s.jitter = o.jitter;
    s.period = o.frames;
    s.subsamples = subsamples;
    s.subsampleColor = colour && !subsamples.empty();
    s.angleDegrees = degrees;
    s.offsetPx = offsetPx;
    return s;
}
double squaredError(const Rgb& image, const Rgb& truth) {  // mean over the middle half
    const int w = truth.width(), h = truth.height();
    double sum = 0, count = 0;
    for (size_t c = 0; c < 3; c++)
        for (int y = h / 4; y < h - h / 4; y++)
            for (int x = w / 4; x < w - w / 4; x++, count++)
                sum += std::pow(double(image.c[c].at(x, y)) - double(truth.c[c].at(x, y)), 2);
    return sum / count;
}

// The pictures of one angle and offset, rendered when a method asks for them.
class Pictures {
  public:
    Pictures(const AngleStudyOptions& o, double degrees, double offsetPx, const Exec& exec)
        : o_(o), degrees_(degrees), offsetPx_(offsetPx), exec_(exec) {
        encode(SynthShot(pictureOf(o, "", false, degrees, offsetPx)).truth(0).a, {}, exec, truth_);
    }
    const Rgb& truth() const { return truth_; }
    // What the method shows last.
    double error(const MethodSpec& spec, const std::string& subsamples) {
        const bool jittered = spec.method->sampling() == Sampling::jittered;
        const SynthShot& shot = shotWith(subsamples);
        RunningMethod running(spec, shotInfo(shot.manifest()));
        for (size_t i = 0; i < (jittered ? size_t(o_.frames) : 1); i++)
            running.resolve(frame(shot, subsamples, i, jittered), {}, exec_);
        return squaredError(running.shown(), truth_);
    }

  private:
    const SynthShot& shotWith(const std::string& subsamples) {
        auto it = shots_.find(subsamples);
        if (it == shots_.end())
            it = shots_.emplace(subsamples, SynthShot(pictureOf(o_, subsamples, true, degrees_, offsetPx_))).first;
        return it->second;
    }
    const Frame& frame(const SynthShot& shot, const std::string& subsamples, size_t index, bool jittered) {
        auto& made = frames_[{subsamples, jittered, index}];
        if (made.width == 0) {
            made = shot.frame(index, jittered ? Sampling::jittered : Sampling::centre);
            encodeFrame(made, {}, exec_);
        }
        return made;
    }
    const AngleStudyOptions& o_;
    double degrees_, offsetPx_;
    Exec exec_;
    Rgb truth_;
    std::map<std::string, SynthShot> shots_;
    std::map<std::tuple<std::string, bool, size_t>, Frame> frames_;
};

double largestDifference(const AngleStudy& s, size_t method, const std::function<size_t(size_t)>& partner) {
    double largest = 0;
    for (size_t k = 0; k < s.degrees.size(); k++)
        largest = std::max(largest, std::abs(s.gainDb(method, k) - s.gainDb(method, partner(k))));
    return largest;
}
}  // namespace

double AngleStudy::gainDb(size_t method, size_t angle) const {
    return 10 * std::log10(noaaMse[angle] / methods[method].mse[angle]);
}
double AngleStudy::pooledGainDb(size_t method) const {
    double plain = 0, smooth = 0;
    for (size_t k = 0; k < degrees.size(); k++) plain += noaaMse[k], smooth += methods[method].mse[k];
    return 10 * std::log10(plain / smooth);
}
double AngleStudy::mirrorAsymmetryDb(size_t method) const {  // x to -x: angle a to 180 - a
    const size_t n = degrees.size();
    return largestDifference(*this, method, [n](size_t k) { return (n + n / 2 - 1 - k) % n; });
}
double AngleStudy::turnAsymmetryDb(size_t method) const {
    const size_t n = degrees.size();
    return largestDifference(*this, method, [n](size_t k) { return (k + n / 4) % n; });
}

AngleStudy studyAngles(const AngleStudyOptions& o, const Exec& exec) {
    if (o.angles < 4 || o.angles % 4 != 0) throw UsageError("angles: expected a multiple of 4, so that they mirror");
    AngleStudy study{o.offsets, o.sizePx, o.frames, o.jitter, {}, std::vector<double>(size_t(o.angles)), {}};
    for (int k = 0; k < o.angles; k++) study.degrees.push_back((k + 0.5) * 360 / o.angles);
    for (const auto& spec : o.methods)
        study.methods.push_back({spec.text, std::string(spec.method->title), std::string(spec.method->family),
                                 subSamplePatternFor(spec), std::vector<double>(size_t(o.angles))});
    const MethodSpec noaa = parseMethod("noaa");
    Exec alone = exec;
    alone.parallel = false;  // the angles run in parallel
    forRows(
        exec, o.angles,
        [&](int from, int to) {
            for (size_t k = size_t(from); k < size_t(to); k++)
                for (int j = 0; j < o.offsets; j++) {
                    Pictures pictures(o, study.degrees[k], (j + 0.5) / o.offsets - 0.5, alone);
                    study.noaaMse[k] += pictures.error(noaa, "") / o.offsets;
                    for (size_t m = 0; m < o.methods.size(); m++)
                        study.methods[m].mse[k] +=
                            pictures.error(o.methods[m], study.methods[m].subsamples) / o.offsets;
                }
        },
        1);
    return study;
}

}  // namespace aa
