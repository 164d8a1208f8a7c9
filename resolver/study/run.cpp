#include "study/run.h"

#include <algorithm>
#include <chrono>

#include "gpu/method.h"
#include "metrics/temporal.h"
#include "shot/frame_stream.h"
#include "shot/pass_table.h"
#include "study/external.h"
#include "study/feed.h"
#include "study/images.h"
#include "study/judge.h"
#include "study/prepare.h"
#include "study/resume.h"
#include "study/warm_up.h"

namespace aa {

size_t stepsOf(const RunOptions& o, const Manifest& m) { return o.frames.size() * (1 + warmUpPasses(o, m)); }

namespace {
// Results as they grow: an earlier run's are replaced before the first frame, and no more than some seconds are lost.
class KeepsResults {
  public:
    explicit KeepsResults(const RunOptions& o, bool goesOn = false) : options_(o), started_(goesOn) {}
    void operator()(const RunResults& sofar) {
        constexpr std::chrono::seconds kEvery{5};
        const auto now = std::chrono::steady_clock::now();
        if (!started_) earlier_ = clearEarlier(options_);
        if (started_ && now - written_ < kEvery) return;
        started_ = true, written_ = now;
        RunResults partial = sofar;
        partial.complete = false;
        aa::finish(partial, {});
        writeResults(partial, options_.out);
    }
    void finish(RunResults& results, const std::vector<TileErrors>& errors) const {
        aa::finish(results, errors);
        results.replacedMethods = earlier_.methods;
        results.outdatedFiles = earlier_.files;
        writeResults(results, options_.out);
    }

