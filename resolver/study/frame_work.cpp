#include "study/frame_work.h"

#include <algorithm>
#include <mutex>

#include "gpu/method.h"
#include "shot/pass_table.h"
#include "study/external.h"
#include "study/images.h"

namespace aa {
namespace {
// Timings of one method below which its frames are resolved again, where it keeps nothing from frame to frame.
constexpr size_t kTimings = 5;

bool isThere(const std::filesystem::path& out, const std::string& image) {
    std::error_code ignored;
    return !image.empty() && std::filesystem::exists(out / image, ignored);
}
}  // namespace

FrameWork::FrameWork(const ShotReader& shot, const RunOptions& o, const InputPlan& plan, Judge& judge,
                     std::vector<RunningMethod>& methods, RunResults& results)
    : manifest_(shot.manifest()), options_(o), plan_(plan), judge_(judge), methods_(methods), results_(results) {
    for (const RunningMethod& m : methods) passes_.push_back(m.spec.passes());
    if (o.device && o.timeOnly)
        for (const auto& spec : o.methods)
            timed_.push_back(isExternal(spec) ? nullptr : gpu::create(*o.device, spec, shotInfo(manifest_)));
    for (size_t k = 0; k < methods.size() && !o.protocol.reference.empty(); k++)
        if (methods[k].spec.text == o.protocol.reference) reference_ = k;
}

Trace::Span FrameWork::span(std::string_view stage, size_t k) const {
    return Trace::Span(options_.trace.get(), stage, options_.trace ? methods_[k].spec.text : "");
}

const FrameResult* FrameWork::knownFrame(size_t k, size_t i) const {
    const auto known = options_.known.find(methods_[k].spec.text);
    return known != options_.known.end() && i < known->second.size() ? &known->second[i] : nullptr;
}

bool FrameWork::isWritten(size_t i) const {
    if (options_.writeAllFrames) return true;
    return judge_.reference() && (!manifest_.isStatic || i + 1 == options_.frames.size());
}

void FrameWork::operator()(Feed::Item& item, size_t i) {
    if (reference_)
        work(*reference_, item, i);
    else
        lookAtTruth(item, i);
    const std::vector<size_t> others = order();
    const auto count = [&](bool (FrameWork::*reads)(size_t) const) {
        return size_t(std::count_if(others.begin(), others.end(), [&](size_t k) { return (this->*reads)(k); }));
    };
    size_t ofSubSamples = count(&FrameWork::readsSubSamples), ofCentre = count(&FrameWork::readsCentre);
    std::mutex givingBack;
    // A device does one thing after the other.
    const Exec side{.parallel = options_.exec.parallel && !options_.device};
    sideBySide(side, others.size(), [&](size_t n) {
        const size_t k = others[n];
        work(k, item, i);
        const std::lock_guard one(givingBack);
        if (readsSubSamples(k) && --ofSubSamples == 0) forgetSubSamples(item, i);
        if (readsCentre(k) && --ofCentre == 0 && !options_.device) item.centre.reset();
    });
    judge_.judgeRejected(methods_, results_.methods);
    for (RunningMethod& m : methods_) m.forgetPicture();
}

double FrameWork::secondsBefore(size_t k) const {
    const auto& frames = results_.methods[k].frames;
    return frames.empty() ? 0 : frames.back().seconds;
}

std::vector<size_t> FrameWork::order() const {
    std::vector<size_t> all;
    for (size_t k = 0; k < methods_.size(); k++)
        if (k != reference_) all.push_back(k);
    const auto group = [&](size_t k) { return readsSubSamples(k) ? 0 : readsCentre(k) ? 1 : 2; };
    // In a group the slowest first, as they were in the frame before: at the end no thread waits long for another.
    std::stable_sort(all.begin(), all.end(), [&](size_t a, size_t b) {
        const int groupA = group(a), groupB = group(b);
        return groupA != groupB ? groupA < groupB : secondsBefore(a) > secondsBefore(b);
    });
    return all;
}

// They are most of a frame's memory, which the next one takes that is being decoded.
void FrameWork::forgetSubSamples(Feed::Item& item, size_t i) const {
    if (options_.device) return;  // it shares them
    item.frame->subSamples.clear();
    const auto file = [&](size_t n) { return manifest_.frames[options_.frames[n]].centre; };
    const bool isNeeded = i + 1 < options_.frames.size() && file(i) == file(i + 1);  // it is the next one's, too
    if (item.centre && !isNeeded) item.centre->subSamples.clear();
}

void FrameWork::lookAtTruth(Feed::Item& item, size_t i) {
    const Trace::Span truth(options_.trace.get(), "truth");
    judge_.look(*item.frame, item.truth, nullptr);
    item.truth.reset();
    if (!judge_.reference() || !isWritten(i)) return;
    const int number = item.frame->number;
    const std::string image = writeTruthImage(*judge_.reference(), number, options_);
    if (!image.empty()) results_.truthImages[number] = image;
}

ResolveSeconds FrameWork::resolve(size_t k, const Frame& input, const FrameResult* known) {
    const Trace::Span resolving = span("resolve", k);
    RunningMethod& method = methods_[k];
    ResolveSeconds seconds = method.resolve(input, input.display, options_.exec);
    const bool isOurs = !isExternal(method.spec), onDevice = options_.device && !options_.timeOnly;
    if (onDevice || !isOurs) seconds = {};
    if (!known && seconds.processor > 0 && method.isRepeatable())
        for (size_t n = options_.frames.size(); n < kTimings; n += options_.frames.size())
            results_.methods[k].moreSeconds.push_back(method.again(input, options_.exec).processor);
    if (!timed_.empty() && isOurs) timed_[k]->resolve(input, options_.exec, unused_);
    if (options_.protocol.eightBit) quantise8(method.changeShown(), options_.exec);
    return seconds;
}

void FrameWork::work(size_t k, const Feed::Item& item, size_t i) {
    const Frame &frame = *item.frame, &input = plan_.readsCentre(methods_[k].spec) ? *item.centre : frame;
    const bool isReference = k == reference_;
    const FrameResult* known = knownFrame(k, i);
    const ResolveSeconds seconds = resolve(k, input, known);
    FrameResult result;
    {
        const Trace::Span judging = span("judge", k);
        if (isReference) judge_.look(frame, nullptr, &methods_[k]);
        result = judge_.judge(k, methods_[k], seconds, known);
    }
    if (options_.device && !isExternal(methods_[k].spec))
        result.deviceSeconds = (timed_.empty() ? *methods_[k].method : *timed_[k]).deviceSeconds();
    if (known) {
        result.seconds = known->seconds, result.wallSeconds = known->wallSeconds;
        result.deviceSeconds = known->deviceSeconds;
        result.image = known->image;
    }
    if (isWritten(i) && (!known || !isThere(options_.out, known->image))) writePictures(k, frame, isReference, result);
    if (isReference && !result.image.empty()) results_.truthImages[frame.number] = result.image;
    note(k, input, std::move(result));
    if (!isReference && !Judge::isReadLater(methods_, k)) methods_[k].forgetPicture();
}

void FrameWork::writePictures(size_t k, const Frame& frame, bool isReference, FrameResult& result) {
    const Trace::Span writing = span("write", k);
    result.image = writeImage(methods_[k], frame.number, options_);
    if (judge_.reference() && !isReference)
        writeMaps(methods_[k], judge_.measured(), frame.number, options_,
                  [&](const MapKind& kind) { return judge_.sequenceMap(k, kind); });
}

void FrameWork::note(size_t k, const Frame& input, FrameResult result) {
    const RunningMethod& method = methods_[k];
    MethodResult& of = results_.methods[k];
    if (manifest_.isStatic && !of.frames.empty()) of.frames.back().judged = false;
    of.frames.push_back(std::move(result));
    const size_t subSamples = manifest_.subsamplePositionsPx.size();
    of.inputBytes = std::max(of.inputBytes, bytesOf(passes_[k], input, subSamples));
    of.targetBytes = isExternal(method.spec) ? 0 : bytesOfTarget(input.width, input.height);
    of.stateBytes = std::max(of.stateBytes, method.method->stateBytes());
}

}  // namespace aa
