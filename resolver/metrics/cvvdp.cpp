#include "metrics/cvvdp.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <numeric>

#include "metrics/cvvdp_kernels.h"
#include "metrics/metrics_kernels.h"

namespace aa {
namespace {
using namespace cvvdp_constants;

using Channels = std::array<PlaneF, kChannels>;  // the last one is empty for a still
ChannelsIn in(const Channels& planes) {
    ChannelsIn v{};
    for (size_t c = 0; c < kChannels; c++) v.c[c] = planes[c].empty() ? nullptr : planes[c].row(0);
    return v;
}
ChannelsOut out(Channels& planes) {
    ChannelsOut v{};
    for (size_t c = 0; c < kChannels; c++) v.c[c] = planes[c].empty() ? nullptr : planes[c].row(0);
    return v;
}
Channels makeChannels(int count, int width, int height) {
    Channels planes;
    for (int c = 0; c < count; c++) planes[size_t(c)] = PlaneF(width, height);
    return planes;
}
double power(double x, double p) { return std::pow(x + kEpsilon, p) - std::pow(kEpsilon, p); }

// ---- time ----
// Weights of the four filters, from the middle tap outwards: the responses are real, so that the inverse transform is a
// sum of cosines.
std::vector<double> filterWeights(int taps, double framesPerSecond) {
    const int middle = taps / 2;
    std::vector<double> weights;
    for (size_t c = 0; c < kChannels; c++)
        for (int i = 0; i <= middle; i++) {
            double sum = 0;
            for (int k = 0; k <= middle; k++) {
                const double f = std::pow(framesPerSecond / 2 * k / middle, kTemporalBeta[c]);
                const double response =
                    c == 3
                        ? std::exp(-std::pow(f - std::pow(kTransientPeakHz, kTemporalBeta[c]), 2) / kTemporalSigma[c])
                        : std::exp(-f / kTemporalSigma[c]);
                sum += (k ? 2 : 1) * response * std::cos(2 * std::numbers::pi * k * i / taps);
            }
            weights.push_back(sum / taps);
        }
    return weights;
}

// ---- pyramid ----
struct Size {
    int width, height;
};
// What is the same for every frame of a sequence.
struct Model {
    SequenceSetting setting;
    int channels, taps;
    std::vector<double> weights;
    std::vector<Size> levels;                                                  // the last one holds the baseband
    std::vector<double> frequencies;                                           // of the bands, cycles per degree
    std::vector<std::array<float, kChannels*(kCsfSize + 1)>> log2Sensitivity;  // of the bands, by luminance
    double crossMasking[kChannels][kChannels] = {};

    explicit Model(const SequenceSetting& s)
        : setting(s), channels(s.still ? kStillChannels : kChannels), taps(1), weights{1, 1, 1, 1} {
        if (!s.still) {
            taps = int(std::ceil(kFilterSeconds * s.viewing.framesPerSecond / 2)) * 2 + 1;
            weights = filterWeights(taps, s.viewing.framesPerSecond);
        }
        const double nyquist = s.viewing.display->pixelsPerDegree() / 2;
        const auto frequency = [&](int band) {
            return nyquist * (band == 0 ? 1 : kBandPeak * std::pow(2.0, 1 - band));
        };
        int bands = 0;  // beside the baseband
        while (frequency(bands) > kLeastFrequency) bands++;
        const int fitting = int(std::floor(std::log2(std::min(s.width, s.height)))) - 1;
        bands = std::clamp(bands + 1, 0, std::max(fitting, 0));
        Size size{s.width, s.height};
        for (int band = 0; band <= bands; band++) {
            levels.push_back(size);
            size = {(size.width + 1) / 2, (size.height + 1) / 2};
            frequencies.push_back(band == bands ? kBasebandFrequency : frequency(band));
            addSensitivity(frequencies.back());
        }
        for (int k = 0; k < channels; k++)
            for (int c = 0; c < channels; c++) crossMasking[k][c] = std::exp2(kCrossMasking[k][c]);
    }
    size_t baseband() const { return levels.size() - 1; }
    double bandGain(size_t band) const { return band == 0 || band == baseband() ? 1 : 2; }
    bool isBlurred(size_t band) const { return std::min(levels[band].width, levels[band].height) > kBlurReach; }
    // Of the luminance of log10 `luminance`, as the kernel computes it.
    double sensitivity(size_t band, int channel, double log2Luminance) const {
        const double place = std::clamp((log2Luminance - kCsfFirstLog2) * kCsfStepsPerLog2, 0.0, kCsfSize - 1.0);
        const float* table = log2Sensitivity[band].data() + channel * (kCsfSize + 1) + int(place);
        const double share = place - std::floor(place);
        return std::exp2(double(table[0]) * (1 - share) + double(table[1]) * share);
    }

