#include "study/run.h"

#include <stdlib.h>

#include <algorithm>
#include <chrono>
#include <thread>

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

std::vector<const Metric*> watchingMetrics(const RunOptions& o) {
    std::vector<const Metric*> all = o.measure.metrics;
    for (const MapKind* kind : o.maps)
        if (kind->drawValues) all.push_back(findFigure(kind->sequenceFigure).metric);
    std::erase_if(all, [](const Metric* m) { return !m->watch; });
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
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
// Timings of one method below which its frames are resolved again, where it keeps nothing from frame to frame.
constexpr size_t kTimings = 5;

// Metrics of a run by default join those that were asked for where the time allows; otherwise the results say so.
DefaultMetrics defaultsOf(const RunOptions& o, const Manifest& manifest) {
    const double judged = manifest.isStatic ? 1 : double(o.frames.size()),
                 pixels = o.protocol.region ? double(o.protocol.region->width) * o.protocol.region->height
                                            : double(manifest.width) * manifest.height;
    return defaultMetrics(o.measure, pixels * judged * double(o.methods.size()));
}

std::map<std::string, double> leftOutOf(const DefaultMetrics& defaults) {
    std::map<std::string, double> names;
    if (!defaults.fit())
        for (const Metric* m : defaults.metrics) names[std::string(m->figures[0].name)] = defaults.seconds;
    return names;
}

std::optional<MachineLoad> loadNow() {
    double load = 0;
    if (::getloadavg(&load, 1) != 1) return {};
    return MachineLoad{.before = load, .processors = int(std::max(1u, std::thread::hardware_concurrency()))};
}
// A method with one thread that took longer by the clock than on the processor waited for it.
void fillWaited(RunResults& run) {
    if (!run.load || run.threads != 1) return;
    double wall = 0, processor = 0;
    for (const auto& m : run.methods)
        for (const auto& f : m.frames) wall += f.wallSeconds, processor += f.seconds;
    if (wall > 0) run.load->waited = std::max(0.0, 1 - processor / wall);
}
// Results as they grow: no more than some seconds are lost. An earlier run's are replaced, unless this one goes on with
// them.
class KeepsResults {
  public:
    explicit KeepsResults(const RunOptions& o, bool goesOn = false) : options_(o), goesOn_(goesOn) {}
    void operator()(const RunResults& sofar) {
        constexpr std::chrono::seconds kEvery{5};
        const auto now = std::chrono::steady_clock::now();
        if (!goesOn_ && !earlier_) earlier_.emplace(options_);
        if (earlier_ && !earlier_->mayBeReplacedBy(sofar)) return;
        if (now - written_ < kEvery) return;
        RunResults partial = sofar;
        partial.complete = false;
        aa::finish(partial, {});
        write(partial);
        written_ = now;
    }
    void finish(RunResults& results, const std::vector<TileErrors>& errors) {
        aa::finish(results, errors);
        if (earlier_) earlier_->tell(results);
        write(results);
    }

  private:
    void write(const RunResults& results) {
        writeResults(results, options_.out);
        if (earlier_) earlier_->clear();
    }
    const RunOptions& options_;
    bool goesOn_;
    std::chrono::steady_clock::time_point written_{};
    std::optional<Earlier> earlier_;
};
}  // namespace

RunResults run(const ShotReader& shot, const RunOptions& o, const Progress& progress) {
    RunOptions writing = o;
    const DefaultMetrics defaults = defaultsOf(o, shot.manifest());
    if (defaults.fit()) writing.measure.ofJudged = defaults.metrics;
    const auto leftOut = leftOutOf(defaults);
    KeepsResults keeps{o};
    writing.checkpoint = [&](RunResults r) {
        r.leftOut = leftOut;
        keeps(r);
    };
    std::vector<TileErrors> errors;
    RunResults results = runMethods(shot, writing, progress, errors);
    results.leftOut = leftOut;
    keeps.finish(results, errors);
    return results;
}

RunResults resume(const ShotReader& shot, const RunOptions& o, const Progress& progress) {
    RunOptions going = o;
    const Resumption resumption = goOnWith(readResults(o.out), shot, going);
    // What the first run decided holds for the methods that join it.
    if (resumption.before.leftOut.empty()) going.measure.ofJudged = defaultMetrics(o.measure, 0).metrics;
    RunResults results;
    std::vector<TileErrors> errors;
    if (!going.methods.empty()) {
        KeepsResults keeps{o, true};
        going.checkpoint = [&](const RunResults& r) {
            RunResults all = r;
            std::vector<TileErrors> none;
            merge(resumption, all, none);
            all.leftOut = resumption.before.leftOut;
            keeps(all);
        };
        results = runMethods(shot, going, progress, errors);
    }
    merge(resumption, results, errors);
    results.leftOut = resumption.before.leftOut;
    finish(results, errors);
    writeResults(results, o.out);
    return results;
}

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
    if (!o.device || o.timeOnly) results.load = loadNow();
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
            ResolveSeconds seconds = methods[k].resolve(input, input.display, o.exec);
            const bool isOurs = !isExternal(methods[k].spec);
            if ((o.device && !o.timeOnly) || !isOurs) seconds = {};
            const FrameResult* known = knownFrame(o, methods[k].spec.text, i);
            for (size_t n = o.frames.size();
                 n < kTimings && !known && seconds.processor > 0 && methods[k].isRepeatable(); n += o.frames.size())
                results.methods[k].moreSeconds.push_back(methods[k].again(input, o.exec).processor);
            if (!timed.empty() && isOurs) timed[k]->resolve(input, o.exec, unused);
            if (o.protocol.eightBit) quantise8(methods[k].outEncoded, o.exec);
            if (isReference) judge.look(*frame, nullptr, &methods[k]);
            FrameResult result = judge.judge(k, methods[k], seconds, known);
            if (o.device && isOurs)
                result.deviceSeconds = (timed.empty() ? *methods[k].method : *timed[k]).deviceSeconds();
            if (known) {
                result.seconds = known->seconds, result.wallSeconds = known->wallSeconds;
                result.deviceSeconds = known->deviceSeconds;
            }
            if (isWritten() && (!known || !isThere(o.out, known->image))) {
                result.image = writeImage(methods[k], frame->number, o);
                if (judge.reference() && !isReference)
                    writeMaps(methods[k], judge.measured(), frame->number, o,
                              [&](const MapKind& kind) { return judge.sequenceMap(k, kind); });
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
    fillWaited(results);
    results.sanitised = counted(stream.counts());
    results.complete = results.framesDone() == o.frames.size();
    errors = judge.errors();
    return results;
}

}  // namespace aa
