#include "study/judge.h"

#include <algorithm>
#include <cmath>

#include "image/error.h"
#include "image/input_policy.h"
#include "metrics/glance.h"
#include "metrics/non_finite.h"

namespace aa {

Judge::Judge(const Manifest& manifest, const RunOptions& o, bool overTime)
    : manifest_(manifest),
      options_(o),
      overTime_(overTime),
      errors_(o.methods.size()),
      scene_(manifest.isStatic),
      overTimeOf_(o.methods.size(), TemporalJudge(temporalWarmup(o.frames.size()), o.protocol.region)) {}

void Judge::lookAtTruth(const std::shared_ptr<const Truth>& truth) {
    if (truth && truth == truth_.lock()) return;
    truth_ = truth;
    reference_.reset();
    region_.reset();
    if (!truth) return;
    const Protocol& p = options_.protocol;
    reference_ = makeReference(truth->a, truth->b, p.display, options_.exec, p.eightBit);
    if (p.region)
        region_ = makeReference(cropped(truth->a, *p.region), cropped(truth->b, *p.region), p.display, options_.exec,
                                p.eightBit);
    if (p.display.transfer == Transfer::identity) {
        if (!clipped_) clipped_.emplace();
        clipped_->pixels += measured().clippedPixels;
        clipped_->of += size_t(measured().encoded.width()) * size_t(measured().encoded.height());
    }
}

// Its picture is taken as it is: no noise is known of it.
void Judge::lookAtMethod(const RunningMethod& m) {
    const Protocol& p = options_.protocol;
    reference_.emplace();
    reference_->encoded = m.shown();
    if (p.display.transfer == Transfer::identity)
        reference_->linear = m.shown();
    else if (m.spec.outputSpace() == Space::linear)
        reference_->linear = m.out;
    else
        decode(m.out, p.display, options_.exec, reference_->linear);
    if (nonFiniteValues(m.out) > 0) reference_->broken = m.out;
    if (p.region) {
        region_.emplace();
        region_->linear = cropped(reference_->linear, *p.region);
        region_->encoded = cropped(reference_->encoded, *p.region);
    }
}

void Judge::look(const Frame& frame, const std::shared_ptr<const Truth>& truth, const RunningMethod* standIn) {
    seen_++;
    number_ = frame.number;
    reset_ = frame.reset;
    standIn_ = standIn;
    if (standIn)
        lookAtMethod(*standIn);
    else
        lookAtTruth(truth);
    if (reference_) {
        noise_ += measured().noise, withTruth_++;
        prepare(region_ ? *region_ : *reference_, options_.measure, options_.exec, isJudged());
        watchReference();
    }
    if (overTime_) scene_.advance(frame, reference_ ? &reference_->encoded : nullptr, options_.exec);
    if (manifest_.isStatic) errors_.assign(errors_.size(), {});
}

// Known figures, once the image has been seen to be the one that they are of.
FrameMetrics Judge::again(const FrameMetrics& known, const TileErrors& errors, TileErrors& pool) const {
    pool += errors;
    if (errors.squaredError().mse != known.mse)
        throw InputError("frame " + std::to_string(number_) +
                         ": its image is not the one that results.json has figures of; run again without --resume");
    return known;
}

Rgb Judge::farthest(const RunningMethod& method, uint64_t& nonFinite) const {
    const Rgb* const broken = reference_ && !reference_->broken.empty() ? &reference_->broken : nullptr;
    nonFinite = nonFiniteValues(method.out);
    if (nonFinite == 0 && broken) nonFinite = nonFiniteValues(*broken);
    if (!reference_) return {};
    Rgb picture = method.shown();
    putFarthest(method.out.empty() ? nullptr : &method.out, broken, reference_->encoded, picture);
    return picture;
}

// Of linear light there is no largest difference.
void Judge::noLinearFigures(FrameMetrics& to) const {
    const auto& wanted = options_.measure.metrics;
    for (const Metric& m : metrics())
        if (m.space == ColourSpace::linear && (m.always || std::find(wanted.begin(), wanted.end(), &m) != wanted.end()))
            for (const Figure& f : m.figures) to.others[f.name] = NAN;
}

// A static shot is judged at its last frame, as the published protocol does: there every history is longest.
bool Judge::isJudged() const { return !manifest_.isStatic || seen_ == options_.frames.size(); }

void Judge::watchReference() {
    if (seen_ == 1)
        for (const Metric* metric : watchingMetrics(options_)) {
            const auto& maps = options_.maps;
            const SequenceSetting setting{
                .width = measured().encoded.width(),
                .height = measured().encoded.height(),
                .viewing = options_.measure.viewing,
                .exposure = options_.protocol.display.exposure,
                .still = options_.frames.size() == 1,
                .withMaps = std::any_of(maps.begin(), maps.end(), [](auto* kind) { return kind->drawValues; })};
            watches_.push_back({metric, metric->watch(setting), {}});
            watches_.back().tests.resize(options_.methods.size());
        }
    for (Watch& w : watches_) w.reference->add({measured().encoded, &measured().linear}, options_.exec);
}

void Judge::watch(size_t k, const Rgb& encoded, const Rgb* linear, FrameMetrics& metrics) {
    const std::lock_guard one(watching_);
    for (Watch& w : watches_) {
        if (options_.measure.viewing.display->isHdr && !linear) continue;
        if (!w.tests[k]) w.tests[k] = w.reference->test();
        const std::vector<double> values = w.tests[k]->add({encoded, linear}, options_.exec);
        for (size_t i = 0; i < values.size(); i++) metrics.others.emplace(w.metric->figures[i].name, values[i]);
    }
}

PlaneF Judge::sequenceMap(size_t k, const MapKind& kind) const {
    const std::lock_guard one(watching_);
    for (const Watch& w : watches_)
        if (w.metric->figures[0].name == kind.sequenceFigure && w.tests[k]) return w.tests[k]->latestMap(options_.exec);
    return {};
}

FrameResult Judge::judge(size_t k, const RunningMethod& method, const ResolveSeconds& seconds,
                         const FrameResult* known) {
    FrameResult result;
    result.frame = number_;
    result.seconds = seconds.processor;
    result.wallSeconds = seconds.wall;
    if (&method == standIn_) return result;
    const bool isWhole = reference_ && !options_.protocol.region;
    Glance glanced = glance(method.out, method.shown(), isWhole ? &*reference_ : nullptr, overTime_, options_.exec);
    Rgb picture;
    if (!glanced.isFinite || (reference_ && !reference_->broken.empty())) picture = farthest(method, result.nonFinite);
    const bool broken = !picture.empty();
    const Rgb& encoded = broken ? picture : method.shown();
    if (broken) glanced = {.luma = overTime_ ? pictureLuma(encoded, options_.exec) : PlaneF(), .errors = {}};
    if (reference_) {
        const bool linear = method.spec.outputSpace() == Space::linear;
        const auto& region = options_.protocol.region;
        const auto take = [&](const Rgb& shown, const Rgb& out) {
            const TileErrors errors =
                glanced.errors ? std::move(*glanced.errors) : tileErrors(shown, measured(), options_.exec);
            if (known && known->metrics) return again(*known->metrics, errors, errors_[k]);
            const MeasuredPicture measuredPicture{.encoded = shown,
                                                  .linear = linear && !broken ? &out : nullptr,
                                                  .luma = glanced.luma.empty() || region ? nullptr : &glanced.luma,
                                                  .errors = &errors};
            return measure(measuredPicture, measured(), options_.measure, options_.exec, errors_[k], isJudged());
        };
        const Rgb encodedPart = region ? cropped(encoded, *region) : Rgb(),
                  part = region ? cropped(method.out, *region) : Rgb();
        const Rgb &seen = region ? encodedPart : encoded, &out = region ? part : method.out;
        result.metrics = take(seen, out);
        if (linear && broken) noLinearFigures(*result.metrics);
        watch(k, seen, linear ? &out : nullptr, *result.metrics);
    }
    if (overTime_) {
        overTimeOf_[k].add(scene_, encoded, options_.exec,
                           result.metrics ? std::optional(result.metrics->mse) : std::nullopt, std::move(glanced.luma));
        if (int(seen_) > temporalWarmup(options_.frames.size())) result.temporal = overTimeOf_[k].latest();
    }
    return result;
}

namespace {
std::string baseOf(const RunningMethod& m) { return withoutStages(m.spec.text); }
}  // namespace

// A stage asks for the mask.
bool Judge::isReadLater(const std::vector<RunningMethod>& methods, size_t k) {
    return std::any_of(methods.begin(), methods.end(), [&](const RunningMethod& m) {
        return !m.spec.stages.empty() && baseOf(m) == baseOf(methods[k]);
    });
}

void Judge::judgeRejected(const std::vector<RunningMethod>& methods, std::vector<MethodResult>& results) const {
    if (!overTime_ || !reference_ || reset_) return;
    for (size_t k = 0; k < methods.size(); k++) {
        const auto peer = std::find_if(methods.begin(), methods.end(), [&](const RunningMethod& m) {
            return m.method->rejection() && baseOf(m) == baseOf(methods[k]);
        });
        if (peer == methods.end()) continue;
        if (&methods[k] == standIn_) continue;
        const PlaneF& mask = *peer->method->rejection();
        const Window area = options_.protocol.region.value_or(Window{0, 0, mask.width(), mask.height()});
        FrameSum sum;
        for (int y = area.y; y < area.y + area.height; y++)
            for (int x = area.x; x < area.x + area.width; x++)
                if (mask.at(x, y) != 0)
                    for (size_t c = 0; c < 3; c++, sum.count++) {
                        const double e =
                            double(methods[k].shown().c[c].at(x, y)) - double(reference_->encoded.c[c].at(x, y));
                        sum.sum += e * e;
                    }
        results[k].frames.back().rejected = sum;
    }
}

void Judge::finish(RunResults& results, bool fromReset) const {
    results.truthClipped = clipped_;
    // Of a truth with one half only (an imported render) nobody knows the noise.
    if (withTruth_ > 0 && (standIn_ || manifest_.truthHalves.value_or(2) != 1))
        results.truthNoise = noise_ / double(withTruth_);
    for (const Watch& w : watches_)
        for (size_t k = 0; k < w.tests.size(); k++) {
            if (!w.tests[k]) continue;
            const std::vector<double> values = w.tests[k]->overall();
            for (size_t i = 0; i < values.size(); i++)
                results.methods[k].sequence[std::string(w.metric->figures[i].name)] = values[i];
        }
    for (size_t k = 0; overTime_ && k < overTimeOf_.size(); k++) {
        if (results.isReference(results.methods[k])) continue;
        results.methods[k].temporal = overTimeOf_[k].result();
        if (!fromReset) results.methods[k].temporal->convergence.reset();  // it counts from the start of the history
    }
}

}  // namespace aa