  private:
    // Linear in log frequency, also beyond the table.
    void addSensitivity(double frequency) {
        const double place =
            std::log(frequency / kCsfFrequency[0]) / std::log(kCsfFrequency[1] / kCsfFrequency[0]) * (kCsfSize - 1);
        const int below = std::clamp(int(std::ceil(place)) - 1, 0, kCsfSize - 2);
        const double share = place - below;
        auto& to = log2Sensitivity.emplace_back();
        for (int c = 0; c < kChannels; c++)
            for (int l = 0; l <= kCsfSize; l++) {
                const float* row = kLogSensitivity[c][std::min(l, kCsfSize - 1)];
                const double log10 = double(row[below]) + (double(row[below + 1]) - double(row[below])) * share +
                                     kSensitivityCorrectionDb / 20;
                to[size_t(c * (kCsfSize + 1) + l)] = float(log10 * std::log2(10.0));
            }
    }
};

// Working memory: one picture's channels at every level, and what two of them give. All pictures share it.
struct Workspace {
    std::vector<Channels> pyramid;
    Channels difference, mutual;
    explicit Workspace(const Model& m) {
        for (const Size& s : m.levels) pyramid.push_back(makeChannels(m.channels, s.width, s.height));
        difference = makeChannels(m.channels, m.levels[0].width, m.levels[0].height);
        mutual = difference;
    }
};
CvvdpBand bandOf(const Model& m, const Workspace& w, size_t band) {
    return {in(w.pyramid[band]),
            in(w.pyramid[band + 1]),
            w.pyramid[band][0].stride(),
            w.pyramid[band + 1][0].stride(),
            m.levels[band].width,
            m.levels[band].height,
            m.channels};
}

// Its last frames as opponent colours, and of them the pyramid of the channels.
class Picture {
  public:
    explicit Picture(const Model& m) : model_(m) {}
    void add(const SequencePicture& frame, const Exec& exec, Workspace& to) {
        const Rgb& picture = model_.setting.viewing.display->isHdr ? *frame.linear : frame.encoded;
        assert(picture.width() == model_.setting.width && picture.height() == model_.setting.height);
        if (past_.size() < size_t(model_.taps)) past_.emplace_back(picture.width(), picture.height());
        toOpponent(picture, exec, past_[size_t(frames_) % past_.size()]);
        frames_++;
        filter(exec, to.pyramid[0]);
        for (size_t i = 0; i + 1 < model_.levels.size(); i++) reduce(i, exec, to);
    }