  private:
    const RunOptions& options_;
    bool started_;
    std::chrono::steady_clock::time_point written_{};
    Earlier earlier_;
};
}  // namespace

RunResults run(const ShotReader& shot, const RunOptions& o, const Progress& progress) {
    RunOptions writing = o;
    KeepsResults keeps{o};
    writing.checkpoint = [&](const RunResults& r) { keeps(r); };
    std::vector<TileErrors> errors;
    RunResults results = runMethods(shot, writing, progress, errors);
    keeps.finish(results, errors);
    return results;
}

RunResults resume(const ShotReader& shot, const RunOptions& o, const Progress& progress) {
    RunOptions going = o;
    const Resumption resumption = goOnWith(readResults(o.out), shot, going);
    RunResults results;
    std::vector<TileErrors> errors;
    if (!going.methods.empty()) {
        KeepsResults keeps{o, true};
        going.checkpoint = [&](const RunResults& r) {
            RunResults all = r;
            std::vector<TileErrors> none;
            merge(resumption, all, none);
            keeps(all);
        };
        results = runMethods(shot, going, progress, errors);
    }
    merge(resumption, results, errors);
    finish(results, errors);
    writeResults(results, o.out);
    return results;
}

namespace {
// The methods' indices: the one that the others are held against first.
std::vector<size_t> orderOfWork(const std::vector<RunningMethod>& methods, const std::string& reference) {
    std::vector<size_t> order(methods.size());
    for (size_t k = 0; k < order.size(); k++) order[k] = k;
    std::stable_partition(order.begin(), order.end(), [&](size_t k) { return methods[k].spec.text == reference; });
    return order;
}
const FrameResult* knownFrame(const RunOptions& o, const std::string& method, size_t i) {
    const auto known = o.known.find(method);
    return known != o.known.end() && i < known->second.size() ? &known->second[i] : nullptr;
}
bool isThere(const std::filesystem::path& out, const std::string& image) {
    std::error_code ignored;
    return !image.empty() && std::filesystem::exists(out / image, ignored);
}
}  // namespace

RunResults runMethods(const ShotReader& shot, const RunOptions& o, const Progress& progress,
                      std::vector<TileErrors>& errors) {
    const Manifest& manifest = shot.manifest();
    std::vector<RunningMethod> methods = startMethods(shot, o);
    std::vector<std::unique_ptr<Method>> timed;  // the same methods on a device, for its time alone
    if (o.device && o.timeOnly)
        for (const auto& spec : o.methods)
            timed.push_back(isExternal(spec) ? nullptr : gpu::create(*o.device, spec, shotInfo(manifest)));
    Rgb unused;
    RunResults results = describeRun(manifest, o);
    const InputPlan plan = planInput(shot, o);
    Judge judge(manifest, o, plan.overTime);

    const size_t passes = warmUpPasses(o, manifest);
    std::optional<Camera> before;
    if (passes > 0) before = warmUp(shot, o, methods, passes, progress);
    results.warmUpFrames = passes * o.frames.size();
    errors = judge.errors();
    results.complete = false;
    if (o.checkpoint) o.checkpoint(results);
    if (progress.interrupted()) return results;

    const std::vector<size_t> order = orderOfWork(methods, o.protocol.reference);
    const bool standsIn = !o.protocol.reference.empty();
    FrameStream stream(shot, o.frames, plan.jittered, /*withTruth=*/!standsIn, plan.centre);
    const DisplayChain& display = o.protocol.display;
    Feed feed(
        stream,
        [&](int i, Frame& frame) {
            if (i == 0) {
                frame.reset = passes == 0;  // a sequence may start in the middle
                if (passes > 0) frame.previousCamera = before;
            }
            prepareFrame(frame, methods, display, o.exec);
        },
        o.device.get());
    for (size_t i = 0; auto item = feed.next(); i++) {
        const auto& frame = item->frame;
        if (!standsIn) judge.look(*frame, item->truth, nullptr);
        const auto isWritten = [&] {
            return o.writeAllFrames || (judge.reference() && (!manifest.isStatic || i + 1 == o.frames.size()));
        };
        if (!standsIn && judge.reference() && isWritten())
            if (const auto image = writeTruthImage(*judge.reference(), frame->number, o); !image.empty())
                results.truthImages[frame->number] = image;

        for (const size_t k : order) {
            const bool isReference = standsIn && k == order.front();
            const Frame& input = plan.readsCentre(methods[k].spec) ? *item->centre : *frame;
            const double seconds = methods[k].resolve(input, input.display, o.exec);
            const bool isOurs = !isExternal(methods[k].spec);
            if (!timed.empty() && isOurs) timed[k]->resolve(input, o.exec, unused);
            if (o.protocol.eightBit) quantise8(methods[k].outEncoded, o.exec);
            if (isReference) judge.look(*frame, nullptr, &methods[k]);
            const FrameResult* known = knownFrame(o, methods[k].spec.text, i);
            FrameResult result = judge.judge(k, methods[k], (o.device && !o.timeOnly) || !isOurs ? 0 : seconds, known);
            if (o.device && isOurs)
                result.deviceSeconds = (timed.empty() ? *methods[k].method : *timed[k]).deviceSeconds();
            if (known) result.seconds = known->seconds, result.deviceSeconds = known->deviceSeconds;
            if (isWritten() && (!known || !isThere(o.out, known->image))) {
                result.image = writeImage(methods[k], frame->number, o);
                if (judge.reference() && !isReference) writeMaps(methods[k], judge.measured(), frame->number, o);
            } else if (known) {
                result.image = known->image;
            }
            if (isReference && !result.image.empty()) results.truthImages[frame->number] = result.image;
            MethodResult& of = results.methods[k];
            if (manifest.isStatic && !of.frames.empty()) of.frames.back().judged = false;
            of.frames.push_back(std::move(result));
            of.inputBytes =
                std::max(of.inputBytes, bytesOf(methods[k].spec.passes(), input, manifest.subsamplePositionsPx.size()));
            of.targetBytes = isOurs ? bytesOfTarget(input.width, input.height) : 0;
            of.stateBytes = std::max(of.stateBytes, methods[k].method->stateBytes());
        }
        judge.judgeRejected(methods, results.methods);
        if (o.checkpoint) o.checkpoint(results);
        progress.step("frame " + std::to_string(frame->number));
        if (progress.interrupted()) break;
    }
    feed.stop();
    if (o.device) o.device->forget();
    judge.finish(results, passes == 0);
    results.sanitised = counted(stream.counts());
    results.complete = results.framesDone() == o.frames.size();
    errors = judge.errors();
    return results;
}

}  // namespace aa
