#include "study/judge.h"

#include <algorithm>

namespace aa {

Judge::Judge(const Manifest& manifest, const RunOptions& o, bool overTime)
    : manifest_(manifest),
      options_(o),
      overTime_(overTime),
      errors_(o.methods.size()),
      scene_(manifest.isStatic),
      overTimeOf_(o.methods.size(), TemporalJudge(temporalWarmup(o.frames.size()))) {}

void Judge::look(const Frame& frame, const std::shared_ptr<const Truth>& truth) {
    seen_++;
    number_ = frame.number;
    reset_ = frame.reset;
    const Protocol& protocol = options_.protocol;
    if (truth != truth_) {
        truth_ = truth;
        reference_.reset();
        if (truth) {
            reference_ = makeReference(truth->a, truth->b, protocol.display, options_.exec, protocol.eightBit);
            if (protocol.display.transfer == Transfer::identity) {
                if (!clipped_) clipped_.emplace();
                clipped_->pixels += reference_->clippedPixels;
                clipped_->of += size_t(manifest_.width) * size_t(manifest_.height);
            }
        }
    }
    if (reference_) noise_ += reference_->noise, withTruth_++;
    if (overTime_) scene_.advance(frame, reference_ ? &reference_->encoded : nullptr, options_.exec);
    // A static shot is judged at its last frame, as the published protocol does: there every history is longest.
    if (manifest_.isStatic) errors_.assign(errors_.size(), {});
}

FrameResult Judge::judge(size_t k, const RunningMethod& method, double seconds) {
    FrameResult result;
    result.frame = number_;
    result.seconds = seconds;
    if (reference_) {
        const bool linear = method.spec.outputSpace() == Space::linear;
        result.metrics = measure(method.outEncoded, linear ? &method.out : nullptr, *reference_, options_.measure,
                                 options_.exec, errors_[k]);
    }
    if (overTime_) {
        overTimeOf_[k].add(scene_, method.outEncoded, options_.exec);
        if (int(seen_) > temporalWarmup(options_.frames.size())) result.temporal = overTimeOf_[k].latest();
    }
    return result;
}

void Judge::judgeRejected(const std::vector<RunningMethod>& methods, std::vector<MethodResult>& results) const {
    if (!overTime_ || !reference_ || reset_) return;
    const auto base = [](const RunningMethod& m) { return withoutStages(m.spec.text); };
    for (size_t k = 0; k < methods.size(); k++) {
        const auto peer = std::find_if(methods.begin(), methods.end(), [&](const auto& m) {
            return m.method->rejection() && base(m) == base(methods[k]);
        });
        if (peer == methods.end()) continue;
        const PlaneF& mask = *peer->method->rejection();
        FrameSum sum;
        for (int y = 0; y < mask.height(); y++)
            for (int x = 0; x < mask.width(); x++)
                if (mask.at(x, y) != 0)
                    for (size_t c = 0; c < 3; c++, sum.count++) {
                        const double e =
                            double(methods[k].outEncoded.c[c].at(x, y)) - double(reference_->encoded.c[c].at(x, y));
                        sum.sum += e * e;
                    }
        results[k].frames.back().rejected = sum;
    }
}

void Judge::finish(RunResults& results, bool fromReset) const {
    results.truthClipped = clipped_;
    // Of a truth with one half only (an imported render) nobody knows the noise.
    if (withTruth_ > 0 && manifest_.truthHalves.value_or(2) != 1) results.truthNoise = noise_ / double(withTruth_);
    for (size_t k = 0; overTime_ && k < overTimeOf_.size(); k++) {
        results.methods[k].temporal = overTimeOf_[k].result();
        if (!fromReset) results.methods[k].temporal->convergence.reset();  // it counts from the start of the history
    }
}

}  // namespace aa