  private:
    void toOpponent(const Rgb& picture, const Exec& exec, Rgb& opponent) const {
        const DisplayModel& d = *model_.setting.viewing.display;
        CvvdpLightArgs args{.picture = view(picture),
                            .stride = picture.stride(),
                            .width = picture.width(),
                            .isLinear = d.isHdr,
                            .gain = d.peak - d.black,
                            .least = 0,
                            .most = d.peak - d.black,
                            .background = d.black + d.reflected(),
                            .toOpponent = {},
                            .opponent = view(opponent),
                            .opponentStride = opponent.stride()};
        if (d.isHdr) {
            args.gain = kHdrWhite * std::exp2(double(model_.setting.exposure));
            args.least = std::max(kLeastLight, d.black), args.most = d.peak;
            args.background = d.reflected();
        }
        for (size_t i = 0; i < 3; i++)
            for (size_t k = 0; k < 3; k++)
                for (size_t a = 0; a < 3; a++)
                    for (size_t b = 0; b < 3; b++)
                        args.toOpponent[i][k] += kLmsToDkl[i][a] * kXyzToLms[a][b] * kRgbToXyz[b][k];
        runKernel(cvvdpKernelsFor(exec).light, exec, args, picture.height());
    }
    void filter(const Exec& exec, Channels& to) const {
        std::vector<const float*> frames;
        for (int i = model_.taps - 1; i >= 0; i--) {
            const int frame = std::max(frames_ - 1 - i, 0);  // before the first one, the first one
            for (const PlaneF& p : past_[size_t(frame) % size_t(model_.taps)].c) frames.push_back(p.row(0));
        }
        const CvvdpFilterArgs args{frames.data(),    model_.weights.data(), model_.taps, past_[0].stride(),
                                   past_[0].width(), model_.channels,       out(to)};
        runKernel(cvvdpKernelsFor(exec).filter, exec, args, past_[0].height());
    }
    void reduce(size_t level, const Exec& exec, Workspace& w) const {
        const Channels& from = w.pyramid[level];
        Channels& to = w.pyramid[level + 1];
        const CvvdpReduceArgs args{in(from),        from[0].stride(), from[0].width(), from[0].height(),
                                   model_.channels, out(to),          to[0].stride(),  to[0].width()};
        runKernel(cvvdpKernelsFor(exec).reduce, exec, args, to[0].height());
        for (PlaneF& p : to) p.fillBorder();
    }
    const Model& model_;
    std::vector<Rgb> past_;  // a ring
    int frames_ = 0;
};

// The channels of the smallest level over the mean luminance there.
struct Baseband {
    Channels contrast;
    double mean = 0;  // of the luminance
    void take(const Model& m, const Workspace& w) {
        contrast = w.pyramid.back();
        const auto [width, height] = m.levels.back();
        double sum = 0;
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) sum += std::max(double(contrast[0].at(x, y)), kLeastBackground);
        mean = sum / (double(width) * height);
        for (int c = 0; c < m.channels; c++)
            for (int y = 0; y < height; y++)
                for (int x = 0; x < width; x++) {
                    float& v = contrast[size_t(c)].at(x, y);
                    v = float(std::min(double(v) / mean, kMostContrast));
                }
    }
};

struct Shared {
    Model model;
    Workspace work;
    std::vector<Channels> sensitivity, response;  // of the reference, by band
    Baseband baseband;
    explicit Shared(const SequenceSetting& s) : model(s), work(model) {
        for (size_t i = 0; i < model.baseband(); i++)
            sensitivity.push_back(makeChannels(model.channels, model.levels[i].width, model.levels[i].height));
        response = sensitivity;
    }
};

// ---- pooling ----
using PerChannel = std::array<double, kChannels>;
double jod(double quality) {
    return quality <= kJodLinearBelow ? 10 - kJodScale * std::pow(kJodLinearBelow, kJodExponent - 1) * quality
                                      : 10 - kJodScale * std::pow(quality, kJodExponent);
}
double pooled(const PerChannel& channels, int count) {
    double sum = 0;
    for (size_t c = 0; c < size_t(count); c++) sum += power(channels[c], kChannelExponent);
    return power(sum, 1 / kChannelExponent);
}
// Of all channels, and of each alone; `meanSquares` over the frames of power(difference, 2).
struct Qualities {
    static constexpr size_t kCount = 1 + kChannels;
    std::array<double, kCount> meanSquares{};
};

class Test : public SequenceTest {
  public:
    explicit Test(Shared& shared) : shared_(shared), picture_(shared.model) {
        if (shared.model.setting.withMaps)
            for (const Size& s : shared.model.levels) differences_.emplace_back(s.width, s.height);
    }
    std::vector<double> add(const SequencePicture& frame, const Exec& exec) override {
        const Model& m = shared_.model;
        picture_.add(frame, exec, shared_.work);
        PerChannel sums{};  // over the bands, to the power 4
        for (size_t band = 0; band < m.levels.size(); band++) {
            const PerChannel rms = band == m.baseband() ? ofBaseband() : ofBand(band, exec);
            for (size_t c = 0; c < size_t(m.channels); c++)
                sums[c] +=
                    power(rms[c] * kChannelWeight[c] * (band == m.baseband() ? kBasebandWeight[c] : 1), kBandExponent);
        }
        PerChannel perChannel{};
        for (size_t c = 0; c < size_t(m.channels); c++) perChannel[c] = power(sums[c], 1 / kBandExponent);
        std::array<double, Qualities::kCount> now{};
        now[0] = pooled(perChannel, m.channels);
        for (size_t c = 0; c < size_t(m.channels); c++) {
            PerChannel alone{};
            alone[c] = perChannel[c];
            now[1 + c] = pooled(alone, m.channels);
        }
        frames_++;
        for (size_t i = 0; i < now.size(); i++) {
            const double squares = m.setting.still ? now[i] * kStillWeight : power(now[i], 2);
            total_[i] += squares;
            now[i] = squares;
        }
        return toJod(now, 1);
    }
    std::vector<double> overall() const override { return toJod(total_, frames_); }
    PlaneF latestMap(const Exec& exec) const override;

