#include "study/run.h"

#include <stdlib.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "gpu/method.h"
#include "metrics/temporal.h"
#include "shot/frame_stream.h"
#include "study/external.h"
#include "study/feed.h"
#include "study/frame_work.h"
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
    bool isDue() const {
        constexpr std::chrono::seconds kEvery{5};
        return std::chrono::steady_clock::now() - written_ >= kEvery;
    }
    // Fills what follows from the frames so far.
    void operator()(RunResults& sofar) {
        if (!goesOn_ && !earlier_) earlier_.emplace(options_);
        if (earlier_ && !earlier_->mayBeReplacedBy(sofar)) return;
        sofar.complete = false;  // after the last frame, too: what methods are compared by comes after it
        aa::finish(sofar, {});
        write(sofar);
        written_ = std::chrono::steady_clock::now();
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
    writing.checkpoint = [&](RunResults& sofar) {
        if (!keeps.isDue()) return;
        sofar.leftOut = leftOut;
        keeps(sofar);
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
        going.checkpoint = [&](const RunResults& sofar) {
            if (!keeps.isDue()) return;
            RunResults all = sofar;
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

    const bool standsIn = !o.protocol.reference.empty();
    FrameStream stream(shot, o.frames, plan.jittered, /*withTruth=*/!standsIn, plan.centre, o.trace.get());
    Feed feed(
        stream,
        [&](int i, Frame& frame) {
            const Trace::Span preparing(o.trace.get(), "prepare", std::to_string(frame.number));
            if (i == 0) {
                frame.reset = passes == 0;  // a sequence may start in the middle
                if (passes > 0) frame.previousCamera = before;
            }
            prepareFrame(frame, methods, o.protocol.display, o.exec);
        },
        o.device.get());
    FrameWork work(shot, o, plan, judge, methods, results);
    for (size_t i = 0; auto item = feed.next(); i++) {
        work(*item, i);
        if (o.checkpoint) o.checkpoint(results);
        progress.step("frame " + std::to_string(item->frame->number));
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