  private:
    std::vector<double> toJod(const std::array<double, Qualities::kCount>& sums, int frames) const {
        std::vector<double> values;
        for (const double sum : sums)
            values.push_back(jod(shared_.model.setting.still ? sum : power(sum / frames, 0.5)));
        return values;
    }
    double mapWeight(size_t c, bool isBaseband) const {
        return kChannelWeight[c] * (isBaseband ? kBasebandWeight[c] : 1) *
               (shared_.model.setting.still ? kStillWeight : 1);
    }
    PerChannel ofBand(size_t band, const Exec& exec) {
        const Model& m = shared_.model;
        Workspace& w = shared_.work;
        // The workspace is as large as the first level; every band uses its upper left part.
        const CvvdpBand levels = bandOf(m, w, band);
        const bool blurred = m.isBlurred(band);
        const CvvdpResponseArgs response{
            levels, in(shared_.sensitivity[band]), in(shared_.response[band]), out(w.difference), out(w.mutual),
            blurred};
        runKernel(cvvdpKernelsFor(exec).response, exec, response, levels.height);
        std::vector<double> rows(size_t(m.channels) * size_t(levels.height) * kSumStrands);
        CvvdpMaskArgs mask{
            in(w.difference), in(w.mutual), levels.stride, levels.width, levels.height, m.channels, blurred, {}, {},
            rows.data(),      nullptr};
        std::copy(&m.crossMasking[0][0], &m.crossMasking[0][0] + kChannels * kChannels, &mask.crossMasking[0][0]);
        if (!differences_.empty()) {
            for (size_t c = 0; c < kChannels; c++) mask.weights[c] = mapWeight(c, false);
            mask.map = differences_[band].row(0);
        }
        runKernel(cvvdpKernelsFor(exec).mask, exec, mask, levels.height);
        PerChannel rms{};
        const size_t perChannel = size_t(levels.height) * kSumStrands;
        for (size_t c = 0; c < size_t(m.channels); c++) {
            const auto first = rows.begin() + ptrdiff_t(c * perChannel);
            const double sum = std::accumulate(first, first + ptrdiff_t(perChannel), 0.0);
            rms[c] = power(sum / (double(levels.width) * levels.height), 0.5);
        }
        return rms;
    }
    PerChannel ofBaseband() {
        const Model& m = shared_.model;
        const size_t band = m.baseband();
        const auto [width, height] = m.levels[band];
        Baseband own;
        own.take(m, shared_.work);
        PerChannel sensitivity{}, sums{};
        for (int c = 0; c < m.channels; c++)
            sensitivity[size_t(c)] = m.sensitivity(band, c, std::log2(shared_.baseband.mean));
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                PerChannel weighted{};
                for (size_t c = 0; c < size_t(m.channels); c++) {
                    const double t = double(own.contrast[c].at(x, y)),
                                 r = double(shared_.baseband.contrast[c].at(x, y));
                    const double d = std::abs(t - r) * sensitivity[c];
                    sums[c] += power(d, 2);
                    weighted[c] = d * mapWeight(c, true);
                }
                if (!differences_.empty()) differences_[band].at(x, y) = float(pooled(weighted, m.channels));
            }
        PerChannel rms{};
        for (size_t c = 0; c < size_t(m.channels); c++) rms[c] = power(sums[c] / (double(width) * height), 0.5);
        return rms;
    }
    Shared& shared_;
    Picture picture_;
    std::vector<PlaneF> differences_;  // of the latest frame, by band, the channels pooled
    std::array<double, Qualities::kCount> total_{};
    int frames_ = 0;
};

// The bands' differences added up as the bands of a picture, then to JOD.
PlaneF Test::latestMap(const Exec&) const {
    const Model& m = shared_.model;
    PlaneF sum = differences_.back();
    for (size_t band = m.baseband(); band-- > 0;) {
        sum.fillBorder();
        const auto [width, height] = m.levels[band];
        PlaneF finer(width, height);
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++) {
                // [Burt 1983]: 0.1, 0.8, 0.1 on the grid, two halves between.
                const auto alongX = [&](int row) {
                    const float* p = sum.row(row) + x / 2;
                    return x % 2 ? 0.5f * (p[0] + p[1]) : 0.1f * (p[-1] + p[1]) + 0.8f * p[0];
                };
                const int k = y / 2;
                const float expanded = y % 2 ? 0.5f * (alongX(k) + alongX(k + 1))
                                             : 0.1f * (alongX(k - 1) + alongX(k + 1)) + 0.8f * alongX(k);
                finer.at(x, y) = expanded + differences_[band].at(x, y) / float(m.bandGain(band));
            }
        sum = std::move(finer);
    }
    for (int y = 0; y < sum.height(); y++)
        for (int x = 0; x < sum.width(); x++) sum.at(x, y) = float(10 - jod(std::max(0.0, double(sum.at(x, y)))));
    sum.fillBorder();
    return sum;
}

class CvvdpReference : public SequenceReference {
  public:
    explicit CvvdpReference(const SequenceSetting& s) : shared_(s), picture_(shared_.model) {}
    void add(const SequencePicture& frame, const Exec& exec) override {
        const Model& m = shared_.model;
        picture_.add(frame, exec, shared_.work);
        for (size_t band = 0; band < m.baseband(); band++) {
            const CvvdpSensitivityArgs args{bandOf(m, shared_.work, band), m.log2Sensitivity[band].data(),
                                            m.bandGain(band), out(shared_.sensitivity[band]),
                                            out(shared_.response[band])};
            runKernel(cvvdpKernelsFor(exec).sensitivity, exec, args, args.band.height);
        }
        shared_.baseband.take(m, shared_.work);
    }
    std::unique_ptr<SequenceTest> test() override { return std::make_unique<Test>(shared_); }

  private:
    Shared shared_;
    Picture picture_;
};
}  // namespace

std::unique_ptr<SequenceReference> cvvdp(const SequenceSetting& setting) {
    return std::make_unique<CvvdpReference>(setting);
}
double cvvdpOfStill(const Rgb& test, const Rgb& reference, const DisplayModel& display, const Exec& exec, PlaneF* map) {
    SequenceSetting setting{.width = test.width(), .height = test.height(), .viewing = {.display = &display}};
    setting.still = true, setting.withMaps = map;
    const auto against = cvvdp(setting);
    against->add({reference, &reference}, exec);
    const auto judged = against->test();
    const double value = judged->add({test, &test}, exec)[0];
    if (map) *map = judged->latestMap(exec);
    return value;
}

Metric cvvdpMetric() {
    const auto figure = [](std::string_view name, std::string_view title, std::string_view help) {
        return Figure{name, title, help, FigureForm::jod, true};
    };
    return {.figures = {figure("cvvdp", "JOD", "ColorVideoVDP of the sequence as a viewer sees it, 10 = no difference"),
                        figure("cvvdpSustained", "JOD luminance", "the same if all but what stays of luminance agreed"),
                        figure("cvvdpRedGreen", "JOD R-G", "if all but red against green agreed"),
                        figure("cvvdpYellowViolet", "JOD Y-V", "if all but yellow against violet agreed"),
                        figure("cvvdpTransient", "JOD flicker", "if all but what changes of luminance agreed")},
            .nsPerPixel = 100,
            .source = "[Mantiuk 2024]",
            .watch = cvvdp};
}

}  // namespace aa
